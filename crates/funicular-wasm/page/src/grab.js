// The body of the platform as its large handle: it follows the pointer in the horizontal plane, and with Shift or a
// second finger vertically. A press that misses it by a little turns no camera.

import { Plane, Raycaster, Vector2, Vector3 } from "three";

const MIN_RADIUS_PX = 22; // of the handle: a finger needs 44 px
const MISS_PX = 40; // around body and arrows, where a press neither moves nor turns
const ARROWS = 0.12; // of the height of the view: reach of the arrows from their origin
const LOW_SUN = 0.15; // sine of the elevation below which the horizontal plane is seen too flat to drag in it
const REACH = 0.8; // of the robot's size: distance from its centre within which a pose can be wanted

export class Grab {
  #view;
  #pointers = new Map();
  #grip = null; // where the drag was taken: kind of motion, pointer and place of the platform

  /** @param {View} view */
  constructor(view) {
    this.#view = view;
    const on = (name, work) => view.place.addEventListener(name, (event) => work(event), { capture: true });
    on("pointerdown", (event) => this.#down(event));
    on("pointermove", (event) => this.#move(event));
    on("pointerup", (event) => this.#up(event));
    on("pointercancel", (event) => this.#up(event));
    ["keydown", "keyup"].forEach((name) =>
      addEventListener(name, ({ key }) => {
        if (key === "Shift" && this.#grip) {
          this.#takeAgain();
        }
      }),
    );
  }

  /** Centre of the body on the screen and its radius there, in pixels of the view. */
  #body() {
    const { attachments, camera, handle, pixels, platform } = this.#view;
    const [width, height] = pixels;
    const onScreen = (point) => {
      const { x, y } = point.project(camera);
      return [((x + 1) * width) / 2, ((1 - y) * height) / 2];
    };
    const center = onScreen(handle.position.clone());
    platform.updateMatrixWorld();
    const corners = attachments.map((point) => onScreen(platform.localToWorld(point.clone())));
    const radii = corners.map(([x, y]) => Math.hypot(x - center[0], y - center[1]));
    return { center, radius: Math.max(MIN_RADIUS_PX, ...radii) };
  }

  /** What a press at a place would take: `body`, `arrow`, `miss`, or `space`. */
  #at(event) {
    const { canDrag, canvas, controls, handles, pixels } = this.#view;
    if (!canDrag || handles === "none") {
      return "space";
    }
    const box = canvas.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    const { center, radius } = this.#body();
    const distance = Math.hypot(x - center[0], y - center[1]);
    if (handles !== "rotate" && distance <= radius) {
      return "body";
    }
    controls.pointerHover({ ...this.#ray(event), button: -1 });
    if (controls.axis !== null) {
      return "arrow";
    }
    return distance <= Math.max(radius, ARROWS * pixels[1]) + MISS_PX ? "miss" : "space";
  }

  /** Place of a pointer from −1 to 1 in the view. */
  #ray({ clientX, clientY }) {
    const { left, top, width, height } = this.#view.canvas.getBoundingClientRect();
    return new Vector2((2 * (clientX - left)) / width - 1, 1 - (2 * (clientY - top)) / height);
  }

  #down(event) {
    const { canvas, controls } = this.#view;
    if (event.target !== canvas || (event.pointerType === "mouse" && event.button !== 0)) {
      return;
    }
    if (!this.#grip) {
      const taken = this.#at(event);
      if (taken === "miss") {
        event.stopPropagation();
      }
      if (taken !== "body") {
        return;
      }
      controls.axis = null;
      controls.enabled = false;
      canvas.focus({ preventScroll: true });
      this.#view.dragging = true;
      this.#view.tell.dragBegin();
    }
    event.stopPropagation();
    canvas.setPointerCapture(event.pointerId);
    this.#pointers.set(event.pointerId, event);
    this.#takeAgain(event.shiftKey);
    canvas.style.cursor = "grabbing";
  }

  /** Takes the platform where it is wanted now, because the kind of motion changes. */
  #takeAgain(shift) {
    const { camera, canDrag, handle, motion } = this.#view;
    const [pointer] = this.#pointers.values();
    if (!pointer || !canDrag) {
      return;
    }
    const from = handle.position.clone();
    const isPlanar = motion.name === "planar";
    const vertical = !isPlanar && (shift || this.#pointers.size > 1);
    const look = camera.getWorldDirection(new Vector3());
    const flat = Math.abs(look.z) < LOW_SUN;
    const normal = isPlanar ? new Vector3(...motion.normal) : flat ? look : new Vector3(0, 0, 1);
    const plane = new Plane().setFromNormalAndCoplanarPoint(normal, from);
    this.#grip = { from, plane, vertical, pointer, at: this.#hit(pointer, plane) };
  }

  /** Point of a plane under a pointer; null if it looks past it. */
  #hit(pointer, plane) {
    const caster = new Raycaster();
    caster.setFromCamera(this.#ray(pointer), this.#view.camera);
    return caster.ray.intersectPlane(plane, new Vector3());
  }

  #move(event) {
    const grip = this.#grip;
    const { canvas, dragging } = this.#view;
    if (!grip) {
      if (event.target === canvas && event.buttons === 0 && !dragging) {
        canvas.style.cursor = { body: "grab", arrow: "pointer" }[this.#at(event)] ?? "";
      }
      return;
    }
    event.stopPropagation();
    if (!this.#pointers.has(event.pointerId)) {
      return;
    }
    this.#pointers.set(event.pointerId, event);
    if (!this.#view.canDrag) {
      return;
    }
    const isFirst = event.pointerId === grip.pointer.pointerId;
    if (isFirst && event.shiftKey !== grip.vertical && this.#pointers.size === 1) {
      this.#takeAgain(event.shiftKey);
      return;
    }
    if (!isFirst) {
      return;
    }
    const to = this.#wanted(event);
    if (to) {
      const { handle, tell } = this.#view;
      handle.position.copy(to);
      const { x, y, z, w } = handle.quaternion;
      tell.drag(to.toArray(), [w, x, y, z]);
    }
  }

  /** Place where the platform is wanted, within reach of the robot. */
  #wanted(event) {
    const { camera, center, pixels, size } = this.#view;
    const { from, plane, vertical, pointer, at } = this.#grip;
    const to = from.clone();
    if (vertical) {
      const perPixel = (2 * Math.tan((camera.fov * Math.PI) / 360) * camera.position.distanceTo(from)) / pixels[1];
      to.z += (pointer.clientY - event.clientY) * perPixel;
    } else {
      const hit = at && this.#hit(event, plane);
      if (!hit) {
        return null;
      }
      to.add(hit).sub(at);
    }
    const off = to.clone().sub(center);
    return off.length() <= REACH * size ? to : center.clone().addScaledVector(off.normalize(), REACH * size);
  }

  #up(event) {
    if (!this.#pointers.delete(event.pointerId)) {
      return;
    }
    event.stopPropagation();
    if (this.#pointers.size > 0) {
      this.#takeAgain(event.shiftKey);
      return;
    }
    const { canvas, controls, tell } = this.#view;
    this.#grip = null;
    canvas.style.cursor = "";
    controls.enabled = true;
    this.#view.dragging = false;
    tell.dragEnd();
  }
}
