// Pulleys, drums and guide wheels behind the anchors, and supports, as bodies of the view.

import {
  BufferGeometry,
  CircleGeometry,
  DoubleSide,
  Group,
  Line,
  LineBasicMaterial,
  LineLoop,
  Mesh,
  MeshLambertMaterial,
  Quaternion,
  SphereGeometry,
  Vector3,
} from "three";

const SEGMENTS = 48;
const MARK = 0.008; // of the robot's size: radius of a drum or guide wheel, whose own radius is not known
const Z = new Vector3(0, 0, 1);

/** Part of a vector across a unit vector. */
const across = (vector, unit) => vector.clone().addScaledVector(unit, -vector.dot(unit));

/** Wheel of a pulley: a disc whose rim passes through the origin of its group. */
function wheelOf(radius, materials) {
  const wheel = new Group();
  const circle = new CircleGeometry(radius, SEGMENTS);
  wheel.add(new Mesh(circle, materials.disc));
  const rim = Array.from({ length: SEGMENTS }, (_, i) => {
    const angle = (2 * Math.PI * i) / SEGMENTS;
    return new Vector3(radius * Math.cos(angle), radius * Math.sin(angle), 0);
  });
  wheel.add(new LineLoop(new BufferGeometry().setFromPoints(rim), materials.rim));
  return wheel;
}

/** Bodies behind the anchors of a robot. `group` is part of the scene. */
export class Drives {
  constructor(cables, supports, size) {
    this.group = new Group();
    this.size = size;
    this.materials = {
      disc: new MeshLambertMaterial({ side: DoubleSide, transparent: true, opacity: 0.35 }),
      rim: new LineBasicMaterial(),
      rope: new LineBasicMaterial(),
      drum: new MeshLambertMaterial(),
      support: new MeshLambertMaterial(),
    };
    this.cables = cables.map((cable) => this.#ofCable(cable));
    this.supports = supports.length;
    // Only what a robot has is named in its legend.
    this.kinds = {
      pulleys: cables.some((cable) => cable.pulley),
      drums: cables.some((cable) => cable.winch?.drum_side_length_m > 0),
      guides: cables.some((cable) => cable.winch?.guide_wheels?.length),
      supports: cables.some((cable) => cable.support),
    };
  }

  #mark(radius, material) {
    return new Mesh(new SphereGeometry(radius, 16, 10), material);
  }

  #ofCable({ anchor_m: anchor, pulley, winch, support }) {
    const place = new Vector3(...anchor);
    const body = new Group();
    body.position.copy(place);
    this.group.add(body);
    const own = { body, place, wheel: null, radius: 0, direction: null, support };

    // The wheel stands in the plane of the cable; frames turn it.
    if (pulley) {
      own.radius = pulley.radius_m;
      own.direction = new Vector3(...pulley.entry_direction);
      own.wheel = wheelOf(pulley.radius_m, this.materials);
      own.arc = new Line(new BufferGeometry(), this.materials.rope);
      body.add(own.wheel, own.arc);
    }

    // The drum is where the cable comes from. Without a pulley the file does not say where that is: no drum side is
    // drawn.
    const length = winch?.drum_side_length_m ?? 0;
    if (pulley && length > 0) {
      const drum = new Vector3().addScaledVector(own.direction, -length);
      body.add(new Line(new BufferGeometry().setFromPoints([new Vector3(), drum]), this.materials.rope));
      const mark = this.#mark(MARK * this.size, this.materials.drum);
      mark.position.copy(drum);
      body.add(mark);
      for (const { distance_m: distance } of winch.guide_wheels ?? []) {
        const guide = wheelOf(MARK * this.size, this.materials);
        const side = across(Math.abs(own.direction.z) > 0.9 ? new Vector3(1, 0, 0) : Z, own.direction).normalize();
        guide.position
          .copy(own.direction)
          .multiplyScalar(-distance)
          .addScaledVector(side, MARK * this.size);
        guide.quaternion.setFromUnitVectors(Z, own.direction.clone().cross(side).normalize());
        body.add(guide);
      }
    }
    if (support) {
      const mark = this.#mark(0.6 * MARK * this.size, this.materials.support);
      body.add(mark);
    }
    return own;
  }

  /** Hides the wheels, whose swivel angles follow from the equilibrium. */
  setUnknown() {
    this.cables
      .filter(({ wheel }) => wheel)
      .forEach(({ wheel, arc }) => {
        wheel.visible = arc.visible = false;
      });
  }

  /** Turns the wheels to the exit points of a frame. */
  setFrame(frame) {
    this.cables.forEach((own, i) => {
      own.body.position.copy(own.place);
      if (!own.wheel) {
        return;
      }
      own.wheel.visible = own.arc.visible = true;
      // Entry point A, direction d of travel and exit point E lie in the plane of the wheel, on its side towards E.
      const { direction, radius } = own;
      const out = new Vector3(...frame.cables[i].anchor).sub(own.place);
      const side = across(out, direction);
      if (side.length() < 1e-9) {
        side.copy(across(new Vector3(...frame.cables[i].attachment).sub(own.place), direction));
      }
      side.normalize();
      const center = side.clone().multiplyScalar(radius);
      own.wheel.position.copy(center);
      own.wheel.quaternion.copy(new Quaternion().setFromUnitVectors(Z, direction.clone().cross(side).normalize()));
      own.swivel = Math.atan2(side.y, side.x);

      // The cable on the wheel, from A to E: r ((1 − cos θ) side + sin θ direction).
      const end = Math.atan2(out.dot(direction), radius - out.dot(side));
      const angle = end < 0 ? end + 2 * Math.PI : end;
      const points = Array.from({ length: 25 }, (_, k) => {
        const at = (angle * k) / 24;
        return center
          .clone()
          .addScaledVector(side, -radius * Math.cos(at))
          .addScaledVector(direction, radius * Math.sin(at));
      });
      own.arc.geometry.dispose();
      own.arc.geometry = new BufferGeometry().setFromPoints(points);
    });
  }

  /** Moves what is on a flexible support. `moved(i)`: displacement of the end of cable i on the screen, or null. */
  move(moved) {
    this.cables.forEach((own, i) => {
      if (own.support) {
        own.body.position.copy(own.place).add(moved(i));
      }
    });
  }

  recolor(color) {
    this.materials.disc.color.set(color("--platform"));
    this.materials.rim.color.set(color("--ink"));
    this.materials.rope.color.set(color("--soft"));
    this.materials.drum.color.set(color("--accent"));
    this.materials.support.color.set(color("--violet"));
  }

  /** Lines of the bodies for a drawing: lists of points in the world. */
  lines() {
    const found = [];
    this.group.updateMatrixWorld(true);
    this.group.traverse((child) => {
      if (child.isLine) {
        const position = child.geometry.getAttribute("position");
        const point = (i) => new Vector3().fromBufferAttribute(position, i).applyMatrix4(child.matrixWorld).toArray();
        const points = Array.from({ length: position.count }, (_, i) => point(i));
        found.push(child.isLineLoop ? [...points, points[0]] : points);
      }
    });
    return found;
  }

  /** Places and colours of round marks for a drawing. */
  marks() {
    const found = [];
    this.group.traverse((child) => {
      if (child.isMesh && child.geometry.type === "SphereGeometry") {
        const place = child.getWorldPosition(new Vector3()).toArray();
        found.push({ place, color: `#${child.material.color.getHexString()}` });
      }
    });
    return found;
  }
}
