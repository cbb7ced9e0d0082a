// A calibration in the view: anchors of the file and calibrated ones with their ellipsoids, the weakest combination,
// poses of the rows, and poses to measure next.

import {
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  Color,
  Group,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  Points,
  PointsMaterial,
  SphereGeometry,
  Sprite,
  SpriteMaterial,
} from "three";
import { spreadOf } from "../../../funicular-pages/templates/refit.js";

const OPACITY = 0.3; // of an ellipsoid, so that the cables are seen through it
const DEVIATIONS = 2; // of the half axes of an ellipsoid
const NAME_SIZE = 0.035; // of the robot's size: height of the number of a proposed pose
const COLOURS = {
  file: "--soft",
  calibrated: "--accent",
  weakest: "--warn",
  row: "--green",
  away: "--grid",
  next: "--violet",
};

/** Number on a transparent square, as a picture that faces the camera. */
function numberSprite(text, colour) {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [64, 64];
  const pen = canvas.getContext("2d");
  [pen.font, pen.textAlign, pen.textBaseline] = ["bold 44px sans-serif", "center", "middle"];
  pen.fillStyle = `#${colour.getHexString()}`;
  pen.fillText(text, 32, 34);
  return new Sprite(new SpriteMaterial({ map: new CanvasTexture(canvas), depthTest: false }));
}

export class CalibrationScene {
  constructor(scene) {
    this.group = new Group();
    this.color = () => new Color();
    this.shown = null;
    scene.add(this.group);
  }

  /**
   * Shows a calibration; null takes it away.
   * @param {?object} of `anchors` (list of `start`, `position`, and `covariance` and `weakest`, which may be null),
   *   `rows` (list of `position`, `isLeftOut`), `proposals` (positions), `scale` of the ellipsoids, `size` of the robot
   */
  set(of) {
    this.#dispose();
    this.shown = of;
    if (!of) {
      return;
    }
    const { anchors, rows, proposals, scale } = of;
    this.#points(
      "file",
      anchors.map(({ start }) => start),
      7,
    );
    this.#lines(
      "file",
      anchors.map(({ start, position }) => [start, position]),
    );
    this.#points(
      "calibrated",
      anchors.map(({ position }) => position),
      8,
    );
    anchors.filter(({ covariance }) => covariance).forEach((anchor) => this.#ellipsoid(anchor, scale));
    const ends = ({ position, weakest }) =>
      [-1, 1].map((side) => position.map((at, k) => at + side * DEVIATIONS * scale * weakest[k]));
    this.#lines("weakest", anchors.filter(({ weakest }) => weakest).map(ends));
    this.#points(
      "row",
      rows.filter(({ isLeftOut }) => !isLeftOut).map(({ position }) => position),
      6,
    );
    this.#points(
      "away",
      rows.filter(({ isLeftOut }) => isLeftOut).map(({ position }) => position),
      6,
    );
    this.#points("next", proposals, 10);
    proposals.forEach((place, i) => {
      const sprite = numberSprite(String(i + 1), this.color(COLOURS.next));
      const height = NAME_SIZE * of.size;
      sprite.scale.set(height, height, 1);
      sprite.position.set(place[0], place[1], place[2] + 0.7 * height);
      this.group.add(sprite);
    });
  }

  #points(kind, places, size) {
    if (places.length) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(Float32Array.from(places.flat()), 3));
      const color = this.color(COLOURS[kind]);
      const points = new Points(
        geometry,
        new PointsMaterial({ color, size, sizeAttenuation: false, depthTest: false }),
      );
      points.name = kind;
      this.group.add(points);
    }
  }

  #lines(kind, pairs) {
    if (pairs.length) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(Float32Array.from(pairs.flat(2)), 3));
      const lines = new LineSegments(geometry, new LineBasicMaterial({ color: this.color(COLOURS[kind]) }));
      lines.name = kind;
      this.group.add(lines);
    }
  }

  /** Sphere that the factor of the covariance maps to the ellipsoid: flat along a known coordinate. */
  #ellipsoid({ position, covariance }, scale) {
    const factor = spreadOf(covariance, [0, 1, 2]).map((row) => row.map((entry) => DEVIATIONS * scale * entry));
    const color = this.color(COLOURS.calibrated);
    const material = new MeshBasicMaterial({ color, transparent: true, opacity: OPACITY, depthWrite: false });
    const body = new Mesh(new SphereGeometry(1, 32, 24), material);
    body.matrixAutoUpdate = false;
    body.matrix = new Matrix4().set(...factor.flatMap((row, k) => [...row, position[k]]), 0, 0, 0, 1);
    body.frustumCulled = false; // its sphere is not that of the ellipsoid
    body.name = "ellipsoid";
    this.group.add(body);
  }

  #dispose() {
    this.group.children.forEach(({ geometry, material }) => {
      geometry?.dispose();
      material.map?.dispose();
      material.dispose();
    });
    this.group.clear();
  }

  /** Adapts the colours. `color(name)`: a colour of the page. */
  recolor(color) {
    this.color = color;
    this.set(this.shown);
  }
}
