#!/usr/bin/env python3
"""Writes codemeta.json and .zenodo.json from CITATION.cff and the descriptions of the crates, so that one file is kept
by hand. With `--check` it writes nothing and fails if they differ from it; both need ruamel.yaml. With `--publish` it
fails while places that only the authors can fill are open: names, affiliations, date, DOI, how the work was made.

Usage: scripts/citation.py [--check | --publish]"""

import json
import sys
import tomllib
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
# Beginning of a place that only the authors can fill.
MARK = "FILL IN:"
SPDX = "https://spdx.org/licenses/"


def persons(authors: list[dict[str, str]]) -> list[dict[str, str]]:
    """Authors as CodeMeta has them: persons with both names, or organisations."""
    made = []
    for author in authors:
        if "name" in author:
            made.append({"@type": "Organization", "name": author["name"]})
            continue
        person = {"@type": "Person", "givenName": author["given-names"], "familyName": author["family-names"]}
        if "orcid" in author:
            person["@id"] = author["orcid"]
        if "affiliation" in author:
            person["affiliation"] = author["affiliation"]
        made.append(person)
    return made


def creators(authors: list[dict[str, str]]) -> list[dict[str, str]]:
    """Authors as Zenodo has them."""
    made = []
    for author in authors:
        name = author.get("name") or f"{author['family-names']}, {author['given-names']}"
        creator = {"name": name}
        if "affiliation" in author:
            creator["affiliation"] = author["affiliation"]
        if "orcid" in author:
            creator["orcid"] = author["orcid"].rsplit("/", 1)[-1]
        made.append(creator)
    return made


def codemeta(cff: dict[str, Any], package: dict[str, Any]) -> dict[str, Any]:
    """Content of codemeta.json, CodeMeta 3.0."""
    licences = cff["license"] if isinstance(cff["license"], list) else [cff["license"]]
    made: dict[str, Any] = {
        "@context": "https://w3id.org/codemeta/3.0",
        "@type": "SoftwareSourceCode",
        "name": cff["title"].partition(":")[0],
        "description": cff["abstract"].strip(),
        "version": str(cff["version"]),
        "license": [f"{SPDX}{name}" for name in licences],
        "codeRepository": cff["repository-code"],
        "issueTracker": f"{cff['repository-code']}/issues",
        "readme": f"{cff['repository-code']}/blob/main/README.md",
        "programmingLanguage": ["Rust", "Python"],
        "runtimePlatform": f"Rust {package['rust-version']}",
        "keywords": list(cff["keywords"]),
        "author": persons(cff["authors"]),
        "developmentStatus": "active",
    }
    if "date-released" in cff:
        made["datePublished"] = str(cff["date-released"])
    if "doi" in cff:
        made["identifier"] = f"https://doi.org/{cff['doi']}"
    return made


def zenodo(cff: dict[str, Any]) -> dict[str, Any]:
    """Content of .zenodo.json. Zenodo takes one licence: the first, and the description names all."""
    licences = cff["license"] if isinstance(cff["license"], list) else [cff["license"]]
    return {
        "title": cff["title"],
        "description": f"{cff['abstract'].strip()} Licence: {' or '.join(licences)}, as you like.",
        "upload_type": "software",
        "access_right": "open",
        "version": str(cff["version"]),
        "license": licences[0].lower(),
        "keywords": list(cff["keywords"]),
        "creators": creators(cff["authors"]),
    }


def texts() -> dict[str, str]:
    """Texts of both files by name."""
    from ruamel.yaml import YAML

    cff: dict[str, Any] = YAML(typ="safe").load(ROOT / "CITATION.cff")
    package = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))["workspace"]["package"]
    if str(cff["version"]) != package["version"]:
        raise SystemExit(f"CITATION.cff has version {cff['version']}, Cargo.toml {package['version']}")
    made = {"codemeta.json": codemeta(cff, package), ".zenodo.json": zenodo(cff)}
    return {name: json.dumps(of, indent=2, ensure_ascii=False) + "\n" for name, of in made.items()}


def open_places(paper: str, cff: str) -> list[str]:
    """Places that only the authors can fill, one line each."""
    lines = enumerate(paper.splitlines(), start=1)
    found = [f"paper/paper.md:{number}: {line.strip()}" for number, line in lines if MARK in line]
    for key in ("date-released", "doi"):
        if not any(line.startswith(f"{key}:") for line in cff.splitlines()):
            found.append(f"CITATION.cff: there is no `{key}`")
    if "family-names" not in cff.partition("authors:")[2].partition("repository-code:")[0]:
        found.append("CITATION.cff: `authors` has no person")
    return found


def main() -> int:
    """Writes or checks the files; returns 1 if one of them differs, or if a place is open."""
    if sys.argv[1:] == ["--publish"]:
        found = open_places(*[(ROOT / name).read_text(encoding="utf-8") for name in ("paper/paper.md", "CITATION.cff")])
        if found:
            print("places that only the authors can fill are open:", *found, sep="\n  ", file=sys.stderr)
        return int(bool(found))
    if sys.argv[1:] not in ([], ["--check"]):
        print((__doc__ or "").split("\n\n")[1], file=sys.stderr)
        return 2
    differ = []
    for name, text in texts().items():
        path = ROOT / name
        if path.is_file() and path.read_text(encoding="utf-8") == text:
            continue
        differ.append(name)
        if not sys.argv[1:]:
            path.write_text(text, encoding="utf-8")
    if sys.argv[1:] and differ:
        print(f"{' and '.join(differ)} differ from CITATION.cff: run scripts/citation.py", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
