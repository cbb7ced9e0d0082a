// Names of the robots of the library, none twice.

const nameOf = (text) => /^name = "(.*)"/m.exec(text)?.[1];

/** Names and titles of robots. Equal names get what tells them apart: their winches, or else their file. */
export function titles(robots) {
  const all = Object.entries(robots).map(([name, text]) => ({ name, text, title: nameOf(text) ?? name }));
  const same = (one) => all.filter((other) => other.title === one.title);
  return all.map((one) => {
    const group = same(one);
    if (group.length === 1) {
      return [one.name, one.title];
    }
    const has = ({ text }) => text.includes("\n[winches");
    const apart = group.filter((other) => has(other) === has(one)).length === 1;
    return [one.name, `${one.title}, ${apart ? (has(one) ? "with winches" : "without winches") : one.name}`];
  });
}
