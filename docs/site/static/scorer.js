// Ranks the pages that a search finds, and shows what they say about it. Sphinx puts this text before its search; the texts
// of all sections are in search_texts.js.

var Scorer = (() => {
  // How likely a page is what a reader looks for. The first pattern that fits counts.
  const WEIGHTS = [
    [/^(index|genindex|gallery\/|project\/)/, 0.2],
    [/^validation\//, 0.25],
    [/^(theory\/|reference\/messages|notebooks\/|reference\/python|speed|matlab)/, 0.6],
    [/^(reference\/|tutorials\/|python|web|export|import|coming-from|commands|sweeps)/, 0.8],
    [/^(conventions|glossary|robot-file|pulleys|install|jupyter|cite)$/, 1.2],
  ];
  const HEADING = 20; // the words in this order in a heading
  const WHOLE_HEADING = 10; // the heading begins with them
  const PHRASE = 8; // the words in this order in the text
  const MAX_TIMES = 6; // more of them count no more
  const ALL_WORDS = 4; // all words in one section
  const WORD_OF_HEADING = 3; // a word in the heading
  const WORD_OF_TITLE = 6; // a word in the title of the page
  const MEANING = 14; // all words of a question in one section, or others of the same meaning
  const IN_HEADING = 2; // a word in a heading counts as often in the text
  const MIN_MEANING = 0.5; // part of a question that a page has to have
  const OTHER_WORD = 0.7; // a word of the same meaning counts less than the word itself
  const FILLERS = new Set("can could get happen happens make must my need one use want".split(" ")); // beside stop words
  const BEFORE = 90; // characters of an excerpt before the words
  const EXCERPT = 240;

  const stems = new Map();
  let stemmer;
  const excerpts = new Map();
  const known = new Map();

  function stemmed(text) {
    stemmer ??= new Stemmer();
    const words = text.toLowerCase().match(/[\p{L}\p{N}_]+/gu) ?? [];
    return words.map((word) => {
      if (!stems.has(word)) stems.set(word, stemmer.stemWord(word));
      return stems.get(word);
    });
  }

  let groups = null;

  /** Stems of a word and of others of the same meaning; the word itself first. */
  function meanings(stem) {
    if (groups === null) {
      groups = new Map();
      for (const row of typeof SEARCH_SYNONYMS === "undefined" ? [] : SEARCH_SYNONYMS) {
        const stems = row.map((word) => stemmed(word)[0]);
        for (const one of stems) groups.set(one, [...new Set([...(groups.get(one) ?? []), ...stems])]);
      }
    }
    return [stem, ...(groups.get(stem) ?? []).filter((other) => other !== stem)];
  }

  const joined = (words) => ` ${words.join(" ")} `;

  function sectionsOf(name) {
    if (!known.has(name)) {
      const all = typeof SEARCH_TEXTS === "undefined" ? [] : (SEARCH_TEXTS[name] ?? []);
      known.set(
        name,
        all.map(([anchor, heading, text]) => ({
          anchor,
          heading,
          text,
          inHeading: joined(stemmed(heading)),
          inText: joined(stemmed(text)),
        })),
      );
    }
    return known.get(name);
  }

  function valueOf(section, words) {
    const phrase = joined(words);
    const times = section.inText.split(phrase).length - 1;
    const both = section.inHeading + section.inText;
    return (
      (section.inHeading.includes(phrase) ? HEADING : 0) +
      (section.inHeading.startsWith(phrase) ? WHOLE_HEADING : 0) +
      (times > 0 ? PHRASE + Math.min(times, MAX_TIMES) : 0) +
      words.filter((word) => section.inHeading.includes(` ${word} `)).length * WORD_OF_HEADING +
      (words.every((word) => both.includes(` ${word} `)) ? ALL_WORDS : 0)
    );
  }

  let asked = null;

  /** Words of the question that tell something, each with its meanings and its weight: rare words weigh more. */
  function question() {
    if (asked !== null) return asked;
    const all = typeof SEARCH_TEXTS === "undefined" ? [] : Object.keys(SEARCH_TEXTS).flatMap(sectionsOf);
    const told = query()
      .split(/\s+/)
      .filter((word) => {
        const bare = word.toLowerCase().replace(/[^\p{L}]/gu, "");
        return !stopwords.has(bare) && !FILLERS.has(bare);
      });
    asked = [...new Set(stemmed(told.join(" ")))].map((stem) => {
      const stems = meanings(stem);
      const count = all.filter((one) =>
        stems.some((of) => one.inHeading.includes(` ${of} `) || one.inText.includes(` ${of} `)),
      );
      return { stems, weight: Math.log(1 + all.length / (1 + count.length)) };
    });
    return asked;
  }

  /** Part of the question that a section answers: 0 to 1, up to 2 if its words are in the heading. */
  function meaningOf(section) {
    const words = question();
    const total = words.reduce((sum, { weight }) => sum + weight, 0);
    const sum = words.reduce((before, { stems, weight }) => {
      const values = stems.map((stem, i) => {
        const place = section.inHeading.includes(` ${stem} `)
          ? IN_HEADING
          : section.inText.includes(` ${stem} `)
            ? 1
            : 0;
        return place * (i === 0 ? 1 : OTHER_WORD);
      });
      return before + weight * Math.max(...values);
    }, 0);
    return total > 0 ? sum / total : 0;
  }

  /** Piece of a text around the first of the words. */
  function excerpt(text, query) {
    const lower = text.toLowerCase();
    const parts = [query, ...query.split(/\s+/)].map((part) =>
      part.toLowerCase().slice(0, Math.max(3, part.length - 2)),
    );
    const at = parts.map((part) => lower.indexOf(part)).find((place) => place >= 0) ?? 0;
    const from = at < BEFORE || text.length <= EXCERPT ? 0 : lower.indexOf(" ", at - BEFORE) + 1;
    const piece = text.slice(from, from + EXCERPT);
    const isCut = from + EXCERPT < text.length;
    return (from > 0 ? "… " : "") + (isCut ? `${piece.slice(0, piece.lastIndexOf(" "))} …` : piece).trim();
  }

  const query = () => (new URLSearchParams(window.location.search).get("q") ?? "").trim();

  function score(result) {
    const [name, , , , points, , kind] = result;
    const weight = (WEIGHTS.find(([pattern]) => pattern.test(name)) ?? [null, 1])[1];
    const words = stemmed(query());
    const sections = sectionsOf(name);
    if (kind === "object" || words.length === 0 || sections.length === 0) return points * weight;
    let best = sections[0];
    let most = -1;
    for (const section of sections) {
      const value = valueOf(section, words) + MEANING * meaningOf(section);
      if (value > most) [best, most] = [section, value];
    }
    // One result per page, which leads to its best section.
    const title = sections[0].heading;
    const ofTitle = words.filter((word) => sections[0].inHeading.includes(` ${word} `)).length;
    result[1] = best === sections[0] ? title : `${title} › ${best.heading}`;
    result[2] = best === sections[0] ? "" : `#${best.anchor}`;
    result[3] = null;
    excerpts.set(`${name}.html${result[2]}`, excerpt(best.text, query()));
    return (most + ofTitle * WORD_OF_TITLE) * weight;
  }

  /** Lets the search also find pages that have most of a question, in its words or in others of the same meaning. */
  function widen(search) {
    const strict = search.performTermsSearch;
    search.performTermsSearch = (words, excluded) => {
      const found = strict(words, excluded);
      const names = new Set(found.map(([name]) => name));
      const { docnames, titles, filenames } = search._index;
      docnames.forEach((name, i) => {
        if (names.has(name) || excluded.size > 0) return;
        const best = Math.max(0, ...sectionsOf(name).map(meaningOf));
        if (best >= MIN_MEANING) found.push([name, titles[i], "", null, 1, filenames[i], "text"]);
      });
      return found;
    };
  }

  /** Puts the excerpt below each result that appears. */
  function watch() {
    const results = document.getElementById("search-results");
    if (!results) return;
    const complete = () => {
      for (const link of results.querySelectorAll("ul.search > li > a:only-child")) {
        const text = excerpts.get(link.getAttribute("href"));
        if (!text) continue;
        const paragraph = document.createElement("p");
        paragraph.className = "excerpt";
        paragraph.textContent = text;
        link.after(paragraph);
      }
    };
    new MutationObserver(complete).observe(results, { childList: true, subtree: true });
    complete();
  }

  if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", watch);
  else watch();

  return {
    score,
    widen,
    objNameMatch: 11,
    objPartialMatch: 6,
    objPrio: { 0: 15, 1: 5, 2: -5 },
    objPrioDefault: 0,
    title: 15,
    partialTitle: 7,
    term: 5,
    partialTerm: 2,
  };
})();
