const page = (function () {
  "use strict";
  // On a narrow screen there is no room for the buttons beside the legend.
  const config = { responsive: true, displayModeBar: window.innerWidth > 640 ? "hover" : false, displaylogo: false, modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d", "toImage"] };
  const plots = [];
  // Pixels of a saved picture per pixel of the screen: 300 dots per inch for a figure printed 190 mm wide.
  const FINE = 4;

  // Title of the page. While a figure is printed, the document has the figure's name as its title.
  const title = document.title;

  // File name of a figure without its ending: the title of the page and the figure.
  function nameOf(id) {
    return title.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-+|-+$/g, "") + "-" + id.replace(/^figure-/, "");
  }
  // Saves a picture under this file name.
  function save(address, name) {
    const link = document.createElement("a");
    link.href = address;
    link.download = name;
    document.body.append(link);
    link.click();
    link.remove();
  }
  // Opens the browser's print dialogue for a figure alone, on one page of the figure's size, with lines and texts. A
  // browser writes PDF only when it prints. It proposes the title of the printed document, or of the page around it, as
  // the file name.
  async function print(address, name) {
    const svg = decodeURIComponent(address.slice(address.indexOf(",") + 1));
    const root = new DOMParser().parseFromString(svg, "image/svg+xml").documentElement;
    // A pixel of CSS is 1/96 inch.
    const [width, height] = ["width", "height"].map(function (side) { return +(Number(root.getAttribute(side)) * 25.4 / 96).toFixed(4) + "mm"; });

    // The frame of the figure before is removed only now: some browsers still read it after `print` has returned.
    document.querySelectorAll("iframe.sheet").forEach(function (old) { old.remove(); });
    const sheet = document.createElement("iframe");
    sheet.className = "sheet";
    sheet.title = name;
    sheet.tabIndex = -1;
    sheet.setAttribute("aria-hidden", "true");
    sheet.srcdoc = '<!DOCTYPE html><html lang="en"><meta charset="utf-8"><style>' +
      "@page { size: " + width + " " + height + "; margin: 0 } " +
      // Rounding of the lengths must not begin a second page.
      "html, body { margin: 0; height: 100%; overflow: hidden; background: #ffffff } svg { display: block } " +
      "* { print-color-adjust: exact; -webkit-print-color-adjust: exact }" +
      "</style>" + svg;
    const loaded = new Promise(function (done) { sheet.addEventListener("load", done, { once: true }); });
    document.body.append(sheet);
    await loaded;

    const view = sheet.contentWindow;
    view.addEventListener("afterprint", function () { document.title = title; });
    view.document.title = name;
    document.title = name;
    view.print();
  }
  // Adds the buttons that save a figure: one for each ending in `formats`, which gives a promise of the picture's
  // address, and one that prints the SVG. They stand above the figure, so that neither they nor plotly's buttons cover
  // the legend.
  function offer(place, formats) {
    const row = document.createElement("div"), id = place.closest("figure").id;
    row.className = "save";
    const add = function (ending, tip, act) {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = ending.toUpperCase();
      button.title = tip;
      button.addEventListener("click", async function () {
        button.disabled = true;
        try { await act(); } finally { button.disabled = false; }
      });
      row.append(button);
    };
    Object.keys(formats).forEach(function (ending) {
      add(ending, "Save this figure as " + ending.toUpperCase(), async function () { save(await formats[ending](), nameOf(id) + "." + ending); });
    });
    add("pdf", "Opens the print dialogue: choose \u201cSave as PDF\u201d as the printer. The PDF has one page of the size of this figure, with lines and texts.",
      async function () { await print(await formats.svg(), nameOf(id)); });
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
      show(place, figure.data, figure.layout);
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
  // Draws or updates a figure. A page's own script has to wait for `drawn` before.
  function show(place, data, layout) {
    if (!plots.includes(place)) {
      plots.push(place);
      offerPlot(place);
    }
    return layout.scene && !space.turns ? space.standStill(place, data, layout, config) : Plotly.react(place, data, layout, config);
  }
  return { unpack: unpack, excuse: excuse, drawn: drawn, show: show, offer: offer, fine: FINE };
}());
