// What helps to see where the platform is: the plumb line to the floor, the pale wanted pose beyond the workspace, and
// the plane whose colours show a measure over the workspace.

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DataTexture,
  DoubleSide,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineDashedMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  NearestFilter,
  RGBAFormat,
  SRGBColorSpace,
  Vector3,
} from "three";

const OPACITY = 0.6; // of the coloured plane, so that the grid is seen through it
const GHOST_OPACITY = 0.28;
const RING = 0.012; // of the robot's size: radius of the mark on the floor
const RING_POINTS = 24;

export class Ground {
  constructor(scene) {
    this.plumb = new LineSegments(new BufferGeometry(), new LineDashedMaterial({ transparent: true, opacity: 0.8 }));
    this.plumb.frustumCulled = false;
    this.ghost = new Group();
    this.ghostMaterial = new MeshBasicMaterial({ transparent: true, opacity: GHOST_OPACITY, depthWrite: false });
    this.ghostEdges = new LineBasicMaterial();
    this.ghost.visible = false;
    this.colors = new MeshBasicMaterial({ transparent: true, opacity: OPACITY, side: DoubleSide, depthWrite: false });
    this.plane = new Mesh(new BufferGeometry(), this.colors);
    this.plane.frustumCulled = false;
    this.plane.renderOrder = -1;
    this.plane.visible = false;
    scene.add(this.plumb, this.ghost, this.plane);
  }

  /** Another robot with this body, whose floor is at a height. */
  setRobot(body, size, floor) {
    Object.assign(this, { size, floor });
    this.ghost.clear();
    this.ghost.add(new Mesh(body, this.ghostMaterial), new LineSegments(new EdgesGeometry(body, 20), this.ghostEdges));
    this.plumb.material.dashSize = 0.012 * size;
    this.plumb.material.gapSize = 0.008 * size;
    this.setPlane(null);
    this.setGhost(null);
  }

  clear() {
    this.ghost.clear();
    this.ghost.visible = this.plumb.visible = this.plane.visible = false;
  }

  /** Drops the plumb line from a place; null takes it away. */
  setPlumb(place) {
    this.plumb.visible = place !== null && place[2] > this.floor;
    if (!this.plumb.visible) {
      return;
    }
    const [x, y, z] = place;
    const radius = RING * this.size;
    const ring = (i) => {
      const angle = (2 * Math.PI * i) / RING_POINTS;
      return [x + radius * Math.cos(angle), y + radius * Math.sin(angle), this.floor];
    };
    const circle = Array.from({ length: RING_POINTS }, (_, i) => [...ring(i), ...ring(i + 1)]).flat();
    const numbers = Float32Array.from([x, y, z, x, y, this.floor, ...circle]);
    const position = this.plumb.geometry.getAttribute("position");
    if (position) {
      position.array.set(numbers);
      position.needsUpdate = true;
    } else {
      this.plumb.geometry.setAttribute("position", new BufferAttribute(numbers, 3));
    }
    this.plumb.computeLineDistances();
  }

  /** Shows the pale body at a pose that is wanted; null hides it. */
  setGhost(pose) {
    this.ghost.visible = pose !== null;
    if (pose) {
      this.ghost.position.set(...pose.position);
      const [w, x, y, z] = pose.quaternion;
      this.ghost.quaternion.set(x, y, z, w);
    }
  }

  /**
   * Colours a plane; null takes it away.
   * @param {?object} of `corners` (four points, counter-clockwise), `columns`, `rows`, `colors` (list of `rgb` numbers
   *   0 to 255 by rows, null where there is none)
   */
  setPlane(of) {
    this.colors.map?.dispose();
    this.colors.map = null;
    this.plane.visible = of !== null;
    if (!of) {
      return;
    }
    const { corners, columns, rows, colors } = of;
    const bytes = new Uint8Array(4 * columns * rows);
    colors.forEach((color, i) => color && bytes.set([...color, 255], 4 * i));
    const texture = new DataTexture(bytes, columns, rows, RGBAFormat);
    texture.colorSpace = SRGBColorSpace;
    texture.magFilter = texture.minFilter = NearestFilter;
    texture.needsUpdate = true;
    this.colors.map = texture;
    this.colors.needsUpdate = true;
    this.plane.geometry.dispose();
    this.plane.geometry = new BufferGeometry().setFromPoints(corners.map((corner) => new Vector3(...corner)));
    this.plane.geometry.setAttribute("uv", new BufferAttribute(Float32Array.from([0, 0, 1, 0, 1, 1, 0, 1]), 2));
    this.plane.geometry.setIndex([0, 1, 2, 0, 2, 3]);
  }

  /** Adapts the colours. `color(name)`: a colour of the page. */
  recolor(color) {
    this.plumb.material.color.set(color("--soft"));
    this.ghostMaterial.color.set(color("--warn"));
    this.ghostEdges.color.set(new Color(color("--warn")));
  }
}
