// Editor of the robot file, with the errors of the reader at their place and completion of keys.

import { autocompletion, closeBrackets, completionKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap } from "@codemirror/commands";
import { HighlightStyle, StreamLanguage, syntaxHighlighting } from "@codemirror/language";
import { toml } from "@codemirror/legacy-modes/mode/toml";
import { lintGutter, setDiagnostics } from "@codemirror/lint";
import { EditorState } from "@codemirror/state";
import { drawSelection, EditorView, highlightActiveLine, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";

const colors = HighlightStyle.define([
  { tag: tags.comment, color: "var(--soft)", fontStyle: "italic" },
  { tag: [tags.atom, tags.bool], color: "var(--violet)" },
  { tag: tags.number, color: "var(--accent)" },
  { tag: tags.string, color: "var(--green)" },
  { tag: [tags.propertyName, tags.bracket], color: "var(--ink)" },
]);

/** Part of a JSON Schema for the table with these keys; null if there is no such table. */
function partOf(schema, keys) {
  let node = schema;
  for (const key of keys) {
    const others = typeof node.additionalProperties === "object" ? node.additionalProperties : null;
    const next = node.properties?.[key] ?? others;
    if (!next) {
      return null;
    }
    node = next.type === "array" && next.items?.properties ? next.items : next;
  }
  return node;
}

/**
 * Names of tables after one bracket, or of lists of tables after two. After `materials.` follows a name of the user's
 * choice.
 */
function tablesOf(schema, brackets) {
  return Object.entries(schema.properties ?? {}).flatMap(([key, value]) => {
    const isList = Boolean(value.items?.properties);
    const isNamed = Boolean(value.additionalProperties?.properties);
    if (brackets === 2 ? !isList : !isNamed && !value.properties) {
      return [];
    }
    return [{ label: key, type: "class", info: value.description, apply: isNamed ? `${key}.` : key }];
  });
}

/** Keys that a table may have, and their meaning; with the key and nothing else for a nested table. */
const keysOf = (part) =>
  Object.entries(part?.properties ?? {}).map(([label, { description, type }]) => ({
    label,
    type: "property",
    info: description,
    apply: type === "object" ? label : `${label} = `,
  }));

/** Keys of the table header above a line, `[a.b]` or `[[a]]`; none at the top of the file. */
function tableAbove(document, number) {
  for (let line = number; line >= 1; line -= 1) {
    const header = /^\s*\[{1,2}\s*([^\]]+?)\s*\]/.exec(document.line(line).text);
    if (header) {
      return header[1].match(/"[^"]*"|'[^']*'|[^.\s]+/g) ?? [];
    }
  }
  return [];
}

export class Editor {
  /** JSON Schema of the robot file, for the completion of keys. */
  set schema(schema) {
    this.keys = schema;
  }

  /** Completions at a place: the keys of its table, or the tables after a bracket. */
  complete(context) {
    if (!this.keys) {
      return null;
    }
    const bracket = context.matchBefore(/^\s*\[{1,2}[a-z_]*/);
    if (bracket) {
      const name = /[a-z_]*$/.exec(bracket.text)[0];
      const brackets = bracket.text.trim().length - name.length;
      return { from: context.pos - name.length, options: tablesOf(this.keys, brackets), validFor: /^[a-z_]*$/ };
    }
    const word = context.matchBefore(/^\s*[a-z_0-9]*/);
    if (!word || !(context.explicit || word.text.trim() !== "")) {
      return null;
    }
    const { number } = context.state.doc.lineAt(context.pos);
    const part = partOf(this.keys, tableAbove(context.state.doc, number - 1));
    return { from: word.from + word.text.search(/[a-z_0-9]|$/), options: keysOf(part), validFor: /^[a-z_0-9]*$/ };
  }

  /** `changed(text)` is called after each change by a person. */
  constructor(place, changed) {
    this.silent = false;
    this.keys = null;
    this.view = new EditorView({
      parent: place,
      state: EditorState.create({
        extensions: [
          lineNumbers(),
          history(),
          drawSelection(),
          highlightActiveLine(),
          closeBrackets(),
          lintGutter(),
          StreamLanguage.define(toml),
          syntaxHighlighting(colors),
          autocompletion({ override: [(context) => this.complete(context)], activateOnTyping: true }),
          // Tab leaves the editor, for people who use the keyboard only.
          keymap.of([...completionKeymap, ...defaultKeymap, ...historyKeymap]),
          EditorView.contentAttributes.of({ tabindex: "0", "aria-label": "Robot file (TOML)" }),
          EditorView.updateListener.of((update) => {
            if (update.docChanged && !this.silent) {
              changed(update.state.doc.toString());
            }
          }),
        ],
      }),
    });
  }

  get text() {
    return this.view.state.doc.toString();
  }

  /** Shows another text; of an equal beginning and end only the middle is replaced, so that the cursor stays. */
  set text(text) {
    const old = this.text;
    if (old === text) {
      return;
    }
    let from = 0;
    while (from < old.length && old[from] === text[from]) {
      from += 1;
    }
    let end = 0;
    const most = Math.min(old.length, text.length) - from;
    while (end < most && old[old.length - 1 - end] === text[text.length - 1 - end]) {
      end += 1;
    }
    this.silent = true;
    this.view.dispatch({ changes: { from, to: old.length - end, insert: text.slice(from, text.length - end) } });
    this.silent = false;
  }

  /** Marks the errors of the reader. Their places are bytes of the text in UTF-8. */
  set issues(issues) {
    const { text } = this;
    const bytes = new TextEncoder().encode(text);
    const at = (byte) => Math.min(text.length, new TextDecoder().decode(bytes.subarray(0, byte)).length);
    const diagnostics = issues.map((issue) => ({
      from: at(issue.from_byte),
      to: Math.max(at(issue.from_byte), at(issue.to_byte)),
      severity: "error",
      message: issue.help ? `${issue.message}\n${issue.help}` : issue.message,
    }));
    this.view.dispatch(setDiagnostics(this.view.state, diagnostics));
  }

  /** Puts the cursor at a place of the text. */
  show(byte) {
    const bytes = new TextEncoder().encode(this.text);
    const anchor = new TextDecoder().decode(bytes.subarray(0, byte)).length;
    this.view.dispatch({ selection: { anchor }, scrollIntoView: true });
    this.view.focus();
  }
}
