// Curve of a cable in the view.

/** Puts a curve through points; it keeps its memory while their number stays, because a drag makes many curves. */
export function setCurve({ geometry }, points) {
  const segments = points.length / 3 - 1;
  const data = geometry.getAttribute("instanceStart")?.data;
  if (data?.array.length !== 6 * segments) {
    geometry.setPositions(points);
    return;
  }
  for (let i = 0; i < segments; i += 1) {
    for (let k = 0; k < 6; k += 1) {
      data.array[6 * i + k] = points[3 * i + k];
    }
  }
  data.needsUpdate = true;
}
