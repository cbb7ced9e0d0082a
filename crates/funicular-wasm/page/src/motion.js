// Playback of a mode, of a release or of a simulation in the view.

import { Quaternion, Vector3 } from "three";
import { setCurve } from "./curve.js";

const PERIOD_S = 1.6; // of a mode on the screen
const MODE_SIZE = 0.035; // of the size of the robot: the largest displacement on the screen
const RELEASE_SIZE = 0.3; // of the size of the robot: with more, a release would leave the robot
const RECORD_WITH_REST = 1.15; // of the length of a record: it begins again after a rest, which shows where it ends

/** Displacement of a point of the platform, by its place from the origin: translation and small rotation. */
const displacement = ([dx, dy, dz, rx, ry, rz], [x, y, z]) => [
  dx + ry * z - rz * y,
  dy + rz * x - rx * z,
  dz + rx * y - ry * x,
];

/** Largest displacement of the points of the cables and of the platform, whose farthest point is at `radius`. */
function largestOf({ cables, shape }, radius) {
  let largest = 1e-30; // not zero, because the scale of the motion is divided by it
  for (let i = 0; i < cables.length; i += 3) {
    largest = Math.max(largest, Math.hypot(cables[i], cables[i + 1], cables[i + 2]));
  }
  return Math.max(largest, Math.hypot(...shape.slice(0, 3)), Math.hypot(...shape.slice(3)) * radius);
}

/** Motion of the robot of a view about the frame that the view shows. */
export class Playback {
  #view;

  /** @param {View} view */
  constructor(view) {
    this.#view = view;
    this.amplitude = 1;
    /** Mode or release in motion; null without one. */
    this.mode = null;
  }

  /** Plays a mode: displacements of the points of the cables and motion of the platform; null ends it. */
  setMode(mode) {
    const view = this.#view;
    const playing = this.mode?.playing ?? !matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.mode = mode && { ...mode, playing: mode.playing ?? playing, start: this.mode?.start ?? performance.now() };
    if (this.mode) {
      // The largest displacement is a fixed fraction of the robot.
      this.mode.cables ??= this.#straight(this.mode.shape);
      const largest = largestOf(this.mode, Math.max(...view.attachments.map((point) => point.length()), 0));
      this.mode.scale = (MODE_SIZE * view.size) / largest;
      if (mode.release && this.mode.scale < 1) {
        // A release that can be seen without magnification is shown as it is, unless it leaves the robot.
        this.mode.scale = Math.min(1, (RELEASE_SIZE * view.size) / largest);
      }
    } else if (view.frame) {
      view.setFrame(view.frame, view.dragging);
    }
    view.draw();
  }

  /**
   * Plays a free response; null ends it.
   * @param {object} release `start` and `at(seconds)` with `shape` and `cables` (null: straight lines), `seconds` until
   *   the record begins again, `slowdown` of the time, `clock(seconds)`, which is told the time of each picture
   */
  setRelease(release) {
    this.setMode(release && { ...release.start, release, playing: true });
    if (this.mode) {
      this.mode.start = performance.now();
    }
  }

  /**
   * Plays a simulated motion; null ends it.
   * @param {object} simulation `times` [s], `poses` (position and quaternion w, x, y, z) and `curves` (coordinates of
   *   the points of every cable) at these times, `enlargement` of the displacements since the start, `clock(seconds)`
   */
  setSimulation(simulation) {
    const view = this.#view;
    this.mode = simulation && { simulation, playing: true, start: performance.now() };
    if (!simulation && view.frame) {
      view.setFrame(view.frame, view.dragging);
    }
    view.draw();
  }

  /** Moves the robot to its place in the simulation at a time of the screen [ms], straight between two pictures. */
  #showSimulation(now) {
    const view = this.#view;
    const { simulation, start } = this.mode;
    const { times, poses, curves, enlargement, clock } = simulation;
    const end = times.at(-1);
    const t = Math.max(0, Math.min(((now - start) / 1000) % (RECORD_WITH_REST * end), end));
    clock(t);
    const next = Math.max(
      1,
      times.findIndex((time) => time >= t),
    );
    const part = (t - times[next - 1]) / (times[next] - times[next - 1]);
    const between = (of, k) => of[next - 1][k] + part * (of[next][k] - of[next - 1][k]);
    const larger = (first, value) => first + enlargement * (value - first);
    view.lines.forEach((line, i) => {
      const of = curves.map((frame) => frame[i]);
      // A cable without mass that was cut is gone.
      line.visible = of[next].length > 0;
      if (line.visible && of[next - 1].length > 0) {
        setCurve(
          line,
          of[next].map((_, k) => larger(of[0][k], between(of, k))),
        );
      }
    });
    view.platform.position.set(...[0, 1, 2].map((k) => larger(poses[0][k], between(poses, k))));
    const turn = ([, , , w, x, y, z]) => new Quaternion(x, y, z, w);
    const away = turn(poses[next - 1])
      .slerp(turn(poses[next]), part)
      .multiply(turn(poses[0]).invert());
    const angle = 2 * Math.acos(Math.min(1, Math.abs(away.w)));
    const axis = new Vector3(away.x, away.y, away.z).multiplyScalar(Math.sign(away.w) || 1);
    const extra = new Quaternion().setFromAxisAngle(
      axis.length() > 0 ? axis.normalize() : new Vector3(0, 0, 1),
      enlargement * angle,
    );
    view.platform.quaternion.copy(extra.multiply(turn(poses[0])));
  }

  /** Factor by which the motion of the release is larger than it is. */
  get releaseScale() {
    return this.mode?.release ? this.mode.scale * this.amplitude : 1;
  }

  /** Displacements of the points of the cables if their curves are unknown: straight lines that follow the platform. */
  #straight(shape) {
    const { frame } = this.#view;
    return Float64Array.from(
      frame.cables.flatMap(({ attachment, points }) => {
        const end = displacement(
          shape,
          attachment.map((value, k) => value - frame.position[k]),
        );
        const last = points.length / 3 - 1;
        return Array.from(points, (_, k) => end[k % 3] * (1 - Math.floor(k / 3) / last));
      }),
    );
  }

  /** Displacements on the screen at a time of the screen [ms]. */
  #at(now) {
    const { mode } = this;
    const { start, playing, release } = mode;
    if (release) {
      const t = ((now - start) / 1000 / release.slowdown) % (RECORD_WITH_REST * release.seconds);
      release.clock(Math.min(t, release.seconds));
      const found = release.at(Math.max(0, Math.min(t, release.seconds)));
      return { ...found, cables: found.cables ?? this.#straight(found.shape), factor: mode.scale * this.amplitude };
    }
    const phase = playing ? Math.sin((2 * Math.PI * (now - start)) / (1000 * PERIOD_S)) : 1;
    return { ...mode, factor: phase * mode.scale * this.amplitude };
  }

  /** Moves the bodies of the view to their places at a time of the screen [ms], if there is a motion. */
  show(now) {
    if (!this.mode) {
      return;
    }
    if (this.mode.simulation) {
      this.#showSimulation(now);
      return;
    }
    const view = this.#view;
    const { frame } = view;
    const { cables, shape, factor } = this.#at(now);
    const perCable = cables.length / frame.cables.length;
    view.moveSupports((i) => new Vector3(...[3, 2, 1].map((k) => factor * cables[(i + 1) * perCable - k])));
    let at = 0;
    frame.cables.forEach((cable, i) => {
      const own = view.exaggerated(cable);
      const moved = Float64Array.from(own, (value, k) => value + factor * cables[at + k]);
      at += own.length;
      setCurve(view.lines[i], moved);
    });
    const [w, x, y, z] = frame.quaternion;
    view.platform.position.set(...frame.position.map((value, k) => value + factor * shape[k]));
    const turn = new Vector3(shape[3], shape[4], shape[5]).multiplyScalar(factor);
    const angle = turn.length();
    const extra = new Quaternion().setFromAxisAngle(angle > 0 ? turn.normalize() : new Vector3(0, 0, 1), angle);
    view.platform.quaternion.copy(extra.multiply(new Quaternion(x, y, z, w)));
  }
}
