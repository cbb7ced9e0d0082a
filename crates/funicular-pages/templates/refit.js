// Fits a calibration again without some of its rows, from its linear equations. The page of `calibrate` and the live page
// share it; `data` is what the core calls the data of a refit, `found` what `refit` returns.

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

// Step of the free directions and their covariance without the rows that are marked; null where the others do not determine
// all values.
export function refit(linear, isLeftOut) {
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
function along(row, step) { return row.reduce(function (sum, of, a) { return sum + of * step[a]; }, 0); }

// Every value with its change and its deviation; null without a fit or without a deviation.
export function refittedValues(data, found) {
  const linear = data.linear;
  return data.values.map(function (value, k) {
    const moved = found === null ? null : value.held ? 0 : along(linear.free[k], found.step) * linear.units[k];
    const isKnown = found !== null && found.factor !== null && !value.held;
    const deviation = isKnown ? found.factor * Math.sqrt(product(linear.free[k], found.covariance, linear.free[k])) * Math.abs(linear.units[k]) : null;
    return { path: value.path, unit: value.unit, value: moved === null ? null : value.value + moved, moved: moved, deviation: deviation };
  });
}

// Every anchor with its place and the covariance of its coordinates with inner conditions; null without a deviation.
export function refittedAnchors(data, found) {
  const linear = data.linear;
  return data.anchors.map(function (anchor) {
    const position = anchor.position.map(function (at, axis) {
      const k = anchor.places[axis];
      return k === null ? at : at + along(linear.free[k], found.step);
    });
    const entry = function (a, b) {
      return a === null || b === null ? 0 : found.factor * found.factor * product(linear.inner[a], found.covariance, linear.inner[b]);
    };
    const covariance = found.factor === null ? null : anchor.places.map(function (a) { return anchor.places.map(function (b) { return entry(a, b); }); });
    return { position: position, covariance: covariance };
  });
}

// Lower Cholesky factor of the covariance along some axes, which maps the unit sphere to the ellipsoid of one deviation.
export function spreadOf(covariance, axes) {
  const factor = axes.map(function () { return new Array(axes.length).fill(0); });
  axes.forEach(function (a, i) {
    for (let j = 0; j <= i; j++) {
      let sum = covariance[a][axes[j]];
      for (let k = 0; k < j; k++) { sum -= factor[i][k] * factor[j][k]; }
      if (i === j) { factor[i][i] = Math.sqrt(Math.max(sum, 0)); } else { factor[i][j] = factor[j][j] > 0 ? sum / factor[j][j] : 0; }
    }
  });
  return factor;
}

// Sentence on a refit without `count` rows.
export function refitSentence(found, count) {
  if (found === null) { return "Without these rows the others do not determine all values."; }
  const rows = count === 0 ? "All rows" : "Without " + count + (count === 1 ? " row" : " rows");
  return rows + ": χ² " + rounded(found.chi2, 4) + " with " + found.degrees + " degrees of freedom.";
}

// Number with some digits; a dash where there is none.
export function rounded(value, digits) { return value === null || !Number.isFinite(value) ? "–" : Number(value.toPrecision(digits)).toString(); }
