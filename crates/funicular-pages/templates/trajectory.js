// Moves the robot of a trajectory in its figure: by the time of a slider, or over time.
(async function () {
  "use strict";
  const panel = document.getElementById("motion-time");
  const [button, slider, output] = ["button", "input", "output"].map(function (name) { return panel.querySelector(name); });
  const moving = JSON.parse(document.getElementById("motion-frames").textContent);
  const place = document.getElementById("figure-robot-plot");
  const figure = JSON.parse(document.querySelector('script[data-plot="figure-robot-plot"]').textContent);
  await page.drawn;

  // Coordinates of a frame in the traces that move.
  function show(number) {
    moving.traces.forEach(function (trace, k) {
      const [x, y, z] = moving.frames[number][k];
      figure.data[trace] = Object.assign({}, figure.data[trace], { x: x, y: y, z: z });
    });
    output.textContent = moving.times[number].toFixed(2) + " s";
    // The reader's view of the scene stays.
    const layout = Object.assign({}, figure.layout, { uirevision: "motion" });
    return page.show(place, figure.data.slice(), layout);
  }

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
    const begun = performance.now() - 1000 * moving.times[from];
    while (playing) {
      const now = 0.001 * (performance.now() - begun);
      let number = moving.times.findIndex(function (time) { return time >= now; });
      if (number < 0) { number = last; }
      slider.value = number;
      await show(number);
      await new Promise(function (next) { requestAnimationFrame(next); });
      if (number === last) { stop(); }
    }
  });
}());
