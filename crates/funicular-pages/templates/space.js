// Views in space: what the script of the mode shapes and the saving of plotly's scenes share.
const space = (function () {
  "use strict";
  function path(context, points) {
    context.beginPath();
    points.forEach(function (p, k) { if (k) { context.lineTo(p[0], p[1]); } else { context.moveTo(p[0], p[1]); } });
  }
  function stroke(context, points, style, width) {
    path(context, points);
    context.strokeStyle = style;
    context.lineWidth = width;
    context.stroke();
  }
  // Round numbers between two values, and the number of their decimals.
  function ticks(low, high) {
    const rough = (high - low) / 5, power = Math.pow(10, Math.floor(Math.log10(rough)));
    const step = power * [1, 2, 5, 10].find(function (m) { return m * power >= rough; }), list = [];
    for (let i = Math.ceil(low / step - 1e-6); i * step <= high + 1e-6 * step; i++) { list.push(i * step); }
    return { list: list, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
  }
  // Floor with its grid, numbers along the front edges, heights along the left edge. The view gives the place of a point
  // on the page (`to`) and its distance towards the eye (`depth`).
  function scales(context, view, low, high) {
    const z = low[2], to = view.to, line = function (points, style) { stroke(context, points, style, 1); };
    path(context, [[low[0], low[1], z], [high[0], low[1], z], [high[0], high[1], z], [low[0], high[1], z]].map(to));
    context.closePath();
    context.fillStyle = "#f3f4f5";
    context.fill();
    const front = [0, 1].map(function (k) { const far = low.slice(); far[k] = high[k]; return view.depth(far) > view.depth(low) ? high[k] : low[k]; });
    const middle = to([0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), z]);
    const write = function (text, at, style, size, dx, dy) {
      context.fillStyle = style;
      context.font = size + "px system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif";
      context.fillText(text, at[0] + dx, at[1] + dy);
    };
    context.textAlign = "center";
    context.textBaseline = "middle";
    [0, 1].forEach(function (k) {
      const other = 1 - k, marks = ticks(low[k], high[k]);
      const point = function (value, at) { const p = [0, 0, z]; p[k] = value; p[other] = at; return to(p); };
      const edge = [point(low[k], front[other]), point(high[k], front[other])];
      // Direction normal to the edge, away from the floor.
      let away = [edge[0][1] - edge[1][1], edge[1][0] - edge[0][0]];
      const long = Math.hypot(away[0], away[1]) || 1, side = away[0] * (edge[0][0] - middle[0]) + away[1] * (edge[0][1] - middle[1]);
      away = away.map(function (part) { return (side < 0 ? -part : part) / long; });
      const spread = Math.hypot(edge[1][0] - edge[0][0], edge[1][1] - edge[0][1]);
      marks.list.forEach(function (value) {
        line([point(value, low[other]), point(value, high[other])], "#d9d9d9");
        if (spread > 60) { write(value.toFixed(marks.digits).replace("-", "−"), point(value, front[other]), "#565656", 10.5, 14 * away[0], 12 * away[1]); }
      });
      line(edge, "#8a8a8a");
      if (spread > 60) { write("xy"[k] + " [m]", point(0.5 * (low[k] + high[k]), front[other]), "#1b1b1b", 12, 38 * away[0], 29 * away[1]); }
    });
    const upright = [0, 1, 2, 3].map(function (mask) { return [mask & 1 ? high[0] : low[0], mask & 2 ? high[1] : low[1]]; })
      .reduce(function (best, p) { return to([p[0], p[1], z])[0] < to([best[0], best[1], z])[0] ? p : best; });
    const heights = ticks(low[2], high[2]), ends = [to([upright[0], upright[1], low[2]]), to([upright[0], upright[1], high[2]])];
    line(ends, "#8a8a8a");
    context.textAlign = "right";
    // A short axis, as that across a plane, has its name alone.
    if (Math.abs(ends[1][1] - ends[0][1]) > 50) {
      heights.list.forEach(function (value, i) {
        const at = to([upright[0], upright[1], value]);
        line([at, [at[0] - 4, at[1]]], "#8a8a8a");
        if (i > 0) { write(value.toFixed(heights.digits).replace("-", "−"), at, "#565656", 10.5, -7, 0); }
      });
    }
    write("z [m]", ends[1], "#1b1b1b", 12, 10, -11);
  }
  // Records what is drawn on it as on a canvas as elements of SVG, so that a saved figure has lines and texts.
  function recorder(width, height) {
    const elements = [];
    let path = "";
    const number = function (x) { return String(Math.round(100 * x) / 100); };
    const escaped = function (text) { return text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;"); };
    const at = function (x, y) { return number(x) + " " + number(y); };
    const lines = function (it) { return ' stroke="' + it.strokeStyle + '" stroke-width="' + number(it.lineWidth) + '" stroke-linejoin="round" stroke-linecap="round"'; };
    const write = function (it, text, x, y, style) {
      const anchor = it.textAlign === "right" ? "end" : it.textAlign === "center" ? "middle" : "start";
      // A browser's middle line of a text lies a third of its size above the base line.
      const size = parseFloat(/([0-9.]+)px/.exec(it.font)[1]), down = it.textBaseline === "middle" ? 0.35 * size : 0;
      elements.push('<text x="' + number(x) + '" y="' + number(y + down) + '" font-size="' + number(size) + '" text-anchor="' + anchor + '"' + style + ">" + escaped(text) + "</text>");
    };
    return {
      fillStyle: "#000000", strokeStyle: "#000000", lineWidth: 1, globalAlpha: 1, font: "12px sans-serif", textAlign: "start", textBaseline: "alphabetic",
      beginPath: function () { path = ""; },
      moveTo: function (x, y) { path += "M" + at(x, y); },
      lineTo: function (x, y) { path += "L" + at(x, y); },
      closePath: function () { path += "Z"; },
      // Only complete circles are drawn.
      arc: function (x, y, r) { path += "M" + at(x - r, y) + "a" + at(r, r) + " 0 1 0 " + at(2 * r, 0) + "a" + at(r, r) + " 0 1 0 " + at(-2 * r, 0) + "Z"; },
      fill: function () { elements.push('<path d="' + path + '" fill="' + this.fillStyle + '" fill-opacity="' + this.globalAlpha + '"/>'); },
      stroke: function () { elements.push('<path d="' + path + '" fill="none"' + lines(this) + "/>"); },
      fillRect: function (x, y, w, h) { elements.push('<rect x="' + number(x) + '" y="' + number(y) + '" width="' + number(w) + '" height="' + number(h) + '" fill="' + this.fillStyle + '"/>'); },
      fillText: function (text, x, y) { write(this, text, x, y, ' fill="' + this.fillStyle + '"'); },
      strokeText: function (text, x, y) { write(this, text, x, y, ' fill="none"' + lines(this)); },
      text: function () {
        return '<svg xmlns="http://www.w3.org/2000/svg" width="' + width + '" height="' + height + '" viewBox="0 0 ' + width + " " + height +
          '" font-family="Arial, Helvetica, sans-serif"><rect width="' + width + '" height="' + height + '" fill="#ffffff"/>' + elements.join("\n") + "</svg>";
      }
    };
  }
  function address(svg) { return "data:image/svg+xml;charset=utf-8," + encodeURIComponent(svg); }

  // View of a scene of plotly at this moment. Its camera has three matrices, column by column.
  function viewOf(scene, width, height) {
    const camera = scene.glplot.cameraParams, scale = scene.dataScale;
    const projected = function (p) {
      return [camera.model, camera.view, camera.projection].reduce(function (v, matrix) {
        return [0, 1, 2, 3].map(function (i) { return [0, 1, 2, 3].reduce(function (sum, j) { return sum + matrix[4 * j + i] * v[j]; }, 0); });
      }, [p[0] * scale[0], p[1] * scale[1], p[2] * scale[2], 1]);
    };
    return {
      to: function (p) { const v = projected(p); return [0.5 * width * (1 + v[0] / v[3]), 0.5 * height * (1 - v[1] / v[3])]; },
      depth: function (p) { const v = projected(p); return -v[2] / v[3]; }
    };
  }
  function channel(colour, k) { return parseInt(colour.slice(1 + 2 * k, 3 + 2 * k), 16); }
  // Colour on white paper with this opacity, which a line of the recorder does not have.
  function faded(colour, opacity) {
    const share = opacity === undefined ? 1 : opacity;
    return "rgb(" + [0, 1, 2].map(function (k) { return Math.round(255 + share * (channel(colour, k) - 255)); }).join(",") + ")";
  }
  // Colour of a number between the entries of a colour scale.
  function between(list, low, high, value) {
    const at = Math.min(1, Math.max(0, (value - low) / (high - low || 1)));
    const above = Math.max(1, list.findIndex(function (entry) { return entry[0] >= at; }));
    const [from, to] = [list[above - 1], list[above]], part = (at - from[0]) / (to[0] - from[0] || 1);
    return "rgb(" + [0, 1, 2].map(function (k) { return Math.round(channel(from[1], k) + part * (channel(to[1], k) - channel(from[1], k))); }).join(",") + ")";
  }
  // Corners of the symbols with straight edges, for a size of 2.
  const SYMBOLS = { square: [[-1, -1], [1, -1], [1, 1], [-1, 1]], diamond: [[-1.3, 0], [0, -1.3], [1.3, 0], [0, 1.3]] };
  // Plotly draws a symbol in space nearly twice as wide as its size says.
  function mark(context, at, symbol, size, colour) {
    const half = 0.92 * size, corners = SYMBOLS[symbol];
    if (symbol === "x") {
      stroke(context, [[at[0] - half, at[1] - half], [at[0] + half, at[1] + half]], colour, 0.3 * size);
      stroke(context, [[at[0] - half, at[1] + half], [at[0] + half, at[1] - half]], colour, 0.3 * size);
      return;
    }
    if (corners) {
      path(context, corners.map(function (corner) { return [at[0] + half * corner[0], at[1] + half * corner[1]]; }));
      context.closePath();
    } else {
      context.beginPath();
      context.arc(at[0], at[1], half, 0, 2 * Math.PI);
    }
    context.fillStyle = colour;
    context.fill();
  }
  function write(context, text, at, position, font) {
    const [upright, sideways] = position.split(" "), off = 0.9 * font.size;
    context.font = font.size + "px sans-serif";
    context.textAlign = sideways === "left" ? "right" : sideways === "right" ? "left" : "center";
    context.textBaseline = "middle";
    context.fillStyle = font.color || "#1b1b1b";
    context.strokeStyle = "#ffffff";
    context.lineWidth = 3;
    const x = at[0] + (sideways === "left" ? -off : sideways === "right" ? off : 0), y = at[1] + (upright === "top" ? -off : upright === "bottom" ? off : 0);
    context.strokeText(text, x, y);
    context.fillText(text, x, y);
  }
  // Parts of a trace with their distances towards the eye: lines, faces of a body, symbols. Texts are drawn over all.
  function parts(context, trace, view, texts) {
    const points = Array.from(trace.x, function (x, k) { return [x, trace.y[k], trace.z[k]]; }), at = points.map(view.to), found = [];
    const marker = trace.marker || {}, mode = trace.mode || "";
    if (trace.type === "mesh3d") {
      const depths = points.map(view.depth);
      trace.meta.faces.forEach(function (face) {
        const depth = face.reduce(function (sum, k) { return sum + depths[k]; }, 0) / face.length;
        found.push({ depth: depth, draw: function () {
          path(context, face.map(function (k) { return at[k]; }));
          context.closePath();
          context.globalAlpha = trace.opacity;
          context.fillStyle = trace.color;
          context.fill();
          context.globalAlpha = 1;
          context.strokeStyle = trace.color;
          context.lineWidth = 1;
          context.stroke();
        } });
      });
    }
    if (mode.includes("lines")) {
      // Plotly's line of a width of 4 covers about two pixels.
      found.push({ depth: view.depth(points[Math.floor(points.length / 2)]), draw: function () { stroke(context, at, trace.line.color, 0.5 * trace.line.width); } });
    }
    if (mode.includes("markers")) {
      points.forEach(function (point, k) {
        const colour = Array.isArray(marker.color) ? between(marker.colorscale, marker.cmin, marker.cmax, marker.color[k]) : faded(marker.color, marker.opacity);
        found.push({ depth: view.depth(point), draw: function () { mark(context, at[k], marker.symbol, marker.size, colour); } });
      });
    }
    if (mode.includes("text")) {
      const position = function (k) { return Array.isArray(trace.textposition) ? trace.textposition[k] : trace.textposition || "top center"; };
      trace.text.forEach(function (text, k) {
        if (text) { texts.push(function () { write(context, plain(text), at[k], position(k), trace.textfont); }); }
      });
    }
    return found;
  }
  // Text of a label of plotly, in which tags are escaped.
  function plain(text) { return text.replace(/&lt;/g, "<").replace(/&gt;/g, ">").replace(/&amp;/g, "&"); }

  // Draws the traces of a scene in a view. It knows those of the pages: lines, symbols, texts, and bodies with a list of
  // their faces.
  function paint(context, data, view, low, high) {
    const texts = [];
    scales(context, view, low, high);
    data
      .flatMap(function (trace) { return parts(context, trace, view, texts); })
      .sort(function (one, other) { return one.depth - other.depth; })
      .forEach(function (part) { part.draw(); });
    texts.forEach(function (draw) { draw(); });
  }
  // Draws a scene of plotly as it is turned at this moment.
  function paintTurned(context, place, width, height) {
    const layout = place._fullLayout.scene;
    const ranges = [layout.xaxis, layout.yaxis, layout.zaxis].map(function (axis) { return axis.range.map(Number); });
    const low = ranges.map(function (range) { return Math.min(range[0], range[1]); }), high = ranges.map(function (range) { return Math.max(range[0], range[1]); });
    paint(context, place.data, viewOf(layout._scene, width, height), low, high);
  }
  // Place of a scene inside its figure, in pixels.
  function boundsOf(place) {
    const full = place._fullLayout, inner = full._size, scene = full.scene || { domain: { x: [0, 1], y: [0, 1] } }, [x, y] = [scene.domain.x, scene.domain.y];
    return { x: inner.l + inner.w * x[0], y: inner.t + inner.h * (1 - y[1]), width: inner.w * (x[1] - x[0]), height: inner.h * (y[1] - y[0]) };
  }
  // Title, legend and colour bar of a figure. Its traces lie in a plane and have one point that is not drawn: plotly would
  // draw a scene once more as pixels, which takes seconds without a graphics card, and needs WebGL.
  function surroundings(data, layout) {
    const flat = data.map(function (trace) {
      const point = trace.x.length > 0 ? [null] : [];
      return Object.assign({}, trace, { type: "scatter", x: point, y: point });
    });
    const plane = Object.assign({}, layout, { xaxis: { visible: false, fixedrange: true }, yaxis: { visible: false, fixedrange: true } });
    delete plane.scene;
    return { data: flat, layout: plane };
  }
  // Address of a scene as SVG.
  async function svgOf(place) {
    const size = { format: "svg", width: place.clientWidth, height: place.clientHeight }, bounds = boundsOf(place), record = recorder(bounds.width, bounds.height);
    const flat = await Plotly.toImage(place.still || surroundings(place.data, place.layout), size);
    const tree = new DOMParser().parseFromString(decodeURIComponent(flat.slice(flat.indexOf(",") + 1)), "image/svg+xml");
    if (place.still) { paintStill(record, place.still, bounds.width, bounds.height); } else { paintTurned(record, place, bounds.width, bounds.height); }
    const drawn = tree.importNode(new DOMParser().parseFromString(record.text(), "image/svg+xml").documentElement, true);
    ["x", "y"].forEach(function (name) { drawn.setAttribute(name, bounds[name]); });
    // Under title, legend and colour bar.
    const over = tree.querySelector(".infolayer");
    if (over) { over.before(drawn); } else { tree.documentElement.append(drawn); }
    return address(new XMLSerializer().serializeToString(tree));
  }

  // True if the browser offers WebGL, with which plotly draws scenes that turn. Remote desktops and virtual machines often
  // do not.
  const turns = ["webgl2", "webgl"].some(function (kind) { return document.createElement("canvas").getContext(kind) !== null; });
  // Pixels around a scene that stands still, for the numbers along its edges.
  const EDGE = 44;
  // View from the eye that the layout names, with parallel projection, as large as fits.
  function stillView(layout, low, high, width, height) {
    const { x, y, z } = layout.camera.eye, level = Math.hypot(x, y), far = Math.hypot(level, z), ratio = layout.aspectratio;
    const axes = [[-y / level, x / level, 0], [-x * z / (level * far), -y * z / (level * far), level / far], [x / far, y / far, z / far]];
    const along = function (p, axis) {
      return ["x", "y", "z"].reduce(function (sum, name, k) { return sum + axis[k] * ratio[name] * ((p[k] - low[k]) / (high[k] - low[k] || 1) - 0.5); }, 0);
    };
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map(function (mask) { return [0, 1, 2].map(function (k) { return (mask >> k) & 1 ? high[k] : low[k]; }); });
    const reach = [0, 1].map(function (k) { return Math.max(...corners.map(function (p) { return Math.abs(along(p, axes[k])); })) || 1; });
    const scale = Math.min((0.5 * width - EDGE) / reach[0], (0.5 * height - EDGE) / reach[1]);
    return {
      to: function (p) { return [0.5 * width + scale * along(p, axes[0]), 0.5 * height - scale * along(p, axes[1])]; },
      depth: function (p) { return along(p, axes[2]); }
    };
  }
  // Draws a scene that does not turn.
  function paintStill(context, still, width, height) {
    const scene = still.scene;
    const ranges = ["x", "y", "z"].map(function (name) {
      const given = scene[name + "axis"].range, all = still.traces.flatMap(function (trace) { return Array.from(trace[name]); });
      return given || [Math.min(...all), Math.max(...all)];
    });
    const end = function (k) { return ranges.map(function (range) { return range[k]; }); };
    paint(context, still.traces, stillView(scene, end(0), end(1), width, height), end(0), end(1));
  }
  // Draws or updates a scene where there is no WebGL, with a line that says why it does not turn.
  async function standStill(place, data, layout, config) {
    const first = !place.still;
    place.still = Object.assign(surroundings(data, layout), { scene: layout.scene, traces: data });
    await Plotly.react(place, place.still.data, place.still.layout, config);
    const draw = function () {
      const bounds = boundsOf(place), record = recorder(bounds.width, bounds.height);
      paintStill(record, place.still, bounds.width, bounds.height);
      place.querySelectorAll(".still").forEach(function (old) { old.remove(); });
      const picture = document.createElement("div");
      picture.className = "still";
      picture.innerHTML = record.text();
      picture.style.cssText = "position: absolute; pointer-events: none; left: " + bounds.x + "px; top: " + bounds.y + "px";
      // Over plotly's white ground, under title, legend and colour bar.
      place.querySelector(".main-svg").after(picture);
    };
    draw();
    if (!first) { return; }
    place.on("plotly_afterplot", draw);
    const reason = document.createElement("p");
    reason.className = "without-webgl";
    reason.textContent = "This view stands still: turning it needs WebGL, which this browser does not offer.";
    place.after(reason);
  }
  return { path: path, stroke: stroke, scales: scales, recorder: recorder, address: address, svgOf: svgOf, turns: turns, standStill: standStill };
}());
