// Obstacles, bodies of the platform, and the line between the things that are nearest to each other.

import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  EdgesGeometry,
  Group,
  Line,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshLambertMaterial,
  Vector3,
} from "three";

const EDGE_ANGLE = 20; // degrees: edges between flatter faces are those of a round body

export class Obstacles {
  /** @param {object} about description of the robot: `obstacles` and `platform_bodies`, each with its `corners` */
  constructor(about) {
    this.materials = {
      body: new MeshLambertMaterial({ side: DoubleSide, transparent: true, opacity: 0.35, depthWrite: false }),
      edge: new LineBasicMaterial(),
      near: new LineBasicMaterial(),
    };
    /** Part of the scene. */
    this.group = this.#groupOf(about.obstacles ?? []);
    /** Part of the platform. */
    this.onPlatform = this.#groupOf(about.platform_bodies ?? []);
    this.near = new Line(new BufferGeometry(), this.materials.near);
    this.near.frustumCulled = false;
    this.near.visible = false;
    this.group.add(this.near);
  }

  #groupOf(bodies) {
    const group = new Group();
    for (const { name, corners } of bodies) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(new Float32Array(corners), 3));
      geometry.computeVertexNormals();
      const body = new Mesh(geometry, this.materials.body);
      body.name = name;
      group.add(body, new LineSegments(new EdgesGeometry(geometry, EDGE_ANGLE), this.materials.edge));
    }
    return group;
  }

  /** Shows the nearest pair of a frame. */
  setFrame({ about }) {
    const nearest = about.clearance;
    this.near.visible = Boolean(nearest);
    if (nearest) {
      this.near.geometry.setFromPoints(nearest.points_m.map((point) => new Vector3(...point)));
      this.tooNear = nearest.margin_m < 0;
      this.materials.near.color.set(this.tooNear ? this.colors.warn : this.colors.free);
    }
  }

  recolor(color) {
    this.colors = { warn: color("--warn"), free: color("--green") };
    this.materials.body.color.set(color("--soft"));
    this.materials.edge.color.set(color("--soft"));
    this.materials.near.color.set(this.tooNear ? this.colors.warn : this.colors.free);
  }
}
