"""Page of all messages: the refusals and warnings are read from the sources, cause and cure from messages.toml.

A text of the sources counts as a message by the macro, call or attribute around it. A message without a row of
messages.toml is an error, and so is a row without a message."""

import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from pages import ROOT
from rust_texts import texts

CRATES = ["funicular", "funicular-study", "funicular-files", "funicular-cli", "funicular-py"]
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
# The reference numbers and the tests have no messages for users.
OUTSIDE = re.compile(r"/validation|tests\.rs$|/tests/")
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

    def shown(self) -> str:
        """Message as the page shows it: what differs from case to case is an ellipsis."""
        text = re.sub(r"⟪([^⟫]*)⟫", lambda found: _option(found[1]), self.text)
        text = re.sub(r"\{\{|\}\}", "'", re.sub(r"(?<!\{)\{[^{}]*\}", "…", text))
        return re.sub(r"\s+", " ", text).strip()


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
                    yield message


@dataclass
class Row:
    """Cause and cure of some messages."""

    title: str
    text: re.Pattern[str]
    cause: str
    cure: str
    messages: list[Message]


@dataclass
class Room:
    """Part of the program with its rows."""

    title: str
    about: str
    files: re.Pattern[str]
    rows: list[Row]


def rooms() -> list[Room]:
    """Rooms of messages.toml, without their messages."""
    table = tomllib.loads((Path(__file__).parent / "messages.toml").read_text(encoding="utf-8"))
    return [
        Room(
            room["title"], room.get("about", ""), re.compile("|".join(room["files"])),
            [Row(row["title"], re.compile(row.get("text", "")), row["cause"], row["cure"], []) for row in room["row"]],
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
        for room in made for row in room.rows if not row.messages
    ]
    return made, faults


def page() -> str:
    """Page of all messages; refuses faults."""
    made, faults = sorted_into_rooms()
    if faults:
        raise RuntimeError("\n".join(faults))
    count = sum(len(row.messages) for room in made for row in room.rows)
    out = [
        "# Messages: cause and cure",
        f"Every refusal and warning of the program, {count} in all, read from its sources. `…` stands for your names and "
        "numbers; options are as on the command line, and in Python and JSON `--mass-kg` is `mass_kg`. Type three or four words of a message into the search, or into the search of your browser (Ctrl-F).",
        "A message names the place, the value, the limit and what to do. This page says in addition why the "
        "program refuses, and what usually helps. "
        "Exit code 2: the input has to change. Exit code 1: the input is right, but there is no such solution.",
    ]
    for room in made:
        out += [f"## {room.title}", room.about]
        for row in room.rows:
            listed = "\n".join(f"- `` {message.shown()} ``" for message in row.messages)
            out += [f"### {row.title}", f"**Cause.** {row.cause}", f"**Cure.** {row.cure}", listed]
    return "\n\n".join(part for part in out if part) + "\n"
