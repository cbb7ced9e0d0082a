// Texts and elements of the page.

/** Number with significant digits, without an exponent between 1e-4 and 1e6; a dash for no number. */
export function short(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) {
    return "–";
  }
  if (value === 0) {
    return "0";
  }
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    return `${sign(String(Number(mantissa)))}·10${superscript(Number(exponent))}`;
  }
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  const [whole, part] = value.toFixed(Math.min(decimals, 12)).split(".");
  const grouped = whole.replace("-", "").length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, "\u202f") : whole;
  return sign(part === undefined ? grouped : `${grouped}.${part}`);
}

const sign = (text) => text.replace("-", "−");
const superscript = (number) => String(number).replace(/[-0-9]/g, (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]));

/** Values in words: one number, or the smallest and the largest. */
export function span(values, digits = 3) {
  const [low, high] = [Math.min(...values), Math.max(...values)].map((value) => short(value, digits));
  return low === high ? low : `${low} to ${high}`;
}

/** Number as one types it: a point, no grouping, at most `digits` significant digits, an exponent if it is shorter. */
export function plain(value, digits = 7) {
  const number = Number(value.toPrecision(digits));
  const size = Math.abs(number);
  return size !== 0 && (size >= 1e7 || size < 1e-3) ? number.toExponential().replace("e+", "e") : String(number);
}

/** Number at a tick of an axis. */
export const tick = (value) => sign(String(Number(value.toPrecision(6))));

/** Element of a page by its id. */
export const $ = (id) => document.getElementById(id);

/** New element with attributes and children; `on…` attributes are listeners. */
export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) {
      made.addEventListener(key.slice(2), value);
    } else if (value === true) {
      made.setAttribute(key, "");
    } else if (value !== false && value !== undefined && value !== null) {
      made.setAttribute(key, value);
    }
  }
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}

/** Text for HTML and SVG. */
export const escaped = (text) =>
  String(text).replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);

/** Saves a text or bytes as a file. */
export function save(name, content, type) {
  const link = element("a", { href: URL.createObjectURL(new Blob([content], { type })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** Copies a text; the button says so for a moment. */
export async function copy(text, button) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const area = document.createElement("textarea");
    area.value = text;
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
  }
  const old = button.dataset.text ?? button.textContent;
  button.dataset.text = old;
  button.textContent = "Copied";
  setTimeout(() => {
    button.textContent = old;
  }, 1500);
}
