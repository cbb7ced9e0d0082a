// Why a pose has no equilibrium, in plain words beside it.

const MAX_NAMED = 3;
const SHORT_NAME = /^[\w.-]{1,4}$/;

/** Name of a cable within a sentence: “cable 3”, but only the name if it says itself what it is. */
export const cableName = (name) => (SHORT_NAME.test(name) ? `cable ${name}` : `“${name}”`);

/** Several cables within a sentence. */
export function cableNames(names) {
  const shown = names.slice(0, MAX_NAMED);
  const more = names.length - shown.length;
  const areShort = names.length > 1 && names.every((name) => SHORT_NAME.test(name));
  const all = areShort ? shown : shown.map(cableName);
  const list = more ? `${all.join(", ")} and ${more} more` : all.join(", ").replace(/, ([^,]*)$/, " and $1");
  return areShort ? `cables ${list}` : list;
}

/** Reason of a refused pose without an equilibrium. `border`: what the core tells about it. */
export function reasonOf(border) {
  const { one_sided: oneSided, push = [], minimum = [], maximum = [] } = border ?? {};
  if (oneSided) {
    return "no cable pulls against the load";
  }
  if (push.length) {
    return `${cableNames(push)} would have to push`;
  }
  const owns = (names) => (names.length > 1 ? "their" : "its");
  const parts = [
    minimum.length ? `${cableNames(minimum)} would need less than ${owns(minimum)} minimum tension` : "",
    maximum.length ? `${cableNames(maximum)} would need more than ${owns(maximum)} maximum tension` : "",
  ].filter(Boolean);
  return parts.join(", and ") || "no equilibrium was found";
}
