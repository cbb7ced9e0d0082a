"""Types of the Python package that PyO3 does not declare: overloads and words.

`adaptive` decides between two types of a result, and PyO3 declares one type per function. A function with the keyword `adaptive: bool = False` and the type `A | B` of its
result becomes three overloads: `A` for False, `B` for True, and `A | B` for a value that is known only at run time.

An argument that is one of a few words has their type of `funicular._words` instead of `str`, so that type checkers find
a word that there is not. An argument of any type that is read as a number or an array has that type.
"""

import re
import sys
from pathlib import Path

FUNCTION = re.compile(r"^( *)def (?P<head>.*)adaptive: bool = False(?P<tail>.*) -> (?P<plain>.*?) \| (?P<chosen>.*):$", re.MULTILINE)


# Arguments by their names, with the types of funicular._words.
WORDS = {
    "static_model": "StaticModel",
    "tension_rule": "TensionRule",
    "cable_model": "CableModel",
    "assembly": "Assembly",
    "winches": "Winches",
    "hold": "Hold",
    "per": "Per",
    "method": "Method",
    "goal": "Goal",
    "to": "ExportFormat",
}
LISTS = {"of": "Result"}
OTHERS = {"pose": "Pose | ArrayLike", "profile": "str | Sequence[str]"}
ARRAYS = ("poses", "lengths_m", "force_n", "moment_n_m", "load_point_m", "wind_m_s", "cable_load_n_per_m")
ARRAYS += ("target_tension_n", "weights", "avoid_hz")
NUMBERS = ("mass_kg", "min_tension_n", "max_tension_n", "min_frequency_hz", "min_stiffness_n_per_m", "from_hz", "to_hz")
NUMBERS += ("response_noise", "frequency_noise", "damping_noise")
COUNTS = ("starts", "max_iterations")


def words(text: str) -> str:
    """Types of the arguments that are words, lists of words, arrays, numbers or counts."""
    used = set()

    def of_word(argument: re.Match[str]) -> str:
        name, kind = argument.groups()
        if name in WORDS and kind == "str":
            used.add(WORDS[name])
            return f"{name}: {WORDS[name]}"
        if name in LISTS and kind == "str | Sequence[str]":
            used.add(LISTS[name])
            return f"{name}: {LISTS[name]} | Sequence[{LISTS[name]}]"
        if kind == "Any" and name in OTHERS:
            return f"{name}: {OTHERS[name]}"
        if kind == "Any":
            for names, other in ((ARRAYS, "ArrayLike"), (NUMBERS, "SupportsFloat | SupportsIndex"), (COUNTS, "SupportsIndex")):
                if name in names:
                    return f"{name}: {other}"
        return argument[0]

    text = re.sub(r"\b(\w+): (str \| Sequence\[str\]|str\b|Any\b)", of_word, text)
    return text.replace("from numpy import", f"from funicular._words import {', '.join(sorted(used))}\nfrom numpy import", 1)


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
    path.write_text(words(text))
