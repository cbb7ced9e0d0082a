"""Reads the texts in quotes of a Rust source, with the macros and calls around each."""

import re
from collections.abc import Iterator
from dataclasses import dataclass

_TOKEN = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)
      | (?P<raw>b?r(?P<hashes>\#*)"(?P<raw_text>.*?)"(?P=hashes))
      | (?P<text>b?"(?P<inner>(?:\\.|[^"\\])*)")
      | (?P<char>b?'(?:\\(?:u\{[0-9a-fA-F]+\}|x[0-9a-fA-F]{2}|.)|[^'\\\n])')
      | (?P<lifetime>'[a-zA-Z_]\w*)
      | (?P<name>[A-Za-z_]\w*!?)
      | (?P<open>[(\[{])
      | (?P<close>[)\]}])
      | (?P<other>\S)""",
    re.VERBOSE | re.DOTALL,
)
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "0": "\0", "\\": "\\", '"': '"', "'": "'"}


@dataclass(frozen=True)
class Text:
    """Text in quotes."""

    text: str
    line: int
    around: tuple[str, ...]
    """Names before the open brackets, the outermost first: of macros, calls, types, functions; `let NAME` if
    the text is part of the value of a variable."""


def _plain(inner: str) -> str:
    """Text that the escapes of a literal mean."""
    inner = re.sub(r"\\\n\s*", "", inner)
    inner = re.sub(r"\\u\{([0-9a-fA-F]+)\}", lambda found: chr(int(found[1], 16)), inner)
    return re.sub(r"\\(.)", lambda found: _ESCAPES.get(found[1], found[1]), inner)


def texts(source: str) -> Iterator[Text]:
    """All texts of a source outside `#[cfg(test)]`."""
    source = re.sub(r"#\[cfg\(test\)\]\s*(pub\(crate\) )?mod \w+ \{.*?\n\}\n", "\n", source, flags=re.DOTALL)
    stack: list[str] = []
    before = ""
    # The variables whose values are being written, each with the number of open brackets at its `let`.
    bound: list[tuple[str, int]] = []
    for token in _TOKEN.finditer(source):
        if token["comment"]:
            continue
        if token["raw"] or token["text"]:
            text = token["raw_text"] if token["raw"] else _plain(token["inner"])
            line = source.count("\n", 0, token.start()) + 1
            yield Text(text, line, (*stack, *(f"let {name}" for name, _ in bound)))
            before = ""
        elif token["open"]:
            stack.append(before)
            before = ""
        elif token["close"]:
            if stack:
                stack.pop()
            bound = [one for one in bound if one[1] <= len(stack)]
            before = ""
        elif token["name"]:
            if before in ("let", "let mut") and token["name"] != "mut":
                bound.append((token["name"], len(stack)))
            before = "let mut" if before == "let" and token["name"] == "mut" else token["name"]
        elif token[0] == ";":
            bound = [one for one in bound if one[1] < len(stack)]
            before = ""
        elif token[0] not in ":<>&'":
            before = token[0] if token[0] == "#" else ""
