// The robot in space: cables with their sag, tension as colour, platform, handles to drag it.

import {
  AmbientLight,
  BufferAttribute,
  BufferGeometry,
  Color,
  DirectionalLight,
  EdgesGeometry,
  GridHelper,
  Group,
  LineBasicMaterial,
  LineDashedMaterial,
  LineSegments,
  Mesh,
  MeshLambertMaterial,
  Object3D,
  PerspectiveCamera,
  Points,
  PointsMaterial,
  Scene,
  SphereGeometry,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { TransformControls } from "three/addons/controls/TransformControls.js";
import { ConvexGeometry } from "three/addons/geometries/ConvexGeometry.js";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { CalibrationScene } from "./calibration_scene.js";
import { canvasOf, NO_RENDERER } from "./canvas.js";
import { colorOf, COLORS, isLimited, limitingCable } from "./colors.js";
import { setCurve } from "./curve.js";
import { Drives } from "./drives.js";
import { rotation } from "./frame.js";
import { Grab } from "./grab.js";
import { Ground } from "./ground.js";
import { Playback } from "./motion.js";
import { Obstacles } from "./obstacles.js";
import { ReachScene } from "./reach_scene.js";

const FIELD_OF_VIEW = 35;
const VIEW_HALF = 0.44; // of the size of the robot: half of what the view shows of it at first
const NAME_AT = 0.3; // of the length of a cable from its anchor: place of its name
const LONG_NAME = 8; // characters: of longer names the view has numbers, except for the highest
const WIDTH = 2.6; // of a cable, in pixels
const WIDTH_LIMITING = 5.2; // of the cable that is nearest to its limit
const OPACITY = 0.82; // of the platform, so that cables behind it are seen
const OPACITY_BROKEN = 0.3; // of the platform at a pose without an equilibrium

export class View {
  /**
   * @param {HTMLElement} place
   * @param {object} tell functions: `dragBegin()`, `drag(position, quaternion)`, `dragEnd()`
   */
  constructor(place, tell) {
    this.place = place;
    this.tell = tell;
    this.exaggeration = 1;
    this.playback = new Playback(this);
    this.lines = [];
    this.canDrag = false; // until there is a pose
    this.pixels = [1, 1];

    const { canvas, context, software } = canvasOf();
    this.software = software;
    this.renderer = context ? new WebGLRenderer({ canvas, context, alpha: true }) : NO_RENDERER;
    this.canvas = canvas;
    this.isDrawn = Boolean(context);
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "application"); // it takes the arrow keys
    this.labels = document.createElement("div");
    this.labels.className = "names";
    this.labels.setAttribute("aria-hidden", "true");
    place.append(this.canvas, this.labels);
    if (!this.isDrawn) {
      this.canvas.hidden = this.labels.hidden = true;
      const note = document.createElement("p");
      note.className = "no-view";
      note.textContent = "No 3D here: type a pose below. This browser has no WebGL; everything else is computed.";
      place.append(note);
    }
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 1000);
    this.camera.up.set(0, 0, 1);
    this.scene.add(new AmbientLight(0xffffff, 2.2));
    const sun = new DirectionalLight(0xffffff, 1.6);
    sun.position.set(0.4, -0.7, 1);
    this.scene.add(sun);

    this.platform = new Group();
    this.fixed = new Group();
    this.cables = new Group();
    this.remembered = new Group();
    this.handle = new Object3D();
    this.ground = new Ground(this.scene);
    this.reach = new ReachScene(this.scene);
    this.calibration = new CalibrationScene(this.scene);
    this.scene.add(this.platform, this.fixed, this.cables, this.remembered, this.handle);

    this.orbit = new OrbitControls(this.camera, this.canvas);
    this.orbit.addEventListener("change", () => this.draw());
    this.controls = new TransformControls(this.camera, this.canvas);
    this.controls.setSize(0.85);
    this.controls.attach(this.handle);
    this.scene.add(this.controls.getHelper());
    this.controls.addEventListener("change", () => this.draw());
    this.controls.addEventListener("dragging-changed", ({ value }) => {
      this.dragging = value;
      this.orbit.enabled = !value;
      if (value) {
        tell.dragBegin();
      } else {
        tell.dragEnd();
      }
    });
    this.grab = new Grab(this);
    this.controls.addEventListener("objectChange", () => {
      const { x, y, z, w } = this.handle.quaternion;
      tell.drag(this.handle.position.toArray(), [w, x, y, z]);
    });
    new ResizeObserver(() => this.resize()).observe(place);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.place;
    if (width === 0 || height === 0) {
      return;
    }
    // Kept, because asking the page for them in each frame makes it lay out everything twice.
    this.pixels = [width, height];
    this.renderer.setPixelRatio(this.software ? 1 : Math.min(2, devicePixelRatio || 1));
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.lines.forEach((line) => line.material.resolution.set(width, height));
    this.draw();
  }

  /** Draws at the next frame of the screen. */
  draw() {
    this.waiting ??= requestAnimationFrame((now) => {
      this.waiting = null;
      this.playback.show(now);
      this.renderer.render(this.scene, this.camera);
      this.placeLabels();
      if (this.playback.mode?.playing) {
        this.draw();
      }
    });
  }

  /** Puts the names of the cables beside them, nearer to the anchors, where they are apart. */
  placeLabels() {
    const [width, height] = this.pixels;
    this.labels.hidden = !this.frame || !this.isDrawn;
    this.frame?.cables.forEach(({ attachment, anchor }, i) => {
      const place = [0, 1, 2].map((k) => anchor[k] + NAME_AT * (attachment[k] - anchor[k]));
      const point = new Vector3(...place).project(this.camera);
      const label = this.labels.children[i];
      if (label) {
        label.hidden = Math.abs(point.x) > 1 || Math.abs(point.y) > 1 || point.z > 1;
        const [x, y] = [((point.x + 1) * width) / 2 + 4, ((1 - point.y) * height) / 2 - 8];
        label.style.transform = `translate(${x}px, ${y}px)`;
      }
    });
  }

  /** Takes the robot away. */
  clear() {
    [this.platform, this.fixed, this.cables, this.remembered].forEach((group) => group.clear());
    this.ground.clear();
    this.reach.set(null);
    this.calibration.set(null);
    Object.assign(this, { lines: [], frame: null, names: [], attachments: [] });
    this.playback.mode = null;
    this.labels.replaceChildren();
    this.#allowDrag(false);
    this.canvas.setAttribute("aria-label", "View without a robot");
    this.draw();
  }

  /** Shows another robot. `about` is the description of the reader. */
  setRobot(about, frame, keepView) {
    [this.platform, this.fixed, this.cables].forEach((group) => group.clear());
    this.lines = [];
    this.limiting = -1;
    this.frame = this.playback.mode = null;
    const { cables } = about.check;
    this.names = cables.map((cable) => cable.name);
    const areLong = this.names.some((name) => name.length > LONG_NAME);
    this.shortNames = this.names.map((name, i) => (areLong ? String(i + 1) : name));
    const label = (name) => Object.assign(document.createElement("span"), { textContent: name });
    this.labels.replaceChildren(...this.shortNames.map(label));
    this.attachments = cables.map((cable) => new Vector3(...cable.attachment_m));
    this.motion = about.motion;

    // Box around the robot: anchors and platform.
    const anchors = cables.map((cable) => new Vector3(...cable.anchor_m));
    this.anchors = anchors;
    // The place of the file, not of the moment: one button gives one view.
    const box = [...anchors, new Vector3(...(about.check.pose?.position_m ?? [0, 0, 0]))];
    const low = new Vector3(...["x", "y", "z"].map((axis) => Math.min(...box.map((point) => point[axis]))));
    const high = new Vector3(...["x", "y", "z"].map((axis) => Math.max(...box.map((point) => point[axis]))));
    this.center = low.clone().add(high).multiplyScalar(0.5);
    this.size = Math.max(low.distanceTo(high), 1e-3);
    this.box = [low, high];

    this.addFixed(anchors, low);
    this.addPlatform();
    this.drives = new Drives(cables, about.check.supports ?? [], this.size);
    this.obstacles = new Obstacles(about);
    this.fixed.add(this.drives.group, this.obstacles.group);
    this.platform.add(this.obstacles.onPlatform);
    for (const { name } of cables) {
      const material = new LineMaterial({ linewidth: WIDTH, vertexColors: false, dashScale: 60 / this.size });
      const line = new Line2(new LineGeometry(), material);
      line.name = name;
      line.frustumCulled = false;
      this.lines.push(line);
      this.cables.add(line);
    }
    const { clientWidth: width, clientHeight: height } = this.place;
    this.lines.forEach((line) => line.material.resolution.set(width, height));
    this.setHandles(this.handles ?? this.controls.mode);
    if (!keepView) {
      this.look("oblique");
    }
    this.recolor();
  }

  addFixed(anchors, low) {
    // A ground of about twenty cells below everything.
    const step = 10 ** Math.floor(Math.log10(this.size / 8));
    const cells = Math.ceil((1.3 * this.size) / step / 2) * 2;
    this.grid = new GridHelper(cells * step, cells);
    this.grid.rotation.x = Math.PI / 2;
    const round = (value) => Math.round(value / step) * step;
    this.grid.position.set(round(this.center.x), round(this.center.y), Math.min(0, low.z));
    this.grid.material.transparent = true;
    this.grid.material.opacity = 0.35;
    this.fixed.add(this.grid);
    const geometry = new BufferGeometry().setFromPoints(anchors);
    this.anchorMaterial = new PointsMaterial({ size: 8, sizeAttenuation: false });

    // Posts from the ground to the anchors show the depth.
    const posts = anchors.flatMap((anchor) => [anchor, new Vector3(anchor.x, anchor.y, Math.min(0, low.z))]);
    this.postMaterial = new LineBasicMaterial({ transparent: true, opacity: 0.4 });
    this.posts = new LineSegments(new BufferGeometry().setFromPoints(posts), this.postMaterial);
    this.anchorPoints = new Points(geometry, this.anchorMaterial);
    this.fixed.add(this.posts, this.anchorPoints);
  }

  addPlatform() {
    const radius = Math.max(...this.attachments.map((point) => point.length()), 0);
    const thin = Math.max(0.02 * this.size, 0.08 * radius);
    this.platformMaterial = new MeshLambertMaterial({ transparent: true, opacity: OPACITY });
    this.edgeMaterial = new LineBasicMaterial();
    let body;
    if (this.motion.name === "point-mass" || radius === 0) {
      body = new SphereGeometry(0.012 * this.size, 24, 16);
    } else {
      // Points in one plane get a thickness, so that every platform is a body.
      const along = this.motion.name === "planar" ? new Vector3(...this.motion.normal) : new Vector3(0, 0, 1);
      const flat = along.clone().multiplyScalar(0.25 * thin);
      const sides = this.attachments.flatMap((point) => [point.clone().add(flat), point.clone().sub(flat)]);
      body = new ConvexGeometry(sides);
    }
    this.body = new Mesh(body, this.platformMaterial);
    this.ground.setRobot(body, this.size, this.grid.position.z);
    this.platform.add(this.body);
    if (radius > 0) {
      this.platform.add(new LineSegments(new EdgesGeometry(body, 20), this.edgeMaterial));
    }
  }

  /** Adapts the colours to the scheme of the page. */
  recolor() {
    const style = getComputedStyle(document.documentElement);
    const color = (name) => new Color(style.getPropertyValue(name).trim());
    this.grid?.material.color.set(color("--grid"));
    if (this.grid) {
      this.grid.material.vertexColors = false;
      this.grid.material.needsUpdate = true;
    }
    this.anchorMaterial?.color.set(color("--ink"));
    this.postMaterial?.color.set(color("--soft"));
    this.platformMaterial?.color.set(color("--platform"));
    this.edgeMaterial?.color.set(color("--ink"));
    this.drives?.recolor(color);
    this.obstacles?.recolor(color);
    this.ground.recolor(color);
    this.reach.recolor(color);
    this.calibration.recolor(color);
    this.draw();
  }

  /** Chooses the handles: `translate`, `rotate`, or none. */
  setHandles(kind) {
    this.handles = kind;
    const { name, normal } = this.motion ?? { name: "rigid" };
    const rigid = name === "rigid";
    const can = this.canDrag && kind !== "none" && (kind === "translate" || name !== "point-mass");
    this.controls.enabled = can;
    this.controls.getHelper().visible = can;
    if (kind !== "none") {
      this.controls.setMode(kind);
    }
    // A planar platform moves along the axes in its plane and turns about the normal.
    const along = (k) => name !== "planar" || Math.abs(normal[k]) < 0.99;
    const shown = (k) => (kind === "rotate" ? rigid || !along(k) : along(k));
    [this.controls.showX, this.controls.showY, this.controls.showZ] = [shown(0), shown(1), shown(2)];
    this.draw();
  }

  #allowDrag(can) {
    if (this.canDrag !== can) {
      this.canDrag = can;
      this.setHandles(this.handles ?? this.controls.mode);
    }
  }

  /** Shows a frame. `held`: the handle keeps its place, because a person holds it. */
  setFrame(frame, held) {
    this.frame = frame;
    this.platform.visible = this.cables.visible = true;
    this.#allowDrag(true);
    this.platform.position.set(...frame.position);
    const [w, x, y, z] = frame.quaternion;
    this.platform.quaternion.set(x, y, z, w);
    if (!held) {
      this.handle.position.copy(this.platform.position);
      this.handle.quaternion.copy(this.platform.quaternion);
    }
    this.platformMaterial.opacity = OPACITY;
    this.ground.setPlumb(frame.position);
    this.drives.setFrame(frame);
    this.obstacles.setFrame(frame);
    this.moveSupports(() => new Vector3());
    const top = Math.max(...frame.cables.map((cable) => cable.highest), 1e-9);
    this.markLimiting(limitingCable(frame));
    frame.cables.forEach((cable, i) => {
      const line = this.lines[i];
      setCurve(line, this.exaggerated(cable));
      const part = isLimited(frame, cable)
        ? (cable.highest - cable.minimum) / (cable.maximum - cable.minimum)
        : cable.highest / top;
      const color = cable.slack ? new Color(COLORS.slack) : cable.beyond ? new Color(COLORS.beyond) : colorOf(part);
      line.material.color.copy(color);
      line.material.dashed = Boolean(cable.slack);
      if (cable.slack) {
        line.computeLineDistances();
      }
    });
    this.draw();
  }

  /**
   * Shows that there is no equilibrium: at a pose a pale platform with cables as grey straight lines, otherwise
   * neither.
   * @param {?object} pose `position`, `quaternion`; null if it is not known
   */
  setBroken(pose) {
    this.frame = this.playback.mode = null;
    this.ground.setPlumb(null);
    this.platform.visible = this.cables.visible = pose !== null;
    this.drives?.setUnknown();
    this.#allowDrag(pose !== null);
    if (pose) {
      const { position, quaternion } = pose;
      const r = rotation(quaternion);
      const [w, x, y, z] = quaternion;
      [this.platform, ...(this.dragging ? [] : [this.handle])].forEach((body) => {
        body.position.set(...position);
        body.quaternion.set(x, y, z, w);
      });
      this.lines.forEach((line, i) => {
        const own = this.attachments[i].toArray();
        const at = r.map((row, k) => position[k] + row.reduce((sum, value, j) => sum + value * own[j], 0));
        setCurve(line, [...at, ...this.anchors[i].toArray()]);
        line.material.color.set(COLORS.slack);
        line.material.dashed = false;
      });
      if (this.lines.length) {
        this.platformMaterial.opacity = OPACITY_BROKEN;
      }
    }
    this.draw();
  }

  /** Draws the cable that is nearest to its limit thick, with its whole name. */
  markLimiting(index) {
    if (this.limiting === index) {
      return;
    }
    this.limiting = index;
    this.lines.forEach((line, i) => {
      line.material.linewidth = i === index ? WIDTH_LIMITING : WIDTH;
      const label = this.labels.children[i];
      label.classList.toggle("limiting", i === index);
      label.textContent = i === index ? this.names[i] : this.shortNames[i];
    });
  }

  /** Shows a wanted pose that has no equilibrium as a pale body; null hides it. */
  setGhost(pose) {
    this.ground.setGhost(pose);
    this.draw();
  }

  /** Colours the plane of a measure; null takes it away. */
  setPlane(of) {
    this.ground.setPlane(of);
    this.draw();
  }

  /** Points of a cable with its sag multiplied. */
  exaggerated({ points, attachment, anchor }) {
    if (this.exaggeration === 1) {
      return points;
    }
    const last = points.length / 3 - 1;
    return Float64Array.from(points, (value, at) => {
      const [i, k] = [Math.floor(at / 3), at % 3];
      const chord = attachment[k] + ((anchor[k] - attachment[k]) * i) / last;
      return chord + this.exaggeration * (value - chord);
    });
  }

  /** Keeps the curves of a frame as thin lines, for comparison; nothing removes them. */
  remember(frame) {
    this.remembered.clear();
    if (frame) {
      const [dashSize, gapSize] = [0.012 * this.size, 0.008 * this.size];
      const material = new LineDashedMaterial({ color: COLORS.slack, dashSize, gapSize });
      for (const { points } of frame.cables) {
        const pairs = [];
        for (let i = 0; i + 3 < points.length; i += 3) {
          pairs.push(points[i], points[i + 1], points[i + 2], points[i + 3], points[i + 4], points[i + 5]);
        }
        const geometry = new BufferGeometry();
        geometry.setAttribute("position", new BufferAttribute(Float32Array.from(pairs), 3));
        const line = new LineSegments(geometry, material);
        line.computeLineDistances();
        this.remembered.add(line);
      }
    }
    this.draw();
  }

  /** Moves anchors and posts on flexible supports. `moved(i)`: displacement of the anchor of cable i on the screen. */
  moveSupports(moved) {
    if (!this.drives.kinds.supports) {
      return;
    }
    this.drives.move(moved);
    const [points, posts] = [this.anchorPoints, this.posts].map((one) => one.geometry.getAttribute("position"));
    this.drives.cables.forEach(({ place, support }, i) => {
      if (support) {
        const to = place.clone().add(moved(i));
        points.setXYZ(i, to.x, to.y, to.z);
        posts.setXYZ(2 * i, to.x, to.y, to.z);
      }
    });
    points.needsUpdate = posts.needsUpdate = true;
  }

  /** Looks from a named direction. */
  look(name) {
    const directions = {
      oblique: [0.62, -1, 0.42],
      front: [0, -1, 0.0001],
      side: [1, 0, 0.0001],
      top: [0, -0.0001, 1],
    };
    const direction = new Vector3(...directions[name]).normalize();
    const wide = Math.max(1, 1.25 / this.camera.aspect);
    const distance = (VIEW_HALF * this.size * wide) / Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    this.camera.near = distance / 200;
    this.camera.far = distance * 20;
    this.camera.updateProjectionMatrix();
    this.orbit.target.copy(this.center);
    this.camera.position.copy(this.center).addScaledVector(direction, distance);
    this.orbit.update();
    this.draw();
  }

  /** Position and target of the camera, for a link. */
  get camera6() {
    const numbers = [...this.camera.position.toArray(), ...this.orbit.target.toArray()];
    return numbers.map((value) => Number(value.toPrecision(5)));
  }

  set camera6(numbers) {
    this.camera.position.set(...numbers.slice(0, 3));
    this.orbit.target.set(...numbers.slice(3));
    this.orbit.update();
  }

  /** Picture of the view as PNG. */
  png() {
    this.renderer.render(this.scene, this.camera);
    return new Promise((done) => this.canvas.toBlob(done, "image/png"));
  }
}
