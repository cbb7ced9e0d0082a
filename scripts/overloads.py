"""Overloads in the types of the Python package: `adaptive` decides between two types of a result.

PyO3 declares one type per function. A function with the keyword `adaptive: bool = False` and the type `A | B` of its
result becomes three overloads: `A` for False, `B` for True, and `A | B` for a value that is known only at run time.
"""

import re
import sys
from pathlib import Path

FUNCTION = re.compile(r"^( *)def (?P<head>.*)adaptive: bool = False(?P<tail>.*) -> (?P<plain>.*?) \| (?P<chosen>.*):$", re.MULTILINE)


def overloads(function: re.Match[str]) -> str:
    indent, head, tail, plain, chosen = function.groups()
    # The text of documentation stays with the last overload.
    of = [("adaptive: Literal[False] = False", plain), ("adaptive: Literal[True]", chosen)]
    lines = [f"{indent}@overload\n{indent}def {head}{adaptive}{tail} -> {result}: ...\n" for adaptive, result in of]
    return "".join(lines) + f"{indent}@overload\n{indent}def {head}adaptive: bool{tail} -> {plain} | {chosen}:"


for path in map(Path, sys.argv[1:]):
    text, count = FUNCTION.subn(overloads, path.read_text())
    names = "Literal, overload"
    if count:
        text, imported = re.subn(r"^from typing import (.*)$", rf"from typing import \1, {names}", text, count=1, flags=re.MULTILINE)
        assert imported == 1, "the types import nothing from typing"
    path.write_text(text)
