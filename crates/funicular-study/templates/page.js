const page = (function () {
  "use strict";
  // On a narrow screen there is no room for the buttons beside the legend.
  const config = { responsive: true, displayModeBar: window.innerWidth > 640 ? "hover" : false, displaylogo: false, modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"] };
  const plots = [];

  // Unpacks data of the page: gzip in base64.
  async function unpack(id) {
    if (typeof DecompressionStream === "undefined") {
      throw new Error("this browser cannot unpack the figures of the page; use Chrome or Edge 80, Firefox 113, Safari 16.4, or a later version");
    }
    const source = document.getElementById(id);
    const bytes = Uint8Array.from(atob(source.textContent.trim()), function (letter) { return letter.charCodeAt(0); });
    source.remove();
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip")));
  }
  function excuse(place, error) {
    const text = document.createElement("p");
    text.className = "unavailable";
    text.textContent = "Not drawn: " + error.message + ". Text and tables are complete.";
    place.replaceChildren(text);
    place.style.height = "auto";
  }
  async function draw() {
    const sources = document.querySelectorAll("script[data-plot]");
    try {
      const library = document.createElement("script");
      library.textContent = await (await unpack("plotly")).text();
      document.head.append(library);
      if (typeof Plotly === "undefined") { throw new Error("the library for the figures did not start"); }
    } catch (error) {
      sources.forEach(function (source) { excuse(document.getElementById(source.dataset.plot), error); });
      return;
    }
    sources.forEach(function (source) {
      const figure = JSON.parse(source.textContent);
      const place = document.getElementById(source.dataset.plot);
      Plotly.newPlot(place, figure.data, figure.layout, config);
      plots.push(place);
    });
  }
  const drawn = draw();

  function redraw() { plots.forEach(function (place) { Plotly.Plots.resize(place); }); }
  function size(place) { return { width: place.clientWidth, height: place.clientHeight }; }
  window.addEventListener("beforeprint", function () {
    document.body.classList.add("printing");
    // Open the hidden parts, which cannot be opened on paper.
    document.querySelectorAll("details").forEach(function (part) { part.dataset.was = part.open; part.open = true; });
    plots.forEach(function (place) { Plotly.relayout(place, size(place)); });
  });
  window.addEventListener("afterprint", function () {
    document.body.classList.remove("printing");
    document.querySelectorAll("details").forEach(function (part) { part.open = part.dataset.was === "true"; });
    plots.forEach(function (place) { Plotly.relayout(place, { width: null, height: null, autosize: true }); });
    redraw();
  });
  // Draws or updates a figure of a page's own script. The script has to wait for `drawn` before.
  function show(place, data, layout) {
    if (!plots.includes(place)) { plots.push(place); }
    return Plotly.react(place, data, layout, config);
  }
  return { unpack: unpack, excuse: excuse, drawn: drawn, show: show };
}());
