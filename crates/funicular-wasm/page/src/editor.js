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

/** Keys of the robot file with their meaning, from its JSON Schema. */
function keysOf(schema) {
  const found = new Map();
  const walk = (node) => {
    if (node === null || typeof node !== "object") {
      return;
    }
    for (const [key, value] of Object.entries(node.properties ?? {})) {
      if (!found.has(key)) {
        found.set(key, { label: key, type: "property", info: value.description, apply: value.type === "object" ? key : `${key} = ` });
      }
    }
    Object.values(node).forEach(walk);
  };
  walk(schema);
  return [...found.values()];
}

export class Editor {
  /** Keys of the robot file that the editor completes, from its JSON Schema. */
  set schema(schema) {
    this.keys = keysOf(schema);
  }

  /** `changed(text)` is called after each change by a person. */
  constructor(place, changed) {
    this.silent = false;
    this.keys = [];
    const complete = (context) => {
      const word = context.matchBefore(/^\s*[a-z_0-9]*/);
      return word && (context.explicit || word.text.trim() !== "")
        ? { from: word.from + word.text.search(/[a-z_0-9]|$/), options: this.keys, validFor: /^[a-z_0-9]*$/ }
        : null;
    };
    this.view = new EditorView({
      parent: place,
      state: EditorState.create({
        extensions: [
          lineNumbers(), history(), drawSelection(), highlightActiveLine(), closeBrackets(), lintGutter(),
          StreamLanguage.define(toml), syntaxHighlighting(colors), autocompletion({ override: [complete], activateOnTyping: true }),
          // Tab leaves the editor, for people who use the keyboard only.
          keymap.of([...completionKeymap, ...defaultKeymap, ...historyKeymap]),
          EditorView.contentAttributes.of({ "aria-label": "Robot file (TOML)" }),
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
    while (end < Math.min(old.length, text.length) - from && old[old.length - 1 - end] === text[text.length - 1 - end]) {
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
