// Picture of the view as SVG: the same camera, drawn with lines.

import { Vector3 } from "three";
import { escaped } from "./format.js";

/** Picture of a view as the text of an SVG file. */
export function drawing(view) {
  const { clientWidth: width, clientHeight: height } = view.place;
  const style = getComputedStyle(document.documentElement);
  const color = (name) => style.getPropertyValue(name).trim();
  const project = (x, y, z) => {
    const point = new Vector3(x, y, z).project(view.camera);
    return `${(((point.x + 1) * width) / 2).toFixed(2)},${(((1 - point.y) * height) / 2).toFixed(2)}`;
  };
  const polyline = (points, stroke, more) => {
    const places = Array.from({ length: points.length / 3 }, (_, i) => project(...points.slice(3 * i, 3 * i + 3)));
    return `<polyline fill="none" stroke="${stroke}" ${more} points="${places.join(" ")}"/>`;
  };
  const parts = [];
  const [low] = view.box;
  for (const line of [...view.platform.children].filter((child) => child.isLineSegments)) {
    const position = line.geometry.getAttribute("position");
    for (let i = 0; i < position.count; i += 2) {
      const end = (k) => new Vector3().fromBufferAttribute(position, k).applyMatrix4(line.matrixWorld).toArray();
      const ends = [i, i + 1].flatMap(end);
      parts.push(polyline(ends, color("--ink"), 'stroke-width="1"'));
    }
  }
  if (view.platform.children.length === 1) {
    const [x, y] = project(...view.frame.position).split(",");
    parts.push(`<circle cx="${x}" cy="${y}" r="6" fill="${color("--platform")}"/>`);
  }
  view.drives?.lines().forEach((points) => parts.push(polyline(points.flat(), color("--soft"), 'stroke-width="1"')));
  view.drives?.marks().forEach(({ place, color: fill }) => {
    const [x, y] = project(...place).split(",");
    parts.push(`<circle cx="${x}" cy="${y}" r="4" fill="${fill}"/>`);
  });
  view.frame?.cables.forEach((cable, i) => {
    const { material } = view.lines[i];
    const dashes = material.dashed ? 'stroke-dasharray="5 4"' : "";
    const curve = Array.from(view.exaggerated(cable));
    parts.push(polyline(curve, `#${material.color.getHexString()}`, `stroke-width="2" ${dashes}`));
    const anchor = Array.from(cable.anchor);
    const [x, y] = project(...anchor).split(",");
    parts.push(polyline([...anchor, anchor[0], anchor[1], Math.min(0, low.z)], color("--line"), 'stroke-width="1"'));
    parts.push(
      `<circle cx="${x}" cy="${y}" r="3" fill="${color("--ink")}"/>` +
        `<text x="${x}" y="${Number(y) - 7}" font-size="12" text-anchor="middle" fill="${color("--soft")}">` +
        `${escaped(view.names[i])}</text>`,
    );
  });
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}"` +
    ` font-family="sans-serif"><rect width="100%" height="100%" fill="${color("--paper")}"/>${parts.join("")}</svg>`
  );
}
