"""Page of all messages: the refusals and warnings are read from the sources, cause and cure from messages.toml.

A text of the sources counts as a message by the macro, call or attribute around it. A message without a row of
messages.toml is an error, and so is a row without a message. Lines of help, and texts from which the program puts a message
together, are folded below the messages of their row. static/messages.js finds the row of a message that a reader pastes."""

import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from pages import ROOT
from rust_texts import texts

CRATES = [
    "funicular", "funicular-study", "funicular-formats", "funicular-pages", "funicular-files", "funicular-cli", "funicular-py",
]
# Macros, calls and attributes that make errors, and what plausibility calls its findings.
CALLS = {
    "Err", "EditError", "Implausible", "NoSolution", "Odd", "Parts", "Unfit", "anyhow!", "bail!", "context", "error",
    "help", "input", "issue", "let message", "let reason", "let sentence", "map_err", "ok_or", "ok_or_else", "refuse",
    "with_context",
}
# Texts in these are for developers: they mean a mistake in the program.
INSIDE = {"assert!", "assert_eq!", "debug_assert!", "declared!", "expect", "panic!", "unreachable!"}
# Files all of whose texts are messages, because their calls are too many to name.
WHOLE = re.compile(
    r"/warnings(/|\.rs)|/statics/(obstacle|error)\.rs|/dynamics/error\.rs|/reduced_model/error\.rs|/sweep/error\.rs"
    r"|/modes/certificate\.rs|/identify/caveats\.rs"
)
# Tests have no messages for users; neither have the reference numbers, whose crate is not in the list.
OUTSIDE = re.compile(r"tests\.rs$|/tests/")
# Files whose texts are parts of messages: a finding is put together from the value, the usual range and a likely mistake.
PARTS = re.compile(r"/warnings/plausibility|/statics/obstacle\.rs")
# Values of variables that become parts of a message.
PART_OF = {"let reason", "let sentence"}
# Own words up to which a text with two or more gaps says nothing without them.
MAX_BARE_WORDS = 4
# Messages of a row up to which the page shows them unfolded.
MAX_UNFOLDED = 5
# Words that a text needs to be a message and not a part of one, names and numbers of the user included; words without
# those; and marks with which only a part begins.
MIN_WORDS, MIN_OWN_WORDS = 3, 2
PART = (",", ";", ":", "(", " ", ")")


def _program_names() -> dict[str, str]:
    """Options whose name on the command line is not that of their key."""
    source = (ROOT / "crates/funicular-study/src/wording.rs").read_text(encoding="utf-8")
    table = source.partition("const PROGRAM_NAMES")[2].partition(";\n\n")[0]
    return dict(re.findall(r'\("(\w+)", "([^"]+)"\)', table))


NAMES = _program_names()


def _option(key: str) -> str:
    """Option of the command line, as the program shows it in a message."""
    return "…" if "{" in key else NAMES.get(key) or "--" + key.replace("_", "-")


@dataclass(frozen=True)
class Message:
    """Message of the program."""

    text: str
    file: str
    is_help: bool = False
    is_part: bool = False
    example: str = ""
    """The message with names and numbers, if it is written in messages.toml."""

    def shown(self) -> str:
        """Message as the page shows it: what differs from case to case is an ellipsis."""
        text = re.sub(r"⟪([^⟫]*)⟫", lambda found: _option(found[1]), self.text)
        text = re.sub(r"\{\{|\}\}", "'", re.sub(r"(?<!\{)\{[^{}]*\}", "…", text))
        return re.sub(r"\s+", " ", text).strip()


def is_bare(shown: str) -> bool:
    """Whether a text is little more than gaps: its meaning is in what the program puts there."""
    return shown.count("…") > 1 and len(re.findall(r"[a-z]{2,}", re.sub(r"`[^`]*`", " ", shown))) <= MAX_BARE_WORDS


def collected() -> Iterator[Message]:
    """All messages of the sources, in the order of the files."""
    crates = ROOT / "crates"
    for crate in CRATES:
        for path in sorted((crates / crate / "src").rglob("*.rs")):
            file = path.relative_to(crates).as_posix()
            if OUTSIDE.search(file):
                continue
            whole = WHOLE.search(file)
            for text in texts(path.read_text(encoding="utf-8")):
                around = set(text.around)
                if around & INSIDE or not (whole or around & CALLS):
                    continue
                message = Message(text.text, file)
                shown = message.shown()
                own = len(re.findall(r"[a-z]{2,}", shown))
                is_part = shown.startswith(PART) or message.text.startswith(" ")
                if len(shown.split()) >= MIN_WORDS and own >= MIN_OWN_WORDS and not is_part:
                    is_label = "context" in around and "/robot/spec" in file
                    unfinished = bool(PARTS.search(file) or around & PART_OF or is_label or is_bare(shown))
                    yield replace(message, is_help="help" in around, is_part=unfinished)


@dataclass
class Row:
    """Cause and cure of some messages."""

    title: str
    text: re.Pattern[str]
    cause: str
    cure: str
    messages: list[Message] = field(default_factory=list)
    stands_alone: bool = False
    """Whether its messages are written in messages.toml only."""


@dataclass
class Room:
    """Part of the program with its rows."""

    title: str
    about: str
    files: re.Pattern[str]
    rows: list[Row]


def _row(row: dict[str, Any]) -> Row:
    """Row of messages.toml with the messages that are written there, each alone or with an example."""
    pairs = [(one, "") if isinstance(one, str) else one for one in row.get("shown", [])]
    written = [Message(text, "", example=example) for text, example in pairs]
    alone = row.get("stands_alone", False)
    return Row(row["title"], re.compile("(?!)" if alone else row.get("text", "")), row["cause"], row["cure"], written, alone)


def rooms() -> list[Room]:
    """Rooms of messages.toml, with the messages that are written there only."""
    table = tomllib.loads((Path(__file__).parent / "messages.toml").read_text(encoding="utf-8"))
    return [
        Room(
            room["title"], room.get("about", ""), re.compile("|".join(room["files"]) or "(?!)"), [_row(row) for row in room["row"]]
        )
        for room in table["room"]
    ]


def sorted_into_rooms() -> tuple[list[Room], list[str]]:
    """Rooms with their messages, and the faults: messages without a row, rows without a message."""
    made = rooms()
    faults = []
    for message in collected():
        room = next((one for one in made if one.files.search(message.file)), None)
        row = next((one for one in room.rows if one.text.search(message.text)), None) if room else None
        if row is None:
            faults.append(f"{message.file}: a message has no row in docs/site/messages.toml: {message.shown()}")
        elif message.shown() not in [other.shown() for other in row.messages]:
            row.messages.append(message)
    faults += [
        f"docs/site/messages.toml: the row \"{row.title}\" of \"{room.title}\" has no message: remove it"
        for room in made for row in room.rows if not (row.stands_alone or any(message.file for message in row.messages))
    ]
    return made, faults


# Box into which a reader pastes a message; static/messages.js fills it with life, and without it the page is complete.
FILTER = """```{raw} html
<div class="message-filter" hidden>
<label for="message">Paste a message, or type some of its words:</label>
<textarea id="message" spellcheck="false" placeholder="error: `mass_kg` is 0, it must be positive"></textarea>
<div role="status"></div>
<div class="message-answers"></div>
</div>
<script src="../_static/messages.js" defer></script>
```"""


def _listed(messages: list[Message]) -> str:
    """List of messages; an example stands behind its message."""
    return "\n".join(
        f"- `` {one.shown()} ``" + (f" – for example `` {one.example} ``" if one.example else "") for one in messages
    )


def _folded(title: str, listed: str, kind: str) -> str:
    return f"<details class=\"{kind}\"><summary>{title}</summary>\n\n{listed}\n\n</details>"


def _lists(row: Row) -> list[str]:
    """Messages of a row, and below them lines of help and parts, folded."""
    whole = [one for one in row.messages if not (one.is_help or one.is_part)]
    helps = [one for one in row.messages if one.is_help]
    parts = [one for one in row.messages if one.is_part and not one.is_help]
    out = []
    if whole:
        out.append(_listed(whole) if len(whole) <= MAX_UNFOLDED else _folded(f"{len(whole)} messages", _listed(whole), "messages"))
    if helps:
        out.append(_folded("Lines after <code>help:</code>", _listed(helps), "helps"))
    if parts:
        out.append(_folded("Parts of these messages", _listed(parts), "parts"))
    return out


def page() -> str:
    """Page of all messages; refuses faults."""
    made, faults = sorted_into_rooms()
    if faults:
        raise RuntimeError("\n".join(faults))
    count = sum(not (one.is_help or one.is_part) for room in made for row in room.rows for one in row.messages)
    out = [
        "# Messages: cause and cure",
        FILTER,
        f"Every refusal and warning of the program, {count} in all, read from its sources. `…` stands for your names and "
        "numbers. Options are as on the command line; in Python and JSON `--mass-kg` is `mass_kg`.",
        "A message names the place, the value, the limit and what to do. This page adds the reason and the usual cure. "
        "Exit code 2: the input has to change. Exit code 1: the input is right, but there is no such solution.",
    ]
    for room in made:
        out += [f"## {room.title}", room.about]
        for row in room.rows:
            out += [f"### {row.title}", f"**Cause.** {row.cause}", f"**Cure.** {row.cure}", *_lists(row)]
    return "\n\n".join(part for part in out if part) + "\n"
