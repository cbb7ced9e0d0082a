const page = (function () {
  "use strict";
  // On a narrow screen there is no room for the buttons beside the legend.
  const config = { responsive: true, displayModeBar: window.innerWidth > 640 ? "hover" : false, displaylogo: false, modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d", "toImage"] };
  const plots = [];
  // Pixels of a saved picture per pixel of the screen: 300 dots per inch for a figure printed 190 mm wide.
  const FINE = 4;

  // Saves a picture under the name of the page and the figure.
  function save(address, id, ending) {
    const name = document.title.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-+|-+$/g, "");
    const link = document.createElement("a");
    link.href = address;
    link.download = name + "-" + id.replace(/^figure-/, "") + "." + ending;
    document.body.append(link);
    link.click();
    link.remove();
  }
  // Adds the buttons that save a figure: one for each ending in `formats`, which gives a promise of the picture's
  // address. They stand above the figure, so that neither they nor plotly's buttons cover the legend.
  function offer(place, formats) {
    const row = document.createElement("div"), id = place.closest("figure").id;
    row.className = "save";
    Object.keys(formats).forEach(function (ending) {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = ending.toUpperCase();
      button.title = "Save this figure as " + ending.toUpperCase();
      button.addEventListener("click", async function () {
        button.disabled = true;
        try { save(await formats[ending](), id, ending); } finally { button.disabled = false; }
      });
      row.append(button);
    });
    place.before(row);
  }
  function offerPlot(place) {
    const picture = function (format, scale) {
      return function () { return Plotly.toImage(place, { format: format, width: place.clientWidth, height: place.clientHeight, scale: scale }); };
    };
    // Plotly draws a view in space as pixels, also inside an SVG file.
    const lines = place.classList.contains("scene") ? function () { return space.svgOf(place); } : picture("svg", 1);
    offer(place, { svg: lines, png: picture("png", FINE) });
  }

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
      offerPlot(place);
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
    if (!plots.includes(place)) {
      plots.push(place);
      offerPlot(place);
    }
    return Plotly.react(place, data, layout, config);
  }
  return { unpack: unpack, excuse: excuse, drawn: drawn, show: show, offer: offer, fine: FINE };
}());
