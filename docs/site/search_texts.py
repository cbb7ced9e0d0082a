"""Sphinx extension: the texts of all sections as a script, with which the search ranks pages and shows excerpts. A browser
does not let a page that was opened from a folder fetch other pages, but it loads scripts."""

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx

# Pages whose tables have one subject per row: a row is found as a section of its own.
ROWS = ("conventions", "glossary")
# Words of users: a search for one word of a row finds the others, too.
SYNONYMS = (
    "jupyter notebook jupyterlab ipynb colab binder",
    "cite citation bibtex doi reference",
    "install installation setup download build",
    "windows macos mac linux ubuntu debian system",
    "path trajectory course",
    "exact accurate accuracy precise error validation deviation",
    "brake hold held drum",
    "rope cable wire tendon line",
    "motor winch drum drive actuator",
    "strongest heaviest payload capacity carry",
    "strong powerful power torque",
    "breaks broken cut snap fails failure",
    "slack loose",
    "force tension pull",
    "eigenfrequency resonance frequency mode modal eigenvalue vibration oscillation",
    "shake swing sway settle oscillate",
    "speed velocity fast",
    "spreadsheet excel csv table",
    "cluster slurm mpi dask parallel",
    "picture figure plot chart drawing",
    "collision collide clearance interference crossing",
    "reach workspace reachable",
    "measure measurement sensor experiment identification",
    "anchor pulley exit mast pole",
    "position pose location orientation",
    "gps log recording estimate estimation",
    "chatgpt llm assistant mcp",
    "storm gust wind turbulence",
    "licence license mit apache",
)
# Characters of a section that the search knows. Longer ones are tables of numbers and listings.
MAX_TEXT = 6000


def _plain(node: nodes.Node) -> str:
    """Text in one line, with indices as one types them: `K_{11}` as K_11."""
    return re.sub(r"\s+", " ", re.sub(r"_\{(\w+)\}", r"_\1", node.astext())).strip()


def _own(section: nodes.section) -> Iterator[nodes.Node]:
    """Contents of a section beside its heading and its sections."""
    return (child for child in section.children if not isinstance(child, (nodes.title, nodes.section, nodes.raw)))


def _sections(name: str, tree: nodes.document) -> Iterator[tuple[str, str, str]]:
    """Anchor, heading and text of each section of a page."""
    for section in tree.findall(nodes.section):
        anchor, heading = section["ids"][0], _plain(section[0])
        yield anchor, heading, " ".join(_plain(child) for child in _own(section))[:MAX_TEXT]
        if name in ROWS:
            rows = (row for child in _own(section) for body in child.findall(nodes.tbody) for row in body.findall(nodes.row))
            for row in rows:
                first, *others = [_plain(entry) for entry in row.children]
                yield anchor, first, " – ".join(others)


def _write(app: Sphinx, exception: Exception | None) -> None:
    if exception is not None or app.builder.name != "html":
        return
    texts = {name: list(_sections(name, app.env.get_doctree(name))) for name in sorted(app.env.found_docs)}
    rows = [words.split() for words in SYNONYMS]
    script = f"const SEARCH_SYNONYMS = {json.dumps(rows)};\n"
    script += f"const SEARCH_TEXTS = {json.dumps(texts, ensure_ascii=False, separators=(',', ':'))};\n"
    (Path(app.outdir) / "_static/search_texts.js").write_text(script, encoding="utf-8")


def setup(app: Sphinx) -> dict[str, Any]:
    """Enters the extension."""
    app.connect("build-finished", _write)
    return {"parallel_read_safe": True, "parallel_write_safe": False}
