"""Reference pages of the commands, made from what the program says: schema of requests, help, and columns of its tables."""

import csv
import io
import json
import os
import re
import subprocess
import tempfile
from pathlib import Path
from typing import Any

from pages import ROOT

# Largest number of the program: a range up to it is no range for a reader.
ANY = 1e12


def run(program: str, *words: str) -> str:
    """Output of a run of the program in the folder of the repository."""
    done = subprocess.run([program, *words], cwd=ROOT, capture_output=True, text=True, encoding="utf-8", check=False)
    if done.returncode != 0:
        raise RuntimeError(f"funicular {' '.join(words)}: {done.stderr}")
    return done.stdout


def cell(text: str) -> str:
    """Text as one cell of a table."""
    return re.sub(r"\s+", " ", text).replace("|", "\\|").replace("<", "\\<").strip()


def values(schema: Any) -> str:
    """Values that a schema allows, in words."""
    if not isinstance(schema, dict):
        return "any"
    if isinstance(schema.get("items"), bool):
        return ", ".join(values(one) for one in schema.get("prefixItems", [])) or "list"
    if "anyOf" in schema:
        return ", or ".join(dict.fromkeys(values(one) for one in schema["anyOf"]))
    if "enum" in schema:
        return ", ".join(f"`{word}`" for word in schema["enum"])
    kind = schema.get("type", "any")
    if kind == "array":
        low, high = schema.get("minItems"), schema.get("maxItems")
        number = f"{low} " if low is not None and low == high else ""
        return f"{number}× {values(schema.get('items', {}))}" if number else f"list of: {values(schema.get('items', {}))}"
    if kind == "object":
        return "object of " + ", ".join(f"`{key}`" for key in schema.get("properties", {}))
    if kind in ("number", "integer"):
        low, high = schema.get("minimum"), schema.get("maximum")
        positive = low is not None and 0 < low < 1e-9
        low_text = "positive" if positive else f"from {low:g}" if low is not None and low > -ANY else ""
        high_text = f"up to {high:g}" if high is not None and high < ANY else ""
        return " ".join(word for word in (kind, low_text, high_text) if word)
    return {"string": "text", "boolean": "true or false"}.get(kind, str(kind))


def _default(schema: dict[str, Any]) -> str:
    value = schema.get("default")
    return "" if value in (None, [], {}) else f"`{json.dumps(value)}`"


def options(command: dict[str, Any]) -> str:
    """Table of the options of a command."""
    needed = set(command.get("required", []))
    rows = ["| Key | Values | Default | Meaning |", "|---|---|---|---|"]
    for key, schema in command["properties"].items():
        if key in ("command", "schema"):
            continue
        default = "required" if key in needed else _default(schema)
        rows.append(f"| `{key}` | {cell(values(schema))} | {default} | {cell(schema.get('description', ''))} |")
    return "\n".join(rows)


def examples() -> dict[str, str]:
    """Example of each command, from the table of docs/commands.md."""
    text = (ROOT / "docs/commands.md").read_text(encoding="utf-8")
    return dict(re.findall(r"^\| `([a-z-]+)` \|.*\| `funicular (.*)` \|$", text, re.MULTILINE))


def columns(program: str, line: str) -> list[str]:
    """Columns that a command prints as CSV; none if it prints no table."""
    words = line.split(" ")
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            [program, *words, "--format", "csv", "-o", f"{folder}/table.csv"],
            cwd=ROOT, capture_output=True, text=True, check=False, env={**os.environ, "COLUMNS": "100"},
        )
        table = Path(folder) / "table.csv"
        if done.returncode != 0 or not table.is_file():
            return []
        lines = table.read_text(encoding="utf-8").splitlines()
    return next(csv.reader(io.StringIO(lines[0]))) if lines else []


def _without_paths(text: str, program: str) -> str:
    """Help of the program under its own name, whatever the file is called."""
    return text.replace(Path(program).name, "funicular")


def pages(program: str) -> dict[str, str]:
    """A page for every command, and the page that lists them."""
    schema = json.loads(run(program, "schema", "--of", "request"))
    of_schema = {one["properties"]["command"]["const"]: one for one in schema["oneOf"]}
    made = {}
    listed = []
    for name, example in examples().items():
        command = of_schema.get(name)
        help_text = _without_paths(run(program, "help", name), program)
        first = help_text.split("\n\nUsage:", 1)[0].strip()
        summary = first.split("\n\n", 1)[0].replace("\n", " ")
        parts = [f"# `{name}`", first, "## Example", f"```sh\nfunicular {example}\n```"]
        if command:
            parts += [
                "## Options",
                "The keys are those of a request in JSON and of Python. On the command line a key is an option with "
                "`-` in place of `_`: `mass_kg` is `--mass-kg`.",
                options(command),
            ]
        found = columns(program, example) if command else []
        if found:
            parts += ["## Columns", "`--format csv` prints these columns for the example:", ", ".join(f"`{one}`" for one in found)]
        parts += ["## Help", f"```text\n{help_text.rstrip()}\n```"]
        made[f"reference/commands/{name}.md"] = "\n\n".join(parts) + "\n"
        listed.append(f"| [`{name}`]({name}.md) | {cell(summary)} |")
    toctree = "\n".join(examples())
    made["reference/commands/index.md"] = (
        "# Options of every command\n\nThe program writes these pages about itself: "
        "every option with its values, its default and its meaning. [Commands](../../commands.md) is the page to read first.\n\n"
        "A request in JSON is one object: `command`, `robot` as an object with the `name` and `text` of the file, and the keys of the tables. "
        "`--print-request` prints it for any command line, and `funicular request FILE.json` runs it. "
        "`funicular schema --of request` is its JSON Schema.\n\n"
        "| Command | |\n|---|---|\n" + "\n".join(listed) + f"\n\n```{{toctree}}\n:hidden:\n\n{toctree}\n```\n"
    )
    return made


def measures() -> str:
    """Page of everything that a map or sweep can compute, and of the statuses of its rows."""
    text = (ROOT / "docs/sweeps.md").read_text(encoding="utf-8")
    found = re.search(r"^\| `--quantity` \| Columns \|\n(?:\|.*\n)+", text, re.MULTILINE)
    if not found:
        raise RuntimeError("docs/sweeps.md has no table of quantities")
    source = (ROOT / "crates/funicular-study/src/sweep/status.rs").read_text(encoding="utf-8")
    table = source.partition("pub const CODES")[2].partition("];\n")[0]
    codes = re.findall(r'\(\s*"([a-z-]+)",\s*"((?:[^"\\]|\\.|\\\n)*)",?\s*\)', table)
    if len(codes) < 10:
        raise RuntimeError("sweep/status.rs has no codes of the expected form")
    joined = [(code, re.sub(r"\\\n\s*", "", meaning)) for code, meaning in codes]
    rows = [f"| `{code}` | {cell(meaning)} |" for code, meaning in joined]
    return (
        "# Quantities, columns and statuses of maps\n\n`map` and `sweep` compute these quantities. "
        "[Maps and sweeps](../sweeps.md) explains how.\n\n## Quantities\n\n" + found[0]
        + "\n## Statuses\n\nThe column `status` of each row says why numbers are missing. "
        "The column `reason` says it in a sentence.\n\n| `status` | Meaning |\n|---|---|\n" + "\n".join(rows) + "\n"
    )
