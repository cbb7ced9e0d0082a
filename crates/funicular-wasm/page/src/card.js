// Card to share: the view, its figures, the legend with numbers, the link and its QR code, as one picture.

import { encode } from "uqr";
import { $ } from "./format.js";
import { page } from "./store.js";

const [WIDTH, MARGIN, CODE] = [1200, 32, 260]; // pixels
const MAX_CODE = 2300; // characters of a link: a QR code with more can hardly be photographed

const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const FONT = "system-ui, sans-serif";

/** Writes a text that breaks between words; returns the height under it. */
function write(pen, text, { x, y, width, size, color = "--ink", weight = 400 }) {
  pen.font = `${weight} ${size}px ${FONT}`;
  pen.fillStyle = style(color);
  let [line, at] = ["", y];
  for (const word of text.split(" ")) {
    const next = line ? `${line} ${word}` : word;
    if (line && pen.measureText(next).width > width) {
      pen.fillText(line, x, at);
      [line, at] = [word, at + 1.35 * size];
    } else {
      line = next;
    }
  }
  pen.fillText(line, x, at);
  return at + 1.35 * size;
}

/** Figures over the view, as the page shows them. */
const figures = () =>
  [...$("hud").children].map((one) => ({
    name: one.firstChild.textContent,
    value: one.lastChild.firstChild.textContent,
    more: one.lastChild.lastChild.textContent,
  }));

function drawCode(pen, link, x, y) {
  const { data, size } = encode(link, { border: 2 });
  const cell = CODE / size;
  pen.fillStyle = "#fff";
  pen.fillRect(x, y, CODE, CODE);
  pen.fillStyle = "#000";
  data.forEach((row, i) =>
    row.forEach((dark, j) => dark && pen.fillRect(x + j * cell, y + i * cell, cell + 0.4, cell + 0.4)),
  );
}

/** Legend of the tensions with the colours of the view. */
function drawLegend(pen, x, y) {
  const [scale] = $("legend").querySelectorAll("i");
  if (!scale) {
    return;
  }
  const colors = scale.style.background.match(/rgb\([^)]*\)|#[0-9a-f]{6}/g) ?? [];
  const gradient = pen.createLinearGradient(x, 0, x + 220, 0);
  colors.forEach((color, i) => gradient.addColorStop(i / Math.max(1, colors.length - 1), color));
  pen.fillStyle = gradient;
  pen.fillRect(x, y - 11, 220, 12);
  const numbers = $("legend")
    .firstElementChild.innerText.replace("Tension: ", "")
    .replace(/\s+(maximum|highest) /, " – $1 ");
  write(pen, `Tension: ${numbers}`, { x: x + 236, y, width: WIDTH, size: 17, color: "--soft" });
}

/** Pose of the platform in words. */
function poseText() {
  const number = (value, digits) => value.toFixed(digits).replace(/^-(0\.?0*)$/, "$1");
  if (!page.pose) {
    return "";
  }
  const [x, y, z, ...turn] = page.pose;
  const place = [x, y, z].map((value) => number(value, 3)).join(", ");
  const turned = turn.some((angle) => Math.abs(angle) >= 0.005);
  return `Platform at ${place} m${turned ? `, turned by ${turn.map((angle) => number(angle, 2)).join(", ")}°` : ""}`;
}

/**
 * Picture of the present state.
 * @param {string} link address with the state
 * @returns {Promise<Blob>} PNG
 */
export async function card(link) {
  const view = await createImageBitmap(await page.view.png());
  const inside = WIDTH - 2 * MARGIN;
  const high = Math.round((inside * view.height) / view.width);
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [WIDTH, high + CODE + 315];
  const pen = canvas.getContext("2d");
  pen.fillStyle = style("--paper");
  pen.fillRect(0, 0, canvas.width, canvas.height);
  const name = write(pen, page.about.name, { x: MARGIN, y: 52, width: inside, size: 32, weight: 600 });
  const top = write(pen, poseText(), { x: MARGIN, y: name + 8, width: inside, size: 17, color: "--soft" }) + 14;
  pen.drawImage(view, MARGIN, top - 10, inside, high);
  drawLegend(pen, MARGIN, top + high + 20);

  // Figures in two columns, the code on the right.
  const isCoded = link.length <= MAX_CODE;
  const column = (inside - CODE) / 2;
  figures().forEach(({ name, value, more }, i) => {
    const [x, y] = [MARGIN + (i % 2) * column, top + high + 74 + Math.floor(i / 2) * 118];
    write(pen, name, { x, y, width: column - 20, size: 17, color: "--soft" });
    write(pen, value, { x, y: y + 36, width: column - 20, size: 30, weight: 600 });
    write(pen, more, { x, y: y + 64, width: column - 20, size: 17, color: "--soft" });
  });
  const under = canvas.height - 22;
  if (isCoded) {
    drawCode(pen, link, WIDTH - MARGIN - CODE, top + high + 46);
  }
  const address = link.split("#")[0].replace(/^file:.*\//, "");
  const words = isCoded ? `${address} – the code opens this state` : `${address} – the link is too long for a code`;
  write(pen, `funicular – statics and vibration of cable-driven robots. ${words}`, {
    x: MARGIN,
    y: under,
    width: inside,
    size: 16,
    color: "--soft",
  });
  return new Promise((done) => canvas.toBlob(done, "image/png"));
}
