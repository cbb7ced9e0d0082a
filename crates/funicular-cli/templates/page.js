(function () {
  "use strict";
  // A narrow screen has no room for the buttons beside the legend.
  const config = { responsive: true, displayModeBar: window.innerWidth > 640 ? "hover" : false, displaylogo: false, modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"] };
  const plots = [];
  document.querySelectorAll("script[data-plot]").forEach(function (source) {
    const figure = JSON.parse(source.textContent);
    const place = document.getElementById(source.dataset.plot);
    Plotly.newPlot(place, figure.data, figure.layout, config);
    plots.push(place);
  });
  function redraw() { plots.forEach(function (place) { Plotly.Plots.resize(place); }); }
  function size(place) { return { width: place.clientWidth, height: place.clientHeight }; }
  window.addEventListener("beforeprint", function () {
    document.body.classList.add("printing");
    // Hidden parts print too: a page on paper cannot be unfolded.
    document.querySelectorAll("details").forEach(function (part) { part.dataset.was = part.open; part.open = true; });
    plots.forEach(function (place) { Plotly.relayout(place, size(place)); });
  });
  window.addEventListener("afterprint", function () {
    document.body.classList.remove("printing");
    document.querySelectorAll("details").forEach(function (part) { part.open = part.dataset.was === "true"; });
    plots.forEach(function (place) { Plotly.relayout(place, { width: null, height: null, autosize: true }); });
    redraw();
  });
}());
