// Typical ropes, for values that a file of another program lacks, and the fields for these values.

/**
 * Kinds of ropes: mass per length over the square of the diameter [kg/m per m²], and Young's modulus of the full circle
 * [Pa]. A steel rope of 4 mm has 64 g/m and about 750 kN; one of high-modulus polyethylene 11 g/m and 440 kN.
 */
const KINDS = {
  steel: { words: "steel wire rope", mass: 4000, modulus: 60e9 },
  fibre: { words: "high-modulus fibre rope (HMPE)", mass: 700, modulus: 35e9 },
};

export const ROPES = Object.entries(KINDS).map(([kind, { words }]) => [kind, words]);

/** Typical values of a rope with a diameter [m], to three digits. */
export function typical(kind, diameter) {
  const { mass, modulus } = KINDS[kind];
  const round = (value) => Number(value.toPrecision(3));
  const area = (Math.PI / 4) * diameter ** 2;
  return { mass_kg_per_m: round(mass * diameter ** 2), axial_stiffness_n: round(modulus * area) };
}

/** Values that an import may ask for, in the order of the dialog: words, unit, its size in SI, and how many numbers. */
export const FIELDS = {
  mass_kg_per_m: { words: "Mass of the ropes", unit: "g/m", factor: 1e-3, count: 1 },
  axial_stiffness_n: { words: "Axial stiffness EA of the ropes", unit: "kN", factor: 1e3, count: 1 },
  mass_kg: { words: "Mass of the platform", unit: "kg", factor: 1, count: 1, assumed: [100] },
  center_of_mass_m: { words: "Centre of mass x, y, z", unit: "m", factor: 1, count: 3, assumed: [0, 0, 0] },
  inertia_kg_m2: { words: "Inertia xx, yy, zz", unit: "kg m²", factor: 1, count: 3, assumed: [10, 10, 10] },
};

/** Values that the message of a refused import names as missing. */
export function missing(message) {
  if (!message.includes("lacks values")) {
    return [];
  }
  const named = [...message.matchAll(/`(\w+)`/g)].map(([, key]) => key);
  return Object.keys(FIELDS).filter((key) => named.includes(key));
}

/** Numbers of a field in SI; null if they are not as many numbers as it has. */
export function numbersOf(text, { factor, count }) {
  const parts = text.trim().split(count === 1 ? /$^/ : /[;\s]+|,\s*(?=\S)/);
  const numbers = parts.map((part) => (part === "" ? NaN : Number(part.replace(",", ".").replace("−", "-"))));
  const isRight = numbers.length === count && numbers.every(Number.isFinite);
  return isRight ? numbers.map((value) => Number((value * factor).toPrecision(12))) : null;
}

/** Keys of a request of the values. An inertia of three numbers has no products. */
export function keysOf(values) {
  return Object.fromEntries(
    Object.entries(values).map(([key, numbers]) => {
      const all = key === "inertia_kg_m2" ? [...numbers, 0, 0, 0] : numbers;
      return [key, FIELDS[key].count === 1 ? all[0] : all];
    }),
  );
}
