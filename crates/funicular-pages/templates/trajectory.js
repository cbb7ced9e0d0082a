// Moves a robot in its figure: by the time of a slider, or over time, with the speed and the enlargement of
// selections if there are any. The
// event "motion" of the document has the time that is shown.
(async function () {
  "use strict";
  const panel = document.getElementById("motion-time");
  const [button, slider, output] = ["button", "input", "output"].map(function (name) { return panel.querySelector(name); });
  const [speed, enlargement] = ["speed", "enlargement"].map(function (name) { return panel.querySelector("[name=" + name + "]"); });
  const moving = JSON.parse(document.getElementById("motion-frames").textContent);
  const place = document.getElementById("figure-robot-plot");
  const figure = JSON.parse(document.querySelector('script[data-plot="figure-robot-plot"]').textContent);
  // Two frames that follow each other differ in the shown time.
  const interval = moving.times.length > 1 ? moving.times[1] - moving.times[0] : 1;
  const decimals = Math.min(6, Math.max(2, Math.ceil(-Math.log10(interval))));
  await page.drawn;

  // Coordinates of a frame in the traces that move.
  function show(number) {
    const factor = enlargement ? Number(enlargement.value) : 1;
    moving.traces.forEach(function (trace, k) {
      const [x, y, z] = moving.frames[number][k].map(function (axis, i) {
        const start = moving.frames[0][k][i];
        return axis.map(function (value, at) { return start[at] + factor * (value - start[at]); });
      });
      figure.data[trace] = Object.assign({}, figure.data[trace], { x: x, y: y, z: z });
    });
    output.textContent = moving.times[number].toFixed(decimals) + " s";
    document.dispatchEvent(new CustomEvent("motion", { detail: moving.times[number] }));
    // The reader's view of the scene stays.
    const layout = Object.assign({}, figure.layout, { uirevision: "motion" });
    return page.show(place, figure.data.slice(), layout);
  }

  if (enlargement) { enlargement.addEventListener("change", function () { show(Number(slider.value)); }); }
  let playing = false;
  function stop() {
    playing = false;
    button.textContent = "Play";
  }
  slider.addEventListener("input", function () {
    stop();
    show(Number(slider.value));
  });
  button.addEventListener("click", async function () {
    if (playing) { return stop(); }
    playing = true;
    button.textContent = "Stop";
    const last = moving.times.length - 1;
    const from = Number(slider.value) < last ? Number(slider.value) : 0;
    let now = moving.times[from], before = performance.now();
    while (playing) {
      const clock = performance.now();
      now += 0.001 * (clock - before) * (speed ? Number(speed.value) : 1);
      before = clock;
      let number = moving.times.findIndex(function (time) { return time >= now; });
      if (number < 0) { number = last; }
      slider.value = number;
      await show(number);
      await new Promise(function (next) { requestAnimationFrame(next); });
      if (number === last) { stop(); }
    }
  });
}());
