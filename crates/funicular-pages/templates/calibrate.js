// Fits a calibration again without the rows that are clicked away, from its linear equations.
(async function () {
  "use strict";
  const data = JSON.parse(document.getElementById("linear-rows").textContent);
  const linear = data.linear, choice = document.getElementById("row-choice"), place = document.getElementById("refitted");
  if (!linear) {
    document.getElementById("left-out").textContent = "These rows do not determine all values: none of them can be left out.";
    return;
  }

  // Inverse of a symmetric positive definite matrix by Cholesky factors; null where it is none.
  function inverse(matrix) {
    const n = matrix.length, factor = matrix.map(function (row) { return row.slice(); });
    // Unit diagonal, so that units do not decide what is singular.
    const scale = factor.map(function (row, i) { return 1 / Math.sqrt(row[i]); });
    if (!scale.every(Number.isFinite)) { return null; }
    factor.forEach(function (row, i) { row.forEach(function (value, j) { row[j] = value * scale[i] * scale[j]; }); });
    for (let i = 0; i < n; i++) {
      for (let j = 0; j <= i; j++) {
        let sum = factor[i][j];
        for (let k = 0; k < j; k++) { sum -= factor[i][k] * factor[j][k]; }
        if (i === j) {
          // Rank is lost below 3e-5 in the columns, 1e-9 in their products.
          if (!(sum > 1e-9)) { return null; }
          factor[i][i] = Math.sqrt(sum);
        } else {
          factor[i][j] = sum / factor[j][j];
        }
      }
    }
    const columns = [];
    for (let c = 0; c < n; c++) {
      const x = new Array(n).fill(0);
      for (let i = 0; i < n; i++) {
        let sum = i === c ? 1 : 0;
        for (let k = 0; k < i; k++) { sum -= factor[i][k] * x[k]; }
        x[i] = sum / factor[i][i];
      }
      for (let i = n - 1; i >= 0; i--) {
        let sum = x[i];
        for (let k = i + 1; k < n; k++) { sum -= factor[k][i] * x[k]; }
        x[i] = sum / factor[i][i];
      }
      columns.push(x);
    }
    return columns.map(function (column, c) { return column.map(function (value, i) { return value * scale[i] * scale[c]; }); });
  }

  // Values and covariance without some rows.
  function refit(isLeftOut) {
    const n = linear.information.length;
    const information = linear.information.map(function (row) { return row.slice(); });
    const right = new Array(n).fill(0);
    let degrees = linear.degrees_of_freedom;
    linear.rows.forEach(function (row, j) {
      if (!isLeftOut[j]) { return; }
      degrees -= row.residuals.length;
      row.by_free.forEach(function (w, q) {
        for (let a = 0; a < n; a++) {
          right[a] += w[a] * row.residuals[q];
          for (let b = 0; b < n; b++) { information[a][b] -= w[a] * w[b]; }
        }
      });
    });
    const covariance = inverse(information);
    if (!covariance || degrees < 0) { return null; }
    const step = covariance.map(function (row) { return row.reduce(function (sum, value, a) { return sum + value * right[a]; }, 0); });
    // The rows that are left, and priors, which stay as they are: χ² falls by what the others had, and by the step.
    let chi2 = linear.chi2;
    linear.rows.forEach(function (row, j) {
      if (isLeftOut[j]) { row.residuals.forEach(function (residual) { chi2 -= residual * residual; }); }
    });
    step.forEach(function (value, a) { chi2 -= value * right[a]; });
    const factor = linear.factor || (degrees > 0 ? Math.sqrt(Math.max(chi2, 0) / degrees) : null);
    return { step: step, covariance: covariance, chi2: Math.max(chi2, 0), degrees: degrees, factor: factor };
  }

  // Product d C dᵀ of rows of the free directions.
  function product(a, covariance, b) {
    return a.reduce(function (sum, x, i) { return sum + x * covariance[i].reduce(function (inner, value, j) { return inner + value * b[j]; }, 0); }, 0);
  }
  function text(value, digits) { return value === null || !Number.isFinite(value) ? "–" : Number(value.toPrecision(digits)).toString(); }

  const isLeftOut = linear.rows.map(function () { return false; });
  const originals = Array.from(document.querySelectorAll('script[data-plot^="figure-anchors"]')).map(function (source) {
    return { place: document.getElementById(source.dataset.plot), figure: JSON.parse(source.textContent) };
  });

  function table(found) {
    const rows = data.values.map(function (value, k) {
      const moved = found && value.held ? 0 : found ? linear.free[k].reduce(function (sum, of, a) { return sum + of * found.step[a]; }, 0) * linear.units[k] : null;
      const deviation = found && found.factor !== null && !value.held ? found.factor * Math.sqrt(product(linear.free[k], found.covariance, linear.free[k])) * Math.abs(linear.units[k]) : null;
      return [value.path, value.unit, text(moved === null ? null : value.value + moved, 6), text(moved, 3), text(deviation, 3)];
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
    originals.forEach(function (original) {
      const figure = structuredClone(original.figure), axes = figure.layout.meta.axes, scale = figure.layout.meta.scale;
      const rowsOf = function (anchor, directions) {
        return axes.map(function (axis) { const k = data.anchors[anchor].places[axis]; return k === null ? null : directions[k]; });
      };
      figure.data.forEach(function (trace) {
        if (trace.name === "rows") { trace.marker.color = linear.rows.map(function (_, j) { return isLeftOut[j] ? "#bbbbbb" : original.figure.data.find(function (of) { return of.name === "rows"; }).marker.color; }); }
        if (!found) { return; }
        if (trace.name === "calibrated") {
          ["x", "y"].forEach(function (name, k) {
            trace[name] = data.anchors.map(function (anchor, i) {
              const free = rowsOf(i, linear.free)[k];
              return anchor.position[axes[k]] + (free ? free.reduce(function (sum, of, a) { return sum + of * found.step[a]; }, 0) : 0);
            });
          });
        }
        if (trace.meta && found.factor !== null) {
          const anchor = data.anchors[trace.meta.anchor], free = rowsOf(trace.meta.anchor, linear.free), inner = rowsOf(trace.meta.anchor, linear.inner);
          const centre = axes.map(function (axis, k) { return anchor.position[axis] + (free[k] ? free[k].reduce(function (sum, of, a) { return sum + of * found.step[a]; }, 0) : 0); });
          const entry = function (a, b) { return inner[a] && inner[b] ? found.factor * found.factor * product(inner[a], found.covariance, inner[b]) : 0; };
          // Lower Cholesky factor of the 2 × 2 covariance.
          const l11 = Math.sqrt(Math.max(entry(0, 0), 0)), l21 = l11 > 0 ? entry(0, 1) / l11 : 0, l22 = Math.sqrt(Math.max(entry(1, 1) - l21 * l21, 0));
          const turns = trace.x.map(function (_, k) { return 2 * Math.PI * k / (trace.x.length - 1); });
          trace.x = turns.map(function (turn) { return centre[0] + 2 * scale * l11 * Math.cos(turn); });
          trace.y = turns.map(function (turn) { return centre[1] + 2 * scale * (l21 * Math.cos(turn) + l22 * Math.sin(turn)); });
        }
        if (trace.name === "weakest combination") { trace.visible = isLeftOut.some(Boolean) ? "legendonly" : true; }
      });
      page.show(original.place, figure.data, figure.layout);
    });
  }

  async function update() {
    const found = refit(isLeftOut), count = isLeftOut.filter(Boolean).length;
    const sentence = document.createElement("p");
    sentence.textContent = !found ? "Without these rows the others do not determine all values."
      : count === 0 ? "All rows: χ² " + text(found.chi2, 4) + " with " + found.degrees + " degrees of freedom."
      : "Without " + count + (count === 1 ? " row" : " rows") + ": χ² " + text(found.chi2, 4) + " with " + found.degrees + " degrees of freedom.";
    place.replaceChildren(sentence, table(found));
    await page.drawn;
    draw(found);
  }

  linear.rows.forEach(function (_, j) {
    const label = document.createElement("label"), box = document.createElement("input");
    box.type = "checkbox";
    box.checked = true;
    box.addEventListener("change", function () { isLeftOut[j] = !box.checked; update(); });
    label.append(box, " row " + (j + 1) + " ");
    choice.append(label);
  });
  update();
}());
