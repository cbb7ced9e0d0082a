// Reach of the platform in the view: a net between the ends of the rays, a point where each meets the border, and a
// line to the nearest border.

import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  Points,
  PointsMaterial,
} from "three";

const OPACITY = 0.07; // of the surface: cables and floor are seen through it
const NET_OPACITY = 0.25;

export class ReachScene {
  constructor(scene) {
    this.group = new Group();
    const surface = { transparent: true, opacity: OPACITY, side: DoubleSide, depthWrite: false };
    this.surface = new Mesh(new BufferGeometry(), new MeshBasicMaterial(surface));
    const net = { transparent: true, opacity: NET_OPACITY, depthWrite: false };
    this.net = new LineSegments(new BufferGeometry(), new LineBasicMaterial(net));
    this.borders = new Points(new BufferGeometry(), new PointsMaterial({ size: 3, sizeAttenuation: false }));
    this.nearest = new LineSegments(new BufferGeometry(), new LineBasicMaterial());
    this.parts = [this.surface, this.net, this.borders, this.nearest];
    this.parts.forEach((part) => {
      part.frustumCulled = false;
      this.group.add(part);
    });
    this.group.visible = false;
    scene.add(this.group);
  }

  /**
   * Shows rays from a place; null hides them.
   * @param {?object} of `from`, `rays` (list of `end`, `distance`, `isBorder`), `triangles` (three numbers of rays
   *   each, the number after the last ray is the place)
   */
  set(of) {
    const borders = of?.rays.filter(({ isBorder }) => isBorder) ?? [];
    this.group.visible = borders.length > 0;
    if (borders.length === 0) {
      return;
    }
    const nearest = borders.reduce((a, b) => (b.distance < a.distance ? b : a));
    const corners = [...of.rays.map(({ end }) => end), of.from].flat();
    this.#fill(this.surface, corners, of.triangles);
    this.#fill(this.net, corners, edgesOf(of.triangles, of.rays.length));
    this.#fill(
      this.borders,
      borders.flatMap(({ end }) => end),
    );
    this.#fill(this.nearest, [...of.from, ...nearest.end]);
  }

  #fill(part, numbers, index = null) {
    part.geometry.dispose();
    part.geometry = new BufferGeometry();
    part.geometry.setAttribute("position", new BufferAttribute(Float32Array.from(numbers), 3));
    part.geometry.setIndex(index);
  }

  /** Adapts the colours. `color(name)`: a colour of the page. */
  recolor(color) {
    this.parts.forEach(({ material }) => material.color.set(color("--warn")));
  }
}

/** Edges between the ends of rays, each once: both triangles beside an edge have it, in opposite directions. */
function edgesOf(triangles, rays) {
  const edges = [];
  for (let i = 0; i < triangles.length; i += 3) {
    const corners = triangles.slice(i, i + 3);
    corners.forEach((from, k) => {
      const to = corners[(k + 1) % 3];
      // A planar fan has the edge between two ends once, and those to its middle are left out.
      if (from < rays && to < rays && (from < to || corners.includes(rays))) {
        edges.push(from, to);
      }
    });
  }
  return edges;
}
