#!/usr/bin/env python3
"""Checks what the files of a release contain. A wheel and a source distribution: every file of the Python package,
licences and types, a complete description, and nothing else. The archive of the program: licences, robots, completions
of three shells, and a page of the manual for each command that the program declares.

Usage: scripts/release_contents.py package VERSION PLATFORM WHEEL SDIST
       scripts/release_contents.py program VERSION ARCHIVE"""

import email.message
import email.parser
import re
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "crates/funicular-py"
LICENCES = {"LICENSE-MIT", "LICENSE-APACHE"}
# Headings of the description, and the least number of each.
WANTED = {"Summary": 1, "Keywords": 1, "License-Expression": 1, "Requires-Python": 1, "Classifier": 4, "Project-URL": 3}
# Files of a source distribution, apart from those of the Python package.
SOURCES = re.compile(
    r"PKG-INFO|Cargo\.(toml|lock)|pyproject\.toml|README\.md|LICENSE-\w+"
    r"|(robots|crates/funicular(-\w+)?)/(Cargo\.toml|README\.md|LICENSE-\w+|build\.rs|src/.*\.rs)"
    r"|robots/(lib\.rs|[\w-]+\.toml)|crates/funicular-(formats|pages|validation)/(reference|templates)/[\w-]+\.\w+"
)


def python_files() -> set[str]:
    """Files of the Python package in the repository."""
    line = ["git", "ls-files", "--", "python"]
    names = subprocess.run(line, cwd=PACKAGE, check=True, capture_output=True, text=True).stdout.split()
    return {name.removeprefix("python/") for name in names}


def differences(lacking: set[str], stray: set[str]) -> list[str]:
    """Sentences on files that are missing and files that do not belong there."""
    return [f"lacks {name}" for name in sorted(lacking)] + [f"has the stray file {name}" for name in sorted(stray)]


def description_faults(text: bytes, version: str, licences: set[str]) -> list[str]:
    """Faults of METADATA or PKG-INFO."""
    fields: email.message.Message = email.parser.BytesParser().parsebytes(text)
    identity = {"Name": "funicular", "Version": version}
    found = [f"says {key}: {fields[key]}, not {value}" for key, value in identity.items() if fields[key] != value]
    found += [f"has too few lines {key}" for key, least in WANTED.items() if len(fields.get_all(key, [])) < least]
    if set(fields.get_all("License-File", [])) != licences:
        found.append(f"names the licences {fields.get_all('License-File')}, not {sorted(licences)}")
    readme = (PACKAGE / "README.md").read_bytes().strip()
    if fields.get_payload(decode=True).strip() != readme:  # type: ignore[union-attr]
        found.append("its description is not README.md")
    return found


def wheel_faults(path: Path, version: str, platform: str) -> list[str]:
    """Faults of the wheel."""
    info = f"funicular-{version}.dist-info"
    licences = LICENCES | {"LICENSE-THIRD-PARTY.txt"}
    with zipfile.ZipFile(path) as archive:
        names = {name for name in archive.namelist() if not name.endswith("/")}
        files = {name: archive.read(name) for name in names if name.startswith(info)}
    wanted = python_files() | {"funicular/_funicular.abi3.so"}
    described = ("METADATA", "RECORD", "WHEEL", "entry_points.txt")
    wanted |= {f"{info}/{name}" for name in (*described, *(f"licenses/{name}" for name in licences))}
    # List of the crates in the compiled part, which maturin writes.
    stray = {name for name in names - wanted if not name.startswith(f"{info}/sboms/")}

    found = differences(wanted - names, stray)
    if not re.fullmatch(rf"funicular-{re.escape(version)}-cp311-abi3-{platform}_\w+\.whl", path.name):
        found.append(f"is not named after version {version}, abi3 of Python 3.11 and {platform}")
    found += [f"{name} is empty" for name in names if "/licenses/" in name and len(files[name]) < 1000]
    return found + description_faults(files[f"{info}/METADATA"], version, licences)


def sdist_faults(path: Path, version: str) -> list[str]:
    """Faults of the source distribution."""
    top = f"funicular-{version}/"
    with tarfile.open(path) as archive:
        members = archive.getmembers()
        odd = [member.name for member in members if not (member.isfile() or member.isdir())]
        names = {member.name.removeprefix(top) for member in members if member.isfile()}
        text = archive.extractfile(f"{top}PKG-INFO").read()  # type: ignore[union-attr]
    python = {f"python/{name}" for name in python_files()}
    wanted = python | LICENCES | {"PKG-INFO", "Cargo.lock", "README.md", "pyproject.toml"}
    stray = {name for name in names - python if not SOURCES.fullmatch(name)}
    found = [f"has {name}, which is not a regular file" for name in odd] + differences(wanted - names, stray)
    return found + description_faults(text, version, LICENCES)


def commands() -> set[str]:
    """Names of the commands, from the table of docs/commands.md, which a test compares with the program."""
    text = (ROOT / "docs/commands.md").read_text(encoding="utf-8")
    return set(re.findall(r"^\| `([a-z-]+)` \|", text, re.MULTILINE)) - {"request", "completions", "man"}


def program_faults(path: Path, version: str) -> list[str]:
    """Faults of the archive of the program."""
    top = path.name.removesuffix(".tar.gz")
    with tarfile.open(path) as archive:
        files = {member.name.removeprefix(f"{top}/"): member.size for member in archive.getmembers() if member.isfile()}
    robots = {f"robots/{robot.name}" for robot in (ROOT / "robots").glob("*.toml")} - {"robots/Cargo.toml"}
    pages = {f"share/man/man1/funicular-{command}.1" for command in commands()} | {"share/man/man1/funicular.1"}
    shells = {"bash-completion/completions/funicular", "zsh/site-functions/_funicular"}
    shells |= {"fish/vendor_completions.d/funicular.fish"}
    wanted = {"funicular", "README.md", "CHANGELOG.md", "LICENSE-THIRD-PARTY.txt", "robots/README.md"} | LICENCES
    wanted |= robots | pages | {f"share/{name}" for name in shells}
    found = [] if top.startswith(f"funicular-{version}-") else [f"is not named after version {version}"]
    return found + differences(wanted - set(files), set(files) - wanted) + [
        f"has the empty file {name}" for name, size in sorted(files.items()) if size == 0
    ]


def main() -> int:
    """Checks the files; returns 1 if anything is wrong."""
    match sys.argv[1:]:
        case ["package", version, platform, *files] if len(files) == 2:
            wheel, sdist = map(Path, files)
        case ["program", version, file]:
            faults = [f"{Path(file).name} {fault}" for fault in program_faults(Path(file), version)]
            print("\n".join(faults) or f"{Path(file).name} is complete")
            return int(bool(faults))
        case _:
            print((__doc__ or "").split("\n\n")[1], file=sys.stderr)
            return 2
    faults = [f"{wheel.name} {fault}" for fault in wheel_faults(wheel, version, platform)]
    faults += [f"{sdist.name} {fault}" for fault in sdist_faults(sdist, version)]
    print("\n".join(faults) or f"{wheel.name} and {sdist.name} are complete")
    return int(bool(faults))


if __name__ == "__main__":
    sys.exit(main())
