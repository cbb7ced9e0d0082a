// Gallery of the library: a picture and plain words of each robot.

import { Cancelled, Job } from "./engine.js";
import { $, element } from "./format.js";
import { frameOf } from "./frame.js";
import { titles } from "./library.js";
import { setRobot, showLibrary } from "./robot.js";

const [WIDTH, HEIGHT, MARGIN] = [220, 140, 10]; // of a picture, in pixels
const POINTS = 12; // per cable
const job = new Job();

/** Oblique parallel projection: x to the right, y into the picture, z up. */
const projected = ([x, y, z]) => [x + 0.45 * y, -z - 0.28 * y];

/** Corners of the outline of points in a plane. */
function hullOf(points) {
  const sorted = [...points].sort(([ax, ay], [bx, by]) => ax - bx || ay - by);
  const side = ([ax, ay], [bx, by], [cx, cy]) => (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
  const half = (list) =>
    list.reduce((hull, point) => {
      while (hull.length > 1 && side(hull.at(-2), hull.at(-1), point) <= 0) {
        hull.pop();
      }
      return [...hull, point];
    }, []);
  const [low, high] = [half(sorted), half(sorted.reverse())];
  return [...low.slice(0, -1), ...high.slice(0, -1)];
}

/** Picture of a robot at rest as SVG. */
function picture({ cables, position }, about) {
  const curves = cables.map(({ points }) =>
    Array.from({ length: points.length / 3 }, (_, i) => projected(points.slice(3 * i, 3 * i + 3))),
  );
  const floor = Math.min(0, ...about.check.cables.map(({ anchor_m: [, , z] }) => z));
  const posts = cables.map(({ anchor: [x, y, z] }) => [projected([x, y, z]), projected([x, y, floor])]);
  const all = [...curves, ...posts].flat();
  const [left, top] = [0, 1].map((k) => Math.min(...all.map((point) => point[k])));
  const [right, bottom] = [0, 1].map((k) => Math.max(...all.map((point) => point[k])));
  const [wide, high] = [WIDTH, HEIGHT].map((size) => size - 2 * MARGIN);
  const scale = Math.min(wide / (right - left || 1), high / (bottom - top || 1));
  const [dx, dy] = [(WIDTH - scale * (right - left)) / 2, (HEIGHT - scale * (bottom - top)) / 2];
  const at = ([x, y]) => `${(dx + scale * (x - left)).toFixed(1)} ${(dy + scale * (y - top)).toFixed(1)}`;
  const path = (points, kind) => `<path class="${kind}" d="M${points.map(at).join("L")}"/>`;
  const body = hullOf(cables.map(({ attachment }) => projected(attachment)));
  const [x, y] = at(projected(position)).split(" ");
  const isBody = body.some(([u, v]) => Math.hypot(u - body[0][0], v - body[0][1]) > 0);
  const platform = isBody ? path([...body, body[0]], "body") : `<circle class="body" cx="${x}" cy="${y}" r="4"/>`;
  return (
    `<svg viewBox="0 0 ${WIDTH} ${HEIGHT}" aria-hidden="true">${posts.map((post) => path(post, "post")).join("")}` +
    `${curves.map((curve) => path(curve, "cable")).join("")}${platform}</svg>`
  );
}

async function draw(cards) {
  try {
    await job.run(1, async ([worker]) => {
      for (const [name, place] of cards) {
        try {
          const { about } = await worker.call("robot", { request: { robot: { name, text: ROBOTS[name] } } });
          const { numbers } = await worker.call("frame", { kind: 0, state: [], modes: 0, points: POINTS });
          place.innerHTML = picture(frameOf(numbers), about);
        } catch (error) {
          if (error instanceof Cancelled) {
            throw error;
          }
          place.textContent = "no picture";
        }
      }
    });
  } catch (error) {
    if (!(error instanceof Cancelled)) {
      throw error;
    }
  }
}

let drawn = false;

function open() {
  const dialog = $("gallery");
  dialog.showModal();
  if (drawn) {
    return;
  }
  drawn = true;
  const cards = [];
  const items = titles(ROBOTS).map(([name, title]) => {
    const place = element("span", { class: "picture" });
    cards.push([name, place]);
    const [first, ...rest] = title.split(", ");
    const choose = async () => {
      dialog.close();
      await setRobot(name, ROBOTS[name]);
      showLibrary();
    };
    const words = [element("b", {}, first), element("small", {}, rest.join(", "))];
    return element("li", {}, element("button", { onclick: choose, "data-robot": name }, place, ...words));
  });
  $("gallery-list").replaceChildren(...items);
  draw(cards);
}

/** Listens to the button, and to the buttons that close a dialog. */
export function listen() {
  $("gallery-open").addEventListener("click", open);
  document.querySelectorAll("dialog").forEach((dialog) => {
    dialog.querySelectorAll("[data-close]").forEach((button) => button.addEventListener("click", () => dialog.close()));
    dialog.addEventListener("click", ({ target }) => {
      if (target === dialog) {
        dialog.close();
      }
    });
  });
}
