(function () {
  "use strict";
  const PERIOD_MS = 1600;
  // Initial amplitude: largest displacement relative to the diagonal of the scene (REACH). It is reduced if waves would
  // be steeper than SLOPE, or if the platform would rotate by more than TURN [rad], where linear rotation visibly
  // distorts it.
  const REACH = 0.06, SLOPE = 0.9, TURN = 0.3;
  // Part of matplotlib's colour map plasma, gold to blue: uniform in lightness, distinguishable with any colour vision.
  const COLOURS = ["#fdc527", "#fca636", "#f2844b", "#e16462", "#cc4778", "#b12a90", "#8f0da4", "#6a00a8", "#41049d", "#0d0887"];
  const place = document.getElementById("shapes");
  const canvas = place.querySelector("canvas");
  // Where the view is drawn: the canvas, or a recorder of SVG while the figure is saved.
  let context = canvas.getContext("2d");
  const slider = place.querySelector("input[type=range]");
  const button = function (name) { return place.querySelector("[data-do=" + name + "]"); };
  const still = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
  let robot, steps, offsets;
  let chosen = 0, motion = null, playing = !still, seen = true, phase = 0, last = null, waiting = false;
  let turn, tilt, zoom, close = false;

  function mixed(share) {
    const at = Math.min(1, Math.max(0, share)) * (COLOURS.length - 1), k = Math.min(COLOURS.length - 2, Math.floor(at));
    const part = function (text, i) { return parseInt(text.slice(1 + 2 * i, 3 + 2 * i), 16); };
    return [0, 1, 2].map(function (i) { return part(COLOURS[k], i) + (at - k) * (part(COLOURS[k + 1], i) - part(COLOURS[k], i)); });
  }
  function colour(share, light) {
    return "rgb(" + mixed(share).map(function (c) { return Math.round(c + (light || 0) * (255 - c)); }).join(",") + ")";
  }
  function plus(p, u, a) { return [p[0] + a * u[0], p[1] + a * u[1], p[2] + a * u[2]]; }
  function size(v) { return Math.hypot(v[0], v[1], v[2]); }
  // Number with three significant digits, never as a power of ten.
  function short(x) { return x >= 100 ? x.toFixed(0) : x > 0 ? x.toFixed(Math.max(0, 2 - Math.floor(Math.log10(x)))) : "0"; }
  function percent(share) { return (100 * share).toFixed(1) + " %"; }

  // Cubic interpolation between equally spaced numbers, with slopes from the neighbours.
  function cubic(values, count) {
    const n = values.length - 1, ratio = count / n, all = [];
    const at = function (k) {
      if (k < 0) { return 3 * values[0] - 3 * values[1] + values[2]; }
      return k > n ? 3 * values[n] - 3 * values[n - 1] + values[n - 2] : values[k];
    };
    for (let d = 0; d <= count; d++) {
      const k = Math.min(n - 1, Math.floor(d / ratio)), t = d / ratio - k;
      const a = at(k - 1), b = at(k), c = at(k + 1), e = at(k + 2);
      all.push(b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - e + t * (3 * (b - c) + e - a))));
    }
    return all;
  }
  // Displacements of all drawn points in world axes. The page holds second differences along each cable.
  function expanded(number) {
    const mode = robot.modes[number], n = mode.intervals;
    let largest = 0, steepest = 0, where = "", read = offsets[number];
    const note = function (u, name) { if (size(u) > largest) { largest = size(u); where = name; } };
    const cables = robot.cables.map(function (cable) {
      const parts = cable.axes.map(function () {
        const values = [];
        let slope = 0, value = 0;
        for (let k = 0; k <= n; k++) {
          slope += steps.getInt16(read, true);
          value += slope;
          values.push(mode.scale * value);
          read += 2;
        }
        return cubic(values, robot.drawn);
      });
      const moved = [];
      for (let d = 0; d <= robot.drawn; d++) {
        const u = cable.axes.reduce(function (sum, axis, k) { return plus(sum, axis, parts[k][d]); }, [0, 0, 0]);
        note(u, "on cable " + cable.name);
        if (d > 0) { steepest = Math.max(steepest, size(plus(u, moved[d - 1], -1)) / size(plus(cable.points[d], cable.points[d - 1], -1))); }
        moved.push(u);
      }
      return moved;
    });
    const s = mode.shape, origin = robot.platform.origin;
    const rigid = function (p) {
      const r = plus(p, origin, -1);
      const u = [s[0] + s[4] * r[2] - s[5] * r[1], s[1] + s[5] * r[0] - s[3] * r[2], s[2] + s[3] * r[1] - s[4] * r[0]];
      note(u, "on the platform");
      return u;
    };
    const corners = robot.platform.corners.map(rigid), centre = rigid(robot.platform.mass_centre);
    const angle = size(s.slice(3)), diagonal = size(plus(robot.high, robot.low, -1));
    const limit = function (most, of) { return of > 0 ? most / of : Infinity; };
    const start = largest > 0 ? Math.min(REACH * diagonal / largest, limit(SLOPE, steepest), limit(TURN, angle)) : 0;
    return { cables: cables, corners: corners, centre: centre, largest: largest, where: where, start: start };
  }
  function amplitude() { return motion.start * Math.pow(10, Number(slider.value)); }

  // Parallel projection onto the middle of the scene.
  function camera() {
    const a = turn, b = tilt;
    const towards = [Math.cos(b) * Math.cos(a), Math.cos(b) * Math.sin(a), Math.sin(b)];
    const right = [-Math.sin(a), Math.cos(a), 0];
    const up = [-Math.sin(b) * Math.cos(a), -Math.sin(b) * Math.sin(a), Math.cos(b)];
    return { towards: towards, right: right, up: up };
  }
  function dot(p, q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }
  function box(mask) { return [0, 1, 2].map(function (k) { return mask >> k & 1 ? robot.high[k] : robot.low[k]; }); }
  function projection() {
    const width = canvas.clientWidth, height = canvas.clientHeight, eye = camera();
    const whole = plus(robot.low, plus(robot.high, robot.low, -1), 0.5), middle = close ? robot.platform.mass_centre : whole;
    // The scale does not change while the scene rotates. It fits the scene in the initial direction, with room for
    // numbers.
    const first = { turn: turn, tilt: tilt };
    facing();
    const start = camera();
    turn = first.turn; tilt = first.tilt;
    let across = 0, upright = 0;
    for (let mask = 0; mask < 8; mask++) {
      const p = plus(box(mask), whole, -1);
      across = Math.max(across, Math.abs(dot(p, start.right)));
      upright = Math.max(upright, Math.abs(dot(p, start.up)));
    }
    const fit = Math.min((width / 2 - 46) / across, (height / 2 - 34) / upright);
    const scale = zoom * (close ? Math.max(fit, 0.2 * Math.min(width, height) / robot.platform.reach) : fit);
    return {
      eye: eye, scale: scale,
      to: function (p) {
        const r = plus(p, middle, -1);
        return [width / 2 + scale * dot(r, eye.right), height / 2 - 8 - scale * dot(r, eye.up)];
      },
      depth: function (p) { return dot(p, eye.towards); }
    };
  }
  function facing() {
    const e = robot.eye;
    turn = Math.atan2(e[1], e[0]);
    tilt = Math.atan2(e[2], Math.hypot(e[0], e[1]));
  }
  function reset() { facing(); zoom = 1; show(); }
  function approach(on) {
    close = on;
    zoom = 1;
    if (button("near")) { button("near").setAttribute("aria-pressed", String(on)); }
    show();
  }

  function path(points) { space.path(context, points); }
  function stroke(points, style, width) { space.stroke(context, points, style, width); }
  function body(view, corners, centre, share) {
    const at = corners.map(view.to), sun = [0.35, -0.5, 0.8];
    robot.platform.faces
      .map(function (face) { return { face: face, depth: face.reduce(function (sum, i) { return sum + view.depth(corners[i]); }, 0) / face.length }; })
      .sort(function (a, b) { return a.depth - b.depth; })
      .forEach(function (one) {
        const face = one.face, p = corners[face[0]], u = plus(corners[face[1 % face.length]], p, -1), v = plus(corners[face[face.length - 1]], p, -1);
        const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]], long = size(normal) * size(sun);
        path(face.map(function (i) { return at[i]; }));
        context.closePath();
        context.globalAlpha = 0.9;
        context.fillStyle = colour(share, long > 0 ? 0.3 * (1 - Math.abs(dot(normal, sun)) / long) + 0.08 : 0);
        context.fill();
        context.globalAlpha = 1;
        context.strokeStyle = "#1b1b1b";
        context.lineWidth = 1;
        context.stroke();
      });
    const c = view.to(centre);
    context.beginPath();
    context.arc(c[0], c[1], robot.platform.faces.length ? 2.5 : 7, 0, 2 * Math.PI);
    context.fillStyle = robot.platform.faces.length ? "#1b1b1b" : colour(share);
    context.fill();
    context.strokeStyle = robot.platform.faces.length ? "#ffffff" : "#1b1b1b";
    context.lineWidth = 1;
    context.stroke();
  }
  function draw() {
    const ratio = document.body.classList.contains("printing") ? 4 : window.devicePixelRatio || 1;
    const width = canvas.clientWidth, height = canvas.clientHeight;
    if (!width || !height) { return; }
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    paint();
  }
  function paint() {
    context.lineJoin = context.lineCap = "round";
    const view = projection(), mode = robot.modes[chosen], a = amplitude() * Math.cos(2 * Math.PI * phase);
    space.scales(context, view, robot.low, robot.high);
    robot.cables.forEach(function (cable) { stroke(cable.points.map(view.to), "#b3b8bd", 1); });
    robot.platform.faces.forEach(function (face) {
      path(face.map(function (i) { return view.to(robot.platform.corners[i]); }));
      context.closePath();
      context.strokeStyle = "#b3b8bd";
      context.stroke();
    });
    const corners = robot.platform.corners.map(function (p, i) { return plus(p, motion.corners[i], a); });
    const centre = plus(robot.platform.mass_centre, motion.centre, a);
    const things = robot.cables.map(function (cable, i) {
      const points = cable.points.map(function (p, k) { return plus(p, motion.cables[i][k], a); });
      return {
        depth: view.depth(points[Math.floor(points.length / 2)]),
        draw: function () {
          const line = points.map(view.to), thick = 1.6 + 1.8 * Math.sqrt(mode.cables[i]);
          stroke(line, "rgba(255,255,255,.85)", thick + 2);
          stroke(line, colour(mode.cables[i]), thick);
        }
      };
    });
    // A point mass is drawn last, on top of its cables' ends.
    things.push({ depth: robot.platform.faces.length ? view.depth(centre) : Infinity, draw: function () { body(view, corners, centre, mode.platform); } });
    things.sort(function (one, other) { return one.depth - other.depth; }).forEach(function (thing) { thing.draw(); });
    anchors(view);
  }
  function anchors(view) {
    const sides = { "top center": [0, -10], "bottom center": [0, 11], "middle left": [-8, 0], "middle right": [8, 0] };
    context.font = "12px system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif";
    robot.cables.forEach(function (cable) {
      const at = view.to(cable.points[cable.points.length - 1]), by = sides[cable.place];
      context.fillStyle = "#1b1b1b";
      context.fillRect(at[0] - 2.5, at[1] - 2.5, 5, 5);
      context.textAlign = by[0] < 0 ? "right" : by[0] > 0 ? "left" : "center";
      context.textBaseline = "middle";
      context.lineWidth = 3;
      context.strokeStyle = "rgba(255,255,255,.9)";
      context.strokeText(cable.label, at[0] + by[0], at[1] + by[1]);
      context.fillText(cable.label, at[0] + by[0], at[1] + by[1]);
    });
  }

  // Address of the view at this moment as a picture.
  function asSvg() {
    const screen = context, record = space.recorder(canvas.clientWidth, canvas.clientHeight);
    context = record;
    try { paint(); } finally { context = screen; }
    return space.address(record.text());
  }
  function asPng() {
    const screen = context, picture = document.createElement("canvas");
    picture.width = page.fine * canvas.clientWidth;
    picture.height = page.fine * canvas.clientHeight;
    context = picture.getContext("2d");
    context.scale(page.fine, page.fine);
    context.fillStyle = "#ffffff";
    context.fillRect(0, 0, canvas.clientWidth, canvas.clientHeight);
    try { paint(); } finally { context = screen; }
    return picture.toDataURL("image/png");
  }

  function show() { if (motion) { draw(); } }
  function tick(now) {
    waiting = false;
    if (!playing || !seen) { last = null; return; }
    if (last !== null) { phase = (phase + (now - last) / PERIOD_MS) % 1; }
    last = now;
    draw();
    run();
  }
  function run() {
    if (playing && seen && !waiting) { waiting = true; requestAnimationFrame(tick); }
  }
  function play(on) {
    playing = on;
    button("play").textContent = on ? "Pause" : "Play";
    last = null;
    run();
  }

  function fact(name, text) { place.querySelector("[data-fact=" + name + "]").textContent = text; }
  function drawn() {
    const a = amplitude(), mode = robot.modes[chosen], rests = !mode.shape.some(function (s) { return s !== 0; });
    fact("drawn", short(a) + (rests ? " × the shape with a modal mass of 1 kg; " : " × the shape in the table; ") + "at most " + short(a * motion.largest) + "\u00a0m, " + motion.where);
  }
  function shares(mode) {
    const names = ["platform"].concat(
      robot.cables.map(function (cable) { return "cable " + cable.name; }),
      robot.cables.map(function (cable) { return "drive of " + cable.name; }));
    place.querySelector(".shares tbody").replaceChildren(...[mode.platform].concat(mode.cables, mode.drives).map(function (share, i) {
      const row = document.createElement("tr"), head = document.createElement("th"), bar = document.createElement("td"), number = document.createElement("td"), fill = document.createElement("i");
      head.scope = "row";
      head.textContent = names[i];
      fill.style.width = (100 * share).toFixed(2) + "%";
      fill.style.background = colour(share);
      bar.append(fill);
      number.textContent = percent(share);
      row.append(head, bar, number);
      return row;
    }));
  }
  const rows = Array.from(document.querySelectorAll("#table-modes tbody tr"));
  function choose(number) {
    chosen = Math.min(robot.modes.length - 1, Math.max(0, number));
    motion = expanded(chosen);
    phase = 0;
    last = null;
    const mode = robot.modes[chosen];
    place.querySelector(".which").textContent = "Mode " + (chosen + 1) + " of " + robot.total + ": " + mode.hz + "\u00a0Hz";
    fact("damping", mode.damping + " %");
    fact("kind", mode.kind + (mode.multiplicity > 1 ? ", multiplicity " + mode.multiplicity : ""));
    fact("mass", mode.mass + " kg");
    drawn();
    shares(mode);
    button("previous").disabled = chosen === 0;
    button("next").disabled = chosen === robot.modes.length - 1;
    rows.forEach(function (row, i) {
      if (i === chosen) { row.setAttribute("aria-current", "true"); } else { row.removeAttribute("aria-current"); }
    });
    reveal(rows[chosen]);
    show();
    run();
  }
  // Scrolls only the table, not the page.
  function reveal(row) {
    const frame = row && row.closest(".table.tall");
    if (!frame) { return; }
    const head = frame.querySelector("thead").offsetHeight, top = row.offsetTop - head;
    if (top < frame.scrollTop) { frame.scrollTop = top; }
    const below = row.offsetTop + row.offsetHeight - frame.clientHeight;
    if (below > frame.scrollTop) { frame.scrollTop = below; }
  }
  function chosenByRow(number) {
    choose(number);
    const at = canvas.getBoundingClientRect();
    const visible = Math.min(at.bottom, window.innerHeight) - Math.max(at.top, 0);
    if (visible < 0.5 * at.height) { place.scrollIntoView({ block: "nearest", behavior: still ? "auto" : "smooth" }); }
  }
  function makeRowsButtons() {
    rows.slice(0, robot.modes.length).forEach(function (row, i) {
      const pick = document.createElement("button"), cell = row.cells[0];
      pick.type = "button";
      pick.textContent = cell.textContent;
      pick.setAttribute("aria-label", "Show the shape of mode " + (i + 1));
      cell.replaceChildren(pick);
      row.classList.add("pick");
      row.addEventListener("click", function () {
        if (String(window.getSelection()) === "") { chosenByRow(i); }
      });
    });
  }

  function listen() {
    const pointers = new Map();
    let gap = 0;
    const apart = function () { const p = Array.from(pointers.values()); return Math.hypot(p[0][0] - p[1][0], p[0][1] - p[1][1]); };
    canvas.addEventListener("pointerdown", function (event) {
      canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, [event.clientX, event.clientY]);
      if (pointers.size === 2) { gap = apart(); }
    });
    canvas.addEventListener("pointermove", function (event) {
      const from = pointers.get(event.pointerId);
      if (!from) { return; }
      pointers.set(event.pointerId, [event.clientX, event.clientY]);
      if (pointers.size === 1) {
        rotate(-(event.clientX - from[0]) / 150, (event.clientY - from[1]) / 150);
      } else if (pointers.size === 2) {
        nearer(apart() / Math.max(1, gap));
        gap = apart();
      }
    });
    ["pointerup", "pointercancel"].forEach(function (name) {
      canvas.addEventListener(name, function (event) { pointers.delete(event.pointerId); });
    });
    canvas.addEventListener("wheel", function (event) {
      event.preventDefault();
      nearer(Math.exp(-Math.max(-60, Math.min(60, event.deltaY)) / 400));
    }, { passive: false });
    canvas.addEventListener("dblclick", reset);
    slider.addEventListener("input", function () { drawn(); show(); });
    button("previous").addEventListener("click", function () { choose(chosen - 1); });
    button("next").addEventListener("click", function () { choose(chosen + 1); });
    button("play").addEventListener("click", function () { play(!playing); });
    button("reset").addEventListener("click", function () { slider.value = 0; drawn(); approach(false); reset(); });
    if (button("near")) { button("near").addEventListener("click", function () { approach(!close); }); }
    place.addEventListener("keydown", key);
    window.addEventListener("hashchange", asked);
    // For printing the view shows the largest motion in high resolution. This runs after the page has got its printed
    // width.
    window.addEventListener("beforeprint", function () { phase = 0; show(); });
    window.addEventListener("afterprint", show);
    new ResizeObserver(show).observe(canvas);
    new IntersectionObserver(function (entries) {
      seen = entries[entries.length - 1].isIntersecting;
      last = null;
      run();
    }).observe(canvas);
  }
  function rotate(a, b) {
    turn += a;
    tilt = Math.max(-1.5, Math.min(1.5, tilt + b));
    show();
  }
  function nearer(factor) { zoom = Math.max(0.3, Math.min(60, zoom * factor)); show(); }
  function key(event) {
    if (event.target === slider || event.ctrlKey || event.metaKey || event.altKey) { return; }
    const turns = { ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
    if (event.shiftKey && turns[event.key]) {
      rotate(turns[event.key][0], turns[event.key][1]);
    } else if (event.key === "ArrowLeft") {
      choose(chosen - 1);
    } else if (event.key === "ArrowRight") {
      choose(chosen + 1);
    } else if (event.key === "+" || event.key === "-") {
      nearer(event.key === "+" ? 1.15 : 1 / 1.15);
    } else if (event.key === " " && event.target === canvas) {
      play(!playing);
    } else {
      return;
    }
    event.preventDefault();
  }
  // Opens the mode of a link such as report.html#mode-12.
  function asked() {
    const found = /^#mode-(\d+)$/.exec(window.location.hash);
    if (found) { choose(Number(found[1]) - 1); place.scrollIntoView({ block: "center" }); }
    return Boolean(found);
  }

  async function begin() {
    try {
      const bytes = await (await page.unpack("shapes-data")).arrayBuffer();
      const length = new DataView(bytes).getUint32(0, true);
      robot = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
      steps = new DataView(bytes, 4 + length);
    } catch (error) {
      page.excuse(place, error);
      return;
    }
    offsets = [];
    robot.modes.reduce(function (at, mode) {
      offsets.push(at);
      return at + 2 * 3 * robot.cables.length * (mode.intervals + 1);
    }, 0);
    robot.cables.forEach(function (cable) {
      const parts = [0, 1, 2].map(function (axis) {
        return cubic(cable.rest.filter(function (_, k) { return k % 3 === axis; }), robot.drawn);
      });
      cable.points = parts[0].map(function (x, k) { return [x, parts[1][k], parts[2][k]]; });
    });
    place.querySelector(".scale i").style.background = "linear-gradient(to right," + COLOURS.join(",") + ")";
    const centre = robot.platform.mass_centre;
    robot.platform.reach = robot.platform.corners.reduce(function (most, p) { return Math.max(most, size(plus(p, centre, -1))); }, 0);
    if (robot.platform.reach === 0) { button("near").remove(); }
    facing();
    zoom = 1;
    makeRowsButtons();
    page.offer(place, { svg: async function () { return asSvg(); }, png: async function () { return asPng(); } });
    listen();
    play(playing);
    place.classList.add("ready");
    if (!asked()) { choose(0); }
  }
  begin();
}());
