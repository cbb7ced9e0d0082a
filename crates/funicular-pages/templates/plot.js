(async function () {
  "use strict";
  const place = document.getElementById("slices");
  // Light to dark, as for the mode shapes of a report. Contour lines stay visible at the dark end.
  const COLOURS = ["#fdd56a", "#fdb52e", "#f89540", "#e97257", "#d5536f", "#b83289", "#8f0da4"];
  const SCALE = COLOURS.map(function (colour, i) { return [i / (COLOURS.length - 1), colour]; });
  const EMPTY = "#e4e4e4", INK = "#1b1b1b";
  let data, header, status, values;
  try {
    await page.drawn;
    if (typeof Plotly === "undefined") { throw new Error("the library for the figures did not start"); }
    data = await (await page.unpack("slices-data")).arrayBuffer();
    const length = new DataView(data).getUint32(0, true);
    header = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
    const cells = header.axes.reduce(function (product, axis) { return product * axis.values.length; }, 1);
    status = new Uint8Array(data, 4 + length, cells);
    // The values are copied because numbers of four bytes have to begin at a multiple of four.
    const numbers = new Float32Array(data.slice(4 + length + cells));
    values = header.quantities.map(function (_, q) { return numbers.subarray(q * cells, (q + 1) * cells); });
  } catch (error) {
    document.querySelectorAll(".slices .plot").forEach(function (plot) { page.excuse(plot, error); });
    return;
  }
  const axes = header.axes, strides = [];
  axes.reduce(function (stride, axis) { strides.push(stride); return stride * axis.values.length; }, 1);
  const at = axes.map(function (axis) { return Math.floor((axis.values.length - 1) / 2); });
  const control = function (name) { return place.querySelector("[data-do=" + name + "]"); };
  const plot = function (name) { return document.getElementById("figure-" + name + "-plot"); };
  const state = { quantity: 0, pair: header.pairs[0], log: false };
  const short = function (value) { return String(Number(value.toPrecision(4))).replace("-", "−"); };
  const plain = function (text) { return text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;"); };

  function axis(title, more) {
    return Object.assign({
      title: { text: plain(title), standoff: 8, font: { size: 13 } }, tickfont: { size: 12 }, showline: true, linecolor: "#444444", mirror: true,
      ticks: "outside", tickcolor: "#444444", showgrid: false, zeroline: false, exponentformat: "power", minexponent: 6,
    }, more);
  }
  function layout(more) {
    return Object.assign({
      font: { family: "system-ui, -apple-system, Segoe UI, Roboto, Helvetica Neue, Arial, sans-serif", size: 13, color: INK },
      paper_bgcolor: "#ffffff", plot_bgcolor: "#ffffff", margin: { l: 62, r: 14, t: 62, b: 52 }, autosize: true, hovermode: "closest",
      legend: { orientation: "h", x: 0, xanchor: "left", y: 1.01, yanchor: "bottom", font: { size: 12 } },
    }, more);
  }

  // Value for the colour: the number, or its logarithm on a logarithmic scale.
  function scaled(value) { return state.log ? Math.log10(value) : value; }
  function scale(least, greatest) {
    const quantity = header.quantities[state.quantity];
    const low = scaled(least), high = scaled(greatest), bar = { exponentformat: "power", minexponent: 6, title: { text: plain(quantity.title), side: "right", font: { size: 12 } }, thickness: 14, tickfont: { size: 11 }, outlinewidth: 0 };
    if (state.log) {
      const ticks = [];
      for (let decade = Math.floor(low); decade <= high; decade++) {
        (high - low > 2.5 ? [1] : [1, 2, 5]).forEach(function (digit) {
          const value = digit * Math.pow(10, decade);
          if (Math.log10(value) >= low && Math.log10(value) <= high) { ticks.push(value); }
        });
      }
      // A range within one decade may have too few of these ticks: use round numbers instead.
      if (ticks.length < 3 && greatest > least) {
        const round = nice({ low: least, high: greatest }, (greatest - least) / 5);
        ticks.length = 0;
        for (let value = round.start; value <= greatest; value += round.size) { ticks.push(value); }
      }
      bar.tickvals = ticks.map(Math.log10);
      bar.ticktext = ticks.map(short);
    }
    // If all numbers are equal, the number is in the middle of the colour bar.
    const room = high > low ? 0 : 0.05 * Math.abs(low) || 0.5;
    return { low: low - room, high: high + room, bar: bar };
  }

  function slice() {
    const [h, v] = state.pair;
    const base = at.reduce(function (sum, index, k) { return k === h || k === v ? sum : sum + index * strides[k]; }, 0);
    const z = [], raw = [], codes = [], crosses = { x: [], y: [] };
    axes[v].values.forEach(function (y, j) {
      const line = [], numbers = [], code = [];
      axes[h].values.forEach(function (x, i) {
        const cell = base + i * strides[h] + j * strides[v], value = values[state.quantity][cell];
        line.push(isNaN(value) ? null : scaled(value));
        numbers.push(isNaN(value) ? null : value);
        code.push(status[cell]);
        if (isNaN(value) && infeasible(status[cell]) && i % thin(h) === 0 && j % thin(v) === 0) { crosses.x.push(x); crosses.y.push(y); }
      });
      z.push(line);
      raw.push(numbers);
      codes.push(code);
    });
    return { h: h, v: v, z: z, raw: raw, codes: codes, crosses: crosses };
  }
  // Crosses and gaps are only useful if cells are many pixels wide: at most about fifty crosses per side are drawn.
  function thin(axis) { return Math.ceil(axes[axis].values.length / 50); }
  function known(code) { return header.statuses.find(function (one) { return one.code === code; }); }
  function infeasible(code) { const one = known(code); return one !== undefined && !one.feasible; }
  function reason(code) { const one = known(code); return one ? one.name : "missing in the file"; }

  // Equal scales for both axes if they are lengths of similar extent.
  function proportion(h, v) {
    const span = function (k) { const list = axes[k].values; return Math.abs(list[list.length - 1] - list[0]); };
    const same = axes[h].unit === "m" && axes[v].unit === "m" && header.space !== null;
    const ratio = span(h) / span(v);
    return same && ratio < 4 && ratio > 0.25 ? { scaleanchor: "x", constrain: "domain" } : {};
  }

  function drawSlice(found) {
    const x = axes[found.h].values, y = axes[found.v].values, name = header.quantities[state.quantity];
    const numbers = found.raw.flat().filter(function (value) { return value !== null; });
    const own = { min: Infinity, max: -Infinity };
    numbers.forEach(function (value) { own.min = Math.min(own.min, value); own.max = Math.max(own.max, value); });
    const span = control("whole").checked || numbers.length === 0 || own.min === own.max ? name : own;
    const range = scale(span.min, span.max);
    const text = found.z.map(function (line, j) {
      return line.map(function (value, i) { return value === null ? reason(found.codes[j][i]) : short(found.raw[j][i]); });
    });
    const lines = numbers.length === 0 ? range : scale(own.min, own.max), step = (lines.high - lines.low) / 12;
    const traces = [
      { type: "heatmap", x: x, y: y, z: found.z, text: text, colorscale: SCALE, zmin: range.low, zmax: range.high, colorbar: range.bar, hoverongaps: true,
        hovertemplate: plain(axes[found.h].name) + " %{x}, " + plain(axes[found.v].name) + " %{y}<br>%{text}<extra></extra>" },
    ];
    if (own.max > own.min && x.length > 1 && y.length > 1) {
      traces.push({ type: "contour", x: x, y: y, z: found.z, zmin: range.low, zmax: range.high, autocontour: false, showlegend: false, connectgaps: false, showscale: false, hoverinfo: "skip",
        contours: Object.assign(nice(lines, step), { coloring: "none", showlabels: !state.log, labelfont: { size: 10, color: INK } }), line: { color: "rgba(20,20,20,0.65)", width: 1 } });
    }
    const many = x.length * y.length > 1000;
    traces.push({ type: "scatter", mode: "markers", x: found.crosses.x, y: found.crosses.y, name: "infeasible", hoverinfo: "skip", showlegend: true,
      marker: { symbol: "x-thin", size: many ? 4 : 6, color: "#8a8a8a", line: { color: "#8a8a8a", width: 1 } } });
    page.show(plot("slice"), traces, layout({
      plot_bgcolor: EMPTY, title: { text: plain(name.title), font: { size: 14 }, x: 0.5, xanchor: "center", y: 0.985, yanchor: "top" },
      xaxis: axis(axes[found.h].title, { constrain: "domain", range: ends(x) }), yaxis: axis(axes[found.v].title, Object.assign({ range: ends(y) }, proportion(found.h, found.v))),
      showlegend: found.crosses.x.length > 0,
    }));
  }
  // About a dozen contours at round numbers.
  function nice(range, step) {
    const power = Math.pow(10, Math.floor(Math.log10(step))), part = step / power;
    const size = power * (part > 5 ? 10 : part > 2 ? 5 : part > 1 ? 2 : 1);
    return { start: Math.ceil(range.low / size) * size, end: range.high, size: size };
  }

  function drawSet(found) {
    const x = axes[found.h].values, y = axes[found.v].values, list = header.statuses, last = Math.max(list.length, 1);
    const z = found.codes.map(function (line) {
      return line.map(function (code) { const k = list.findIndex(function (one) { return one.code === code; }); return k < 0 ? null : k; });
    });
    const colours = [];
    list.forEach(function (one, k) { colours.push([k / last, one.colour], [(k + 1) / last, one.colour]); });
    const text = found.codes.map(function (line) { return line.map(reason); }), gap = thin(found.h) > 1 || thin(found.v) > 1 ? 0 : 0.5;
    const traces = [{ type: "heatmap", x: x, y: y, z: z, text: text, colorscale: colours, zmin: -0.5, zmax: last - 0.5, showscale: false, xgap: gap, ygap: gap,
      hovertemplate: plain(axes[found.h].name) + " %{x}, " + plain(axes[found.v].name) + " %{y}<br>%{text}<extra></extra>" }];
    list.forEach(function (one) {
      traces.push({ type: "scatter", mode: "markers", x: [null], y: [null], name: one.name + " (" + one.rows + ")", hoverinfo: "skip", marker: { symbol: "square", size: 11, color: one.colour, line: { color: "#8a8a8a", width: 0.5 } } });
    });
    page.show(plot("set"), traces, layout({
      plot_bgcolor: EMPTY, showlegend: true, xaxis: axis(axes[found.h].title, { constrain: "domain", range: ends(x) }), yaxis: axis(axes[found.v].title, Object.assign({ range: ends(y) }, proportion(found.h, found.v))),
    }));
  }
  // Range of an axis up to the outer edges of the cells.
  function ends(list) {
    const n = list.length;
    return [list[0] - 0.5 * (list[1] - list[0]), list[n - 1] + 0.5 * (list[n - 1] - list[n - 2])];
  }

  function drawHistogram() {
    const quantity = header.quantities[state.quantity], n = quantity.bins.length, width = (quantity.max - quantity.min) / n;
    // Equal values of all rows give a single bar, with space on both sides.
    const single = !(width > 0), room = Math.abs(quantity.min) || 1, none = quantity.count === 0;
    const middle = single ? [quantity.min] : quantity.bins.map(function (_, k) { return quantity.min + (k + 0.5) * width; });
    const bars = single ? [quantity.count] : quantity.bins;
    const nothing = { text: "no row has a value", showarrow: false, xref: "paper", yref: "paper", x: 0.5, y: 0.5, font: { size: 14 } };
    page.show(plot("histogram"), none ? [] : [{ type: "bar", x: middle, y: bars, width: single ? 0.02 * room : width, marker: { color: "#0072b2", line: { color: "#ffffff", width: 0.6 } }, hovertemplate: "about %{x:.4g}<br>%{y} rows<extra></extra>" }],
      layout({ xaxis: axis(quantity.title, none ? { showticklabels: false, ticks: "" } : single ? { range: [quantity.min - room / 4, quantity.min + room / 4] } : {}), yaxis: axis("rows", none ? { showticklabels: false, ticks: "" } : { rangemode: "tozero" }),
        annotations: none ? [nothing] : [], bargap: 0, showlegend: false, margin: { l: 62, r: 14, t: 34, b: 52 } }));
    place.querySelector("[data-count]").textContent = quantity.count + (quantity.count === 1 ? " row has a value." : " rows have a value.");
  }

  function drawSpace() {
    const target = plot("space");
    if (!target) { return; }
    const [X, Y, Z] = header.space, good = { x: [], y: [], z: [], c: [], t: [] }, bad = { x: [], y: [], z: [], t: [] };
    const base = at.reduce(function (sum, index, k) { return header.space.includes(k) ? sum : sum + index * strides[k]; }, 0);
    axes[Z].values.forEach(function (z, k) {
      axes[Y].values.forEach(function (y, j) {
        axes[X].values.forEach(function (x, i) {
          const cell = base + i * strides[X] + j * strides[Y] + k * strides[Z], value = values[state.quantity][cell];
          const into = isNaN(value) ? bad : good;
          if (isNaN(value) && !infeasible(status[cell])) { return; }
          into.x.push(x); into.y.push(y); into.z.push(z);
          into.t.push(isNaN(value) ? reason(status[cell]) : short(value));
          if (!isNaN(value)) { good.c.push(scaled(value)); }
        });
      });
    });
    const quantity = header.quantities[state.quantity], range = scale(quantity.min, quantity.max);
    const trace = function (from, name, marker) {
      return { type: "scatter3d", mode: "markers", name: name, x: from.x, y: from.y, z: from.z, text: from.t, marker: marker, hovertemplate: "(%{x}, %{y}, %{z}) m<br>%{text}<extra></extra>" };
    };
    const size = Math.max(1.6, Math.min(5, 60 / Math.cbrt(good.x.length + bad.x.length)));
    const side = function (k) { const list = axes[k].values; return Math.abs(list[list.length - 1] - list[0]); };
    const most = Math.max(side(X), side(Y), side(Z));
    const ratio = function (k) { return side(k) / most * 1.6; };
    const deep = function (k) { return { title: { text: plain(axes[k].title), font: { size: 12 } }, tickfont: { size: 10 }, nticks: 6, showbackground: false, gridcolor: "#d9d9d9", zeroline: false, showspikes: false }; };
    page.show(target, [
      trace(good, "feasible", { size: size, color: good.c, colorscale: SCALE, cmin: range.low, cmax: range.high, colorbar: range.bar, line: { width: 0 } }),
      trace(bad, "infeasible", { size: 0.6 * size, color: "#9a9a9a", symbol: "x", opacity: 0.35, line: { width: 0 } }),
    ], layout({ margin: { l: 0, r: 0, t: 28, b: 0 }, showlegend: bad.x.length > 0, uirevision: "space", legend: { orientation: "h", x: 0, xanchor: "left", y: 1.01, yanchor: "bottom", font: { size: 12 }, itemsizing: "constant" },
      scene: { aspectmode: "manual", aspectratio: { x: ratio(X), y: ratio(Y), z: ratio(Z) }, xaxis: deep(X), yaxis: deep(Y), zaxis: deep(Z),
        camera: { eye: { x: 0.85, y: -1.6, z: 0.75 }, projection: { type: "orthographic" } }, uirevision: "space" } }));
  }

  function draw() {
    const quantity = header.quantities[state.quantity], log = control("log");
    log.disabled = !(quantity.min > 0);
    state.log = log.checked && !log.disabled;
    const found = slice();
    place.querySelectorAll("[data-axis]").forEach(function (label) {
      const k = Number(label.dataset.axis), list = axes[k].values, input = label.querySelector("input");
      label.hidden = k === found.h || k === found.v;
      input.max = list.length - 1;
      input.value = at[k];
      label.querySelector("output").textContent = short(list[at[k]]);
    });
    const others = axes.map(function (one, k) { return k === found.h || k === found.v ? "" : one.name + " = " + short(one.values[at[k]]) + (one.unit === "deg" ? "°" : one.unit === "1" ? "" : " " + one.unit); }).filter(Boolean);
    place.querySelector("[data-where]").textContent = others.length ? "In this slice " + others.join(", ") + "." : "";
    drawSlice(found);
    drawSet(found);
    drawHistogram();
    drawSpace();
  }
  // If numbers span decades, linear colours show little: start with a logarithmic scale.
  function begin() {
    const quantity = header.quantities[state.quantity];
    control("log").checked = quantity.min > 0 && quantity.max > 30 * quantity.min;
  }
  header.statuses.forEach(function (one) { one.feasible = header.feasible.includes(one.name); });
  control("quantity").addEventListener("change", function (event) { state.quantity = Number(event.target.value); begin(); draw(); });
  control("log").addEventListener("change", draw);
  control("whole").addEventListener("change", draw);
  if (control("plane")) {
    control("plane").addEventListener("change", function (event) { state.pair = header.pairs[Number(event.target.value)]; draw(); });
  }
  place.querySelectorAll("[data-axis]").forEach(function (label) {
    label.querySelector("input").addEventListener("input", function (event) { at[Number(label.dataset.axis)] = Number(event.target.value); draw(); });
  });
  // In an incomplete file the middle of the grid may be missing: start at the middle of the existing rows.
  if (slice().raw.flat().every(function (value) { return value === null; })) {
    const there = [];
    values[0].forEach(function (value, cell) { if (!isNaN(value)) { there.push(cell); } });
    const cell = there[Math.floor(there.length / 2)] || 0;
    axes.forEach(function (one, k) { at[k] = Math.floor(cell / strides[k]) % one.values.length; });
  }
  begin();
  draw();
}());
