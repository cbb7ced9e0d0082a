// Box of the page of messages: the reader pastes a message, and the page answers with the rows whose messages fit, the best
// first. It reads the page alone, so that it works from a file.
"use strict";

(() => {
  const MAX_ANSWERS = 5;
  // Letters that the fixed words of a message need to be a sign of it.
  const MIN_LETTERS = 6;
  // Weight of a line of help and of a part of a message beside a message.
  const WEIGHT_OF_PART = 0.3;
  // Share of the words of a query that have to occur in a message if no message fits as a whole.
  const MIN_SHARE = 0.6;

  /** Text without what differs between the command line, Python and JSON. */
  function plain(text) {
    return text
      .toLowerCase()
      .replace(/--([a-z][a-z-]*)/g, (_, name) => name.replaceAll("-", "_"))
      .replace(/[`"'“”‘’]/g, "")
      .replace(/\s+/g, " ")
      .trim();
  }

  const letters = (text) => text.replace(/[^a-z]/g, "").length;
  const words = (text) => plain(text).match(/[\p{L}_][\p{L}\d_]*/gu) ?? [];

  /** Messages of the page, each with its fixed parts and its row. */
  function entries() {
    return [...document.querySelectorAll("article section section li")].flatMap((item) => {
      const code = item.querySelector("code");
      if (!code) return [];
      const text = code.textContent;
      const parts = text.split("…").map(plain).filter(Boolean);
      const row = item.closest("section");
      const weight = item.closest("details.parts, details.helps") ? WEIGHT_OF_PART : 1;
      const title = new Set(words(row.querySelector("h3").textContent));
      return [
        {
          text,
          parts,
          row,
          weight,
          title,
          all: new Set(words(`${item.textContent} ${row.querySelector("h3").textContent}`)),
        },
      ];
    });
  }

  /** Letters of a message that the query has, in their order; 0 if a fixed part is missing. */
  function fits(entry, query) {
    let from = 0;
    for (const part of entry.parts) {
      const at = query.indexOf(part, from);
      if (at < 0) return 0;
      from = at + part.length;
    }
    const count = letters(entry.parts.join(""));
    return count >= MIN_LETTERS ? count * entry.weight : 0;
  }

  /** Share of the words of the query that a set has. */
  function shared(set, asked) {
    return asked.filter((word) => set.has(word)).length / asked.length;
  }

  /** Rows for a query, the best first, each with its best message. */
  function answers(all, text) {
    const query = plain(text);
    const asked = words(text).filter((word) => word.length > 1 && word !== "error" && word !== "warning");
    if (asked.length === 0) return [];
    let scored = all.map((entry) => ({ entry, score: fits(entry, query) })).filter((one) => one.score > 0);
    if (scored.length === 0) {
      scored = all.map((entry) => ({ entry, score: shared(entry.all, asked) })).filter((one) => one.score >= MIN_SHARE);
      for (const one of scored) one.score += shared(one.entry.title, asked);
    }
    const best = new Map();
    for (const one of scored) {
      const before = best.get(one.entry.row);
      if (!before || one.score > before.score) best.set(one.entry.row, one);
    }
    return [...best.values()].sort((a, b) => b.score - a.score).slice(0, MAX_ANSWERS);
  }

  /** Copy of a row with the message that fits. */
  function answer({ entry }, leave) {
    const out = document.createElement("div");
    const heading = document.createElement("h3");
    const link = document.createElement("a");
    link.href = `#${entry.row.id}`;
    link.textContent = entry.row.querySelector("h3").firstChild.textContent;
    link.addEventListener("click", leave);
    heading.append(link);
    const message = document.createElement("p");
    const code = document.createElement("code");
    code.className = "literal";
    code.textContent = entry.text;
    message.append(code);
    const about = [...entry.row.querySelectorAll(":scope > p")].map((paragraph) => paragraph.cloneNode(true));
    out.append(heading, message, ...about);
    return out;
  }

  function start() {
    const filter = document.querySelector(".message-filter");
    const box = filter.querySelector("textarea");
    const status = filter.querySelector('[role="status"]');
    const shown = filter.querySelector(".message-answers");
    const all = entries();
    filter.hidden = false;

    const update = () => {
      const asked = box.value.trim() !== "";
      const found = asked ? answers(all, box.value) : [];
      filter.parentElement.classList.toggle("is-filtered", asked);
      status.textContent = !asked
        ? ""
        : found.length > 0
          ? "The best answer is first. Empty the box to see all messages."
          : "No message has these words. Paste the line after error: or warning:, or fewer words.";
      shown.replaceChildren(
        ...found.map((one) =>
          answer(one, () => {
            box.value = "";
            update();
            for (const folded of one.entry.row.querySelectorAll("details")) folded.open = true;
          }),
        ),
      );
    };
    box.addEventListener("input", update);
    update();
  }

  start();
})();
