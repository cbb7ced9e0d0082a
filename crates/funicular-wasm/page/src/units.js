// Engineers' units and words for the numbers of a robot file, which are in SI.

/** Units that are shown for an SI unit, each from a size of the value on: factor and name. */
const UNITS = {
  Pa: [
    [1e9, "GPa", 1e8],
    [1e6, "MPa", 1e5],
  ],
  "m²": [
    [1, "m²", 1e-2],
    [1e-6, "mm²", 0],
  ],
  m: [
    [1, "m", 0.1],
    [1e-3, "mm", 0],
  ],
  N: [
    [1e6, "MN", 1e7],
    [1e3, "kN", 1e5],
  ],
  "kg/m": [
    [1, "kg/m", 1],
    [1e-3, "g/m", 0],
  ],
  s: [
    [1, "s", 0.1],
    [1e-3, "ms", 0],
  ],
};

/** Lengths that are dimensions of parts; the others are places, which stay in metres. */
const DIMENSION = /(diameter|radius|thickness)_m$/;

/**
 * Unit in which a value of the file is shown: `factor` of it in SI, and its `name`. It follows from the value of the
 * file alone, so that it stays when the value changes.
 */
export function unitOf({ path, unit, value }) {
  const size = Math.abs(value);
  const scales = unit === "m" && !DIMENSION.test(path) ? [] : (UNITS[unit] ?? []);
  const [factor, name] = (size > 0 && scales.find(([, , from]) => size >= from)) || [1, unit];
  return { factor, name: name === "1" ? "" : name };
}

/** Short words for the values of ropes, which most people change first; the core's words explain them. */
const SHORT = {
  youngs_modulus_pa: "Young's modulus",
  area_m2: "metal area",
  axial_stiffness_n: "axial stiffness EA",
  mass_kg_per_m: "mass per length",
  diameter_m: "diameter",
};

/** What a number is, in words without its unit: “Young's modulus of wire-rope-4mm”. */
export function wordsOf({ label, path }) {
  const [, rope, key] = /^materials\.(?:'([^']*)'|"[^"]*"|[^.]*)\.(\w+)$/.exec(path) ?? [];
  if (SHORT[key]) {
    return `${SHORT[key]} of ${rope ?? path.split(".")[1].replaceAll('"', "")}`;
  }
  const bare = (label ?? path).replace(/ \[[^\]]*\]$/, "");
  const of = /^(.*) \((.*)\)(, [^()]*)?$/.exec(bare);
  if (!of) {
    return bare;
  }
  const owner = /^cables\./.test(path) ? `cable ${of[2]}` : of[2];
  return `${of[1].replace(/ of the (cable|rope)$/, "")} of ${owner}${of[3] ?? ""}`;
}

/** Words with the unit in which the value is shown. */
export function labelOf(parameter) {
  const { name } = unitOf(parameter);
  return name ? `${wordsOf(parameter)} [${name}]` : wordsOf(parameter);
}

/** Value in a unit without the rounding of the division: 8.2051e-6 m² are 8.2051 mm². */
export const shownValue = (value, { factor }) => Number((value / factor).toPrecision(12));

/** Value in SI of a number that is shown in a unit. */
export const valueOf = (shown, { factor }) => (factor === 1 ? shown : Number((shown * factor).toPrecision(12)));

const plainWords = (text) => text.toLowerCase().replaceAll("’", "'");

/** Parameters whose words or path have every word of a search; those whose words begin with it come first. */
export function found(parameters, search, most) {
  const wanted = plainWords(search).split(/\s+/).filter(Boolean);
  const rank = (parameter) => {
    const words = plainWords(wordsOf(parameter));
    const all = `${words} ${parameter.path.toLowerCase()} ${plainWords(parameter.meaning ?? "")}`;
    if (!wanted.every((word) => all.includes(word))) {
      return null;
    }
    return wanted.every((word) => words.includes(word)) ? (words.startsWith(wanted[0] ?? "") ? 0 : 1) : 2;
  };
  return parameters
    .map((parameter) => ({ parameter, order: rank(parameter) }))
    .filter(({ order }) => order !== null)
    .sort((a, b) => a.order - b.order)
    .slice(0, most)
    .map(({ parameter }) => parameter);
}
