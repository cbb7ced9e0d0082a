// Rays of the reach in the view: a point where each meets the border, and its last part as a line towards the platform.

import { BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments, Points, PointsMaterial } from "three";

const TAIL = 0.3; // of a ray: part that is drawn, so that the platform and its cables stay clear
const MAX_TAILS = 70; // with more rays the points alone show the border

export class ReachScene {
  constructor(scene) {
    this.group = new Group();
    this.borders = new Points(
      new BufferGeometry(),
      new PointsMaterial({ size: 5, sizeAttenuation: false, transparent: true, opacity: 0.85 }),
    );
    this.tails = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ transparent: true, opacity: 0.4 }));
    this.nearest = new LineSegments(new BufferGeometry(), new LineBasicMaterial());
    [this.borders, this.tails, this.nearest].forEach((part) => {
      part.frustumCulled = false;
      this.group.add(part);
    });
    this.group.visible = false;
    scene.add(this.group);
  }

  /** Shows rays from a place: `from`, `rays` (list of `end`, `distance`, `isBorder`); null hides them. */
  set(of) {
    const borders = of?.rays.filter(({ isBorder }) => isBorder) ?? [];
    this.group.visible = borders.length > 0;
    if (borders.length === 0) {
      return;
    }
    const tail = ({ end }) => [...end, ...end.map((at, k) => at + TAIL * (of.from[k] - at))];
    const nearest = borders.reduce((a, b) => (b.distance < a.distance ? b : a));
    fill(
      this.borders,
      borders.flatMap(({ end }) => end),
    );
    fill(this.tails, borders.length <= MAX_TAILS ? borders.flatMap(tail) : []);
    fill(this.nearest, [...of.from, ...nearest.end]);
  }

  /** Adapts the colours. `color(name)`: a colour of the page. */
  recolor(color) {
    this.borders.material.color.set(color("--warn"));
    this.tails.material.color.set(color("--warn"));
    this.nearest.material.color.set(color("--warn"));
  }
}

function fill({ geometry }, numbers) {
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(numbers), 3));
}
