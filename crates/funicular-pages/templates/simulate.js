// Marks the time of the moving robot in the figures over time.
(async function () {
  "use strict";
  await page.drawn;
  const cursors = ["figure-position", "figure-turn", "figure-tensions", "figure-lengths"].map(function (id) {
    const place = document.getElementById(id + "-plot");
    if (!place) { return null; }
    const cursor = document.createElement("i");
    cursor.className = "cursor";
    place.style.position = "relative";
    place.append(cursor);
    return { place: place, cursor: cursor };
  }).filter(Boolean);
  let now = 0;
  function mark() {
    cursors.forEach(function (of) {
      const layout = of.place._fullLayout;
      if (!layout || !layout.xaxis || !layout.xaxis.l2p) { return; }
      const at = layout.xaxis.l2p(now), size = layout._size;
      of.cursor.hidden = at < 0 || at > size.w;
      of.cursor.style.left = layout.xaxis._offset + at + "px";
      of.cursor.style.top = size.t + "px";
      of.cursor.style.height = size.h + "px";
    });
  }
  document.addEventListener("motion", function (event) { now = event.detail; mark(); });
  cursors.forEach(function (of) { if (of.place.on) { of.place.on("plotly_afterplot", mark); } });
  mark();
}());
