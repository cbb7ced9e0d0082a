#!/usr/bin/env python3
"""Writes the licences of the crates that are linked into a package of the workspace, as their authors require with
every copy. Fails if a crate has a licence that deny.toml does not allow.

Usage: scripts/third_party.py PACKAGE TARGET OUTPUT [NAME=LICENCE-FILE …]

NAME=LICENCE-FILE adds a part that is not a crate, such as the compiler's own library."""

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any, NoReturn

# A crate, as `cargo metadata` describes it.
Crate = dict[str, Any]

ROOT = Path(__file__).resolve().parent.parent

# Licences that deny.toml allows. Of several that a crate offers, the first of this list is used. The word marks the crate's
# file with the text.
WORDS = {"BSD-2-Clause": "BSD", "BSD-3-Clause": "BSD", "Apache-2.0": "APACHE", "Unicode-3.0": "UNICODE"}
ACCEPTED = {
    name: WORDS.get(name, name.upper())
    for name in tomllib.loads((ROOT / "deny.toml").read_text())["licenses"]["allow"]
}
TEXTS = re.compile(r"LICEN[CS]E|COPYING", re.IGNORECASE)
# Apache-2.0 requires the notices; COPYRIGHT says which licence holds for which part.
NOTICES = re.compile(r"(NOTICE|COPYRIGHT)(\.\w+)?", re.IGNORECASE)
OTHER_WORDS = re.compile("|".join({*ACCEPTED.values(), "BOOST"}))


def fail(text: str) -> NoReturn:
    """Ends the script with a message."""
    print(f"third_party.py: {text}", file=sys.stderr)
    sys.exit(1)


def chosen(expression: str) -> set[str] | None:
    """Licences that hold for a crate: the first accepted one of every `OR`, all of every `AND`. None if none is accepted."""
    tokens = re.findall(r"[()]|[^\s()]+", expression.replace("/", " OR ").replace(" WITH ", "+"))

    def alternatives() -> set[str] | None:
        found = [requirements()]
        while tokens and tokens[0] == "OR":
            tokens.pop(0)
            found.append(requirements())
        usable = [licences for licences in found if licences is not None]
        order = list(ACCEPTED)
        return min(usable, key=lambda licences: max(map(order.index, licences))) if usable else None

    def requirements() -> set[str] | None:
        found = [atom()]
        while tokens and tokens[0] == "AND":
            tokens.pop(0)
            found.append(atom())
        return None if None in found else {name for licences in found for name in licences or ()}

    def atom() -> set[str] | None:
        token = tokens.pop(0)
        if token == "(":
            inside = alternatives()
            tokens.pop(0)
            return inside
        return {token} if token in ACCEPTED else None

    licences = alternatives()
    return None if tokens else licences


def linked(metadata: dict[str, Any], package: str) -> list[Crate]:
    """Crates of other authors that are linked into a package, or put into it by its build scripts, as plotly.js is."""
    crates = {crate["id"]: crate for crate in metadata["packages"]}
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    own = set(metadata["workspace_members"])
    waiting = [key for key in own if crates[key]["name"] == package] or fail(f"no crate {package} in the workspace")
    seen = set(waiting)
    while waiting:
        key = waiting.pop()
        for dependency in nodes[key]["deps"]:
            kinds = {kind["kind"] for kind in dependency["dep_kinds"]}
            used = None in kinds or (key in own and "build" in kinds)
            macro = any("proc-macro" in part["kind"] for part in crates[dependency["pkg"]]["targets"])
            if used and not macro and dependency["pkg"] not in seen:
                seen.add(dependency["pkg"])
                # Requirements of build scripts are not part of the program.
                if None in kinds:
                    waiting.append(dependency["pkg"])
    return sorted((crates[key] for key in seen - own), key=lambda crate: (crate["name"], crate["version"]))


def texts(crate: Crate) -> list[str]:
    """Licence texts and notices of a crate; the standard text if its package has none."""
    name = f"{crate['name']} {crate['version']}"
    folder = Path(crate["manifest_path"]).parent
    files = sorted(path for path in folder.iterdir() if path.is_file())
    licensed = [path for path in files if TEXTS.search(path.name)]
    plain = [path for path in licensed if not OTHER_WORDS.search(path.name.upper())]

    found = [path.read_text() for path in files if NOTICES.fullmatch(path.name)]
    licences = chosen(crate["license"] or "none")
    if licences is None:
        fail(f"{name} has the licence {crate['license']!r}: check whether it may be distributed, then add it to deny.toml")
    for licence in sorted(licences):
        named = [path for path in licensed if ACCEPTED[licence] in path.name.upper()]
        found += [path.read_text() for path in named or plain] or [standard(licence, crate, name)]
    # A script that the crate brings along names its authors at its beginning.
    for script in sorted((folder / "resource").glob("plotly*.js")):
        found.append(script.read_text().split("*/")[0] + "*/")
    return found


def standard(licence: str, crate: Crate, name: str) -> str:
    """Text of a licence for a crate whose package has no file with it."""
    if licence == "Apache-2.0":
        return (ROOT / "LICENSE-APACHE").read_text()
    if licence == "MIT":
        authors = ", ".join(re.sub(r"\s*<.*?>", "", author) for author in crate["authors"])
        return mit(authors or f"the authors of {crate['name']}")
    fail(f"{name} has no file with the text of its licence {licence}")


def mit(holder: str) -> str:
    """MIT licence of a holder of copyright."""
    return re.sub(r"(?m)^Copyright.*$", f"Copyright (c) {holder}", (ROOT / "LICENSE-MIT").read_text())


def main() -> int:
    """Writes the file; every text appears once, below the names of the parts that it belongs to."""
    if len(sys.argv) < 4:
        print((__doc__ or "").split("\n\n")[1], file=sys.stderr)
        return 2
    package, target, output = sys.argv[1:4]
    line = ["cargo", "metadata", "--locked", "--format-version", "1", "--filter-platform", target]
    done = subprocess.run(line, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        return 1

    crates = linked(json.loads(done.stdout), package)
    parts = [(f"{crate['name']} {crate['version']}, {crate['license']}", texts(crate)) for crate in crates]
    parts.append(("The Rust standard library, MIT OR Apache-2.0", [mit("The Rust Project contributors")]))
    for word in sys.argv[4:]:
        name, _, path = word.partition("=")
        parts.append((name, [Path(path).read_text()]))

    holders: dict[str, tuple[str, list[str]]] = {}
    for name, found in parts:
        for text in found:
            holders.setdefault(" ".join(text.split()), (text.strip("\n"), []))[1].append(name)

    rule = "=" * 100
    with Path(output).open("w") as file:
        print("Licences of the parts by other authors in this copy of funicular. A part is named above each text", file=file)
        print("that holds for it.", file=file)
        for text, names in holders.values():
            print(f"\n{rule}\n" + "\n".join(dict.fromkeys(names)) + f"\n{rule}\n\n{text}", file=file)
    print(f"{len(parts)} parts, {len(holders)} texts")
    return 0


if __name__ == "__main__":
    sys.exit(main())
