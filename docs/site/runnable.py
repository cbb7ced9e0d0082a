"""Examples that run in the pages of the site: the program as a WebAssembly module, where scripts/web-program has built
it, with the files of the documents."""

import base64
import gzip
import json
import os
import re
import shutil
import subprocess
from pathlib import Path

from pages import ROOT

HERE = Path(__file__).resolve().parent
# Files that examples read: small texts.
FOLDERS = ("robots", "docs")
ENDINGS = {".toml", ".csv", ".json", ".dat", ".xml", ".uff", ".yaml", ".txt", ".m", ".stl"}
MAX_BYTES = 400_000
# Options of the program that name files to write, besides those that the commands declare.
OWN = ["output_file", "samples_file"]

NOT_HERE = {
    "parquet": "the program in this page has no Parquet files",
    "fmu": "a unit for co-simulation needs a compiler",
    "fmu3": "a unit for co-simulation needs a compiler",
}
# Parts of lines that take minutes on one thread.
LONG = ["--boxes 400000"]
NO_COMMANDS = {
    "live": "the live page is the page “Drag the platform” of this site",
    "validate": "all comparisons together take minutes in a browser",
    "paper": "all comparisons of the paper take minutes in a browser",
}


def files() -> dict[str, str]:
    """Texts of the files of the documents, by their paths in the repository."""
    found = {}
    line = ["git", "ls-files", "--", *FOLDERS]
    listed = subprocess.run(line, cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\n")
    for name in filter(None, listed):
        path = ROOT / name
        if path.suffix in ENDINGS and not name.startswith("docs/site/") and path.stat().st_size <= MAX_BYTES:
            found[name] = path.read_text(encoding="utf-8")
    found.pop("robots/Cargo.toml", None)
    return found


def writing() -> list[str]:
    """Options whose files a command writes, as the commands declare them."""
    code = "from funicular._funicular import outputs_of_commands; print(outputs_of_commands())"
    line = [os.environ["FUNICULAR_PYTHON"], "-c", code]
    declared = json.loads(subprocess.run(line, check=True, capture_output=True, text=True).stdout)
    return sorted({output["key"] for outputs in declared.values() for output in outputs} | set(OWN))


def write(target: Path, site: Path) -> bool:
    """Puts the program beside the pages, if it was built."""
    module = target / "web/program.wasm"
    if not module.is_file():
        return False
    folder = site / "_static/run"
    folder.mkdir(parents=True, exist_ok=True)
    loader = (ROOT / "crates/funicular-wasm/web/program.js").read_text(encoding="utf-8")
    worker = (HERE / "static/run_worker.js").read_text(encoding="utf-8")
    # A worker from a text cannot import: the loader comes before it.
    code = re.sub(r"^export ", "", loader, flags=re.MULTILINE) + worker
    texts = files()
    packed = base64.b64encode(gzip.compress(module.read_bytes(), mtime=0)).decode()
    data = {"wasm": packed, "files": texts, "code": code}
    (folder / "program_data.js").write_text(f"const PROGRAM_DATA = {json.dumps(data)};\n", encoding="utf-8")
    shutil.copy(target / "web/LICENSE-PROGRAM.txt", folder / "LICENSE-THIRD-PARTY.txt")
    known = {"files": sorted(texts), "writes": writing(), "endings": NOT_HERE, "commands": NO_COMMANDS, "long": LONG}
    about = f"const RUNNABLE = {json.dumps(known)};\n"
    script = (HERE / "static/run.js").read_text(encoding="utf-8")
    (folder / "run.js").write_text(about + script, encoding="utf-8")
    for name in ("run.js", "run_worker.js"):
        (site / "_static" / name).unlink(missing_ok=True)
    return True


def linked(site: Path, page: Path, text: str) -> str:
    """Page of the site that loads the script, if it has an example."""
    if "funicular" not in text or not re.search(r"highlight-(console|sh)\b", text):
        return text
    source = os.path.relpath(site / "_static/run/run.js", page.parent)
    return text.replace("</body>", f'<script src="{source}"></script>\n</body>', 1)
