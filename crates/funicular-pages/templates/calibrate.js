// Fits a calibration again without the rows that are clicked away; refit.js, which stands before this script, computes.
function start() {
  const data = JSON.parse(document.getElementById("refit-data").textContent);
  const linear = data.linear, choice = document.getElementById("row-choice"), place = document.getElementById("refitted");
  if (!linear) {
    document.getElementById("left-out").textContent = "These rows do not determine all values: none of them can be left out.";
    return;
  }
  const isLeftOut = linear.rows.map(function () { return false; });
  const originals = Array.from(document.querySelectorAll('script[data-plot^="figure-anchors"]')).map(function (source) {
    return { place: document.getElementById(source.dataset.plot), figure: JSON.parse(source.textContent) };
  });

  function table(found) {
    const rows = refittedValues(data, found).map(function (of) {
      return [of.path, of.unit, rounded(of.value, 6), rounded(of.moved, 3), rounded(of.deviation, 3)];
    });
    const element = document.createElement("table");
    [["value", "unit", "without these rows", "moves by", "±"]].concat(rows).forEach(function (cells, number) {
      const row = element.insertRow();
      cells.forEach(function (cell) {
        const part = document.createElement(number === 0 ? "th" : "td");
        part.textContent = cell;
        row.append(part);
      });
    });
    return element;
  }

  // Moved anchors with their ellipses in all views.
  function draw(found) {
    const anchors = found && refittedAnchors(data, found);
    originals.forEach(function (original) {
      const figure = structuredClone(original.figure), axes = figure.layout.meta.axes, scale = figure.layout.meta.scale;
      figure.data.forEach(function (trace) {
        if (trace.name === "rows") {
          const color = trace.marker.color;
          trace.marker.color = isLeftOut.map(function (away) { return away ? "#bbbbbb" : color; });
        }
        if (trace.name === "weakest combination") { trace.visible = isLeftOut.some(Boolean) ? "legendonly" : true; }
        if (!anchors) { return; }
        if (trace.name === "calibrated") {
          ["x", "y"].forEach(function (name, k) { trace[name] = anchors.map(function (anchor) { return anchor.position[axes[k]]; }); });
        }
        if (trace.meta && found.factor !== null) {
          const anchor = anchors[trace.meta.anchor], spread = spreadOf(anchor.covariance, axes);
          const turns = trace.x.map(function (_, k) { return 2 * Math.PI * k / (trace.x.length - 1); });
          ["x", "y"].forEach(function (name, k) {
            trace[name] = turns.map(function (turn) {
              return anchor.position[axes[k]] + 2 * scale * (spread[k][0] * Math.cos(turn) + spread[k][1] * Math.sin(turn));
            });
          });
        }
      });
      page.show(original.place, figure.data, figure.layout);
    });
  }

  async function update() {
    const found = refit(linear, isLeftOut);
    const sentence = document.createElement("p");
    sentence.textContent = refitSentence(found, isLeftOut.filter(Boolean).length);
    place.replaceChildren(sentence, table(found));
    await page.drawn;
    draw(found);
  }

  data.rows.forEach(function (number, j) {
    const label = document.createElement("label"), box = document.createElement("input");
    box.type = "checkbox";
    box.checked = true;
    box.addEventListener("change", function () { isLeftOut[j] = !box.checked; update(); });
    label.append(box, " row " + number + " ");
    choice.append(label);
  });
  update();
}
start();
