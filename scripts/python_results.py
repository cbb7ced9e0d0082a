"""Classes of results of the Python package, from the declarations: prints `funicular/results.py`.

Reads the JSON Schema of results from the installed package, or from the file that is named:
`funicular schema --of results -o FILE`.
"""

import json
import keyword
import sys
import textwrap
from pathlib import Path
from typing import Any

HEAD = '''"""Results of every command: dictionaries with the keys of the program's JSON, which are attributes as well.

`found["rows"]` and `found.rows` are the same. An attribute is None if the results do not have the key. Lists of numbers are
arrays; lists of different lengths, and empty ones, stay lists. The keys `values` and `from` are read as
`found["values"]`: a dictionary has a method of this name, and Python a word.

Made by scripts/python_results.py from the declarations of the commands.
"""

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from funicular._results import OF_COMMANDS, Results, Row
'''

# Columns of the text of documentation.
WIDTH = 116

# Names that every dictionary has.
TAKEN = frozenset(dir(dict))


class Classes:
    """Classes of objects, those of parts before those of the whole."""

    def __init__(self) -> None:
        self.texts: dict[str, str] = {}
        self.names: dict[str, str] = {}

    def name_of(self, schema: dict[str, Any], *, whole: str) -> str:
        """Name of the class of an object; the class is made if it is new."""
        key = json.dumps({word: value for word, value in schema.items() if word not in ("description", "$comment", "unit")})
        if key not in self.names:
            name = schema["title"]
            # Structs of two modules may share their name.
            self.names[key] = name if name not in self.names.values() else f"{whole}{name}"
            about = schema.get("$comment") or schema.get("description") or schema["title"]
            self.texts[self.names[key]] = self.text(self.names[key], "Row", schema, about.partition("\n\n")[0])
        return self.names[key]

    def text(self, name: str, base: str, schema: dict[str, Any], about: str) -> str:
        """Text of a class with its attributes, units and meanings."""
        required, parts, lines = set(schema["required"]), {}, []
        for key, of_key in schema["properties"].items():
            kind, part = self.kind(of_key, name)
            if part is not None:
                parts[key] = part
            if key in TAKEN or keyword.iskeyword(key) or key in ("schema", "command"):
                continue
            lines += [f"    {key}: {kind}{'' if key in required else ' | None'}", documented(key, of_key)]
        listed = "".join(f'\n        "{key}": {part},' for key, part in parts.items())
        lines += ["", f"    _PARTS: ClassVar[dict[str, type[Row]]] = {{{listed}\n    }}"] if parts else []
        text = textwrap.indent(textwrap.fill(f'"""{about.rstrip(".")}."""', WIDTH), "    ")
        return f"class {name}({base}):\n{text}\n\n" + "\n".join(lines or ["    pass"]) + "\n"

    def kind(self, schema: dict[str, Any], whole: str) -> tuple[str, str | None]:
        """Annotation of a value, and the class of the objects in it."""
        match schema.get("type"):
            case "object" if schema.get("properties", {}).keys() == {"real", "imag"}:
                return "NDArray[np.complex128]", None
            case "object" if "title" in schema:
                name = self.name_of(schema, whole=whole)
                return name, name
            case "object" if isinstance(schema.get("additionalProperties"), dict):
                return f"dict[str, {self.kind(schema['additionalProperties'], whole)[0]}]", None
            case "array" if (inner := of_numbers(schema)) is not None:
                return f"NDArray[np.{inner}]", None
            case "array":
                kind, part = self.kind(schema["items"], whole)
                return f"list[{kind}]", part
            case of:
                return {"number": "float", "integer": "int", "string": "str", "boolean": "bool"}.get(str(of), "Any"), None


def of_numbers(schema: dict[str, Any]) -> str | None:
    """Type of the numbers in an array of arrays of them; none for other arrays."""
    inner = schema
    while inner.get("type") == "array":
        inner = inner["items"]
    return {"number": "float64", "integer": "int64"}.get(str(inner.get("type")))


def documented(key: str, schema: dict[str, Any]) -> str:
    """Docstring of an attribute: its meaning with the unit."""
    unit = schema.get("unit", "")
    name = key[: -len(ending(key))] if unit and ending(key) else key
    about = schema.get("description") or name.replace("_", " ").strip().capitalize()
    first, *rest = about.split("\n\n")
    first = f"{first.rstrip('.')} [{unit}]." if unit and "[" not in first else f"{first.rstrip('.')}."
    paragraphs = [textwrap.fill(text, WIDTH) for text in (first, *rest)]
    return textwrap.indent(f'"""{chr(10).join([paragraphs[0], *(chr(10) + text for text in paragraphs[1:])])}"""', "    ")


def ending(key: str) -> str:
    """End of a key that is its unit: what follows the last word that is none."""
    words, units = key.split("_"), {"m", "mm", "m2", "m3", "s", "s2", "s3", "n", "w", "j", "hz", "kg", "deg", "rad", "pa", "db", "per", "percent"}
    count = 0
    while count < len(words) - 1 and words[-1 - count] in units:
        count += 1
    return "".join(f"_{word}" for word in words[len(words) - count :])


def made(schema: dict[str, Any]) -> str:
    """Module with the classes of all commands."""
    classes, of_commands, wholes = Classes(), {}, []
    for command, of in schema["$defs"].items():
        # Results of several forms have classes of their own in the package.
        if "oneOf" not in of:
            name = f"{command.title().replace('-', '')}Results"
            wholes.append(classes.text(name, "Results", of, f"Results of `{command}`."))
            of_commands[command] = name
    indented = "".join(f'        "{command}": {name},\n' for command, name in of_commands.items())
    table = f"# Class of the results of each command.\nOF_COMMANDS.update(\n    {{\n{indented}    }}\n)\n"
    return "\n\n".join([HEAD, *classes.texts.values(), *wholes, table])


if __name__ == "__main__":
    if len(sys.argv) > 1:
        of_results = json.loads(Path(sys.argv[1]).read_text())
    else:
        import funicular

        of_results = funicular.schema("results")
    print(made(of_results), end="")
