"""Sphinx extension: equations are typeset by KaTeX while the site is built, so that pages need no script for them. An
equation that KaTeX refuses is a warning, and so an error of the build."""

import json
import re
import shutil
import subprocess
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError
from sphinx.search.en import SearchEnglish
from sphinx.util import logging

HERE = Path(__file__).resolve().parent
KATEX = HERE / "node_modules/katex/dist"
logger = logging.getLogger(__name__)


class Typesetter:
    """Process that runs KaTeX."""

    def __init__(self) -> None:
        self.process = subprocess.Popen(
            ["node", str(HERE / "render_math.mjs")], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8"
        )

    def html(self, tex: str, display: bool, where: nodes.Node) -> str:
        """HTML of an equation; the text itself, with a warning, if it is none."""
        if self.process.stdin is None or self.process.stdout is None:
            raise ExtensionError("node has no pipes")
        self.process.stdin.write(json.dumps({"tex": tex, "display": display}) + "\n")
        self.process.stdin.flush()
        line = self.process.stdout.readline()
        if not line:
            raise ExtensionError("node ended: run `npm ci` in docs/site")
        answer = json.loads(line)
        if "error" in answer:
            logger.warning("equation %r: %s", tex, answer["error"], location=where)
            return tex
        return str(answer["html"])


class Search(SearchEnglish):
    """English search that also finds an index as it is written in plain text: `K_{11}` as K_11."""

    def split(self, input: str) -> list[str]:
        """Words of a text, with the indices in it."""
        indexed = re.findall(r"\b([A-Za-z])_\{?([A-Za-z0-9]+)\}?", input)
        return [*super().split(input), *(f"{letter}_{index}" for letter, index in indexed)]


def _inline(self: Any, node: nodes.math) -> None:
    self.body.append(self.builder.typesetter.html(node.astext(), False, node))
    raise nodes.SkipNode


def _display(self: Any, node: nodes.math_block) -> None:
    html = self.builder.typesetter.html(node.astext(), True, node)
    self.body.append(f'<div class="equation">{html}</div>\n')
    raise nodes.SkipNode


def _start(app: Sphinx) -> None:
    app.builder.typesetter = Typesetter()  # type: ignore[attr-defined]


def _copy_fonts(app: Sphinx, exception: Exception | None) -> None:
    if exception is None:
        folder = Path(app.outdir) / "_static/katex"
        shutil.copytree(KATEX / "fonts", folder / "fonts", dirs_exist_ok=True, ignore=_only_woff2)
        shutil.copy(KATEX / "katex.min.css", folder)


def _only_woff2(folder: str, names: Iterable[str]) -> list[str]:
    """Older formats of the fonts, which no browser of today takes."""
    return [name for name in names if not name.endswith(".woff2")]


def setup(app: Sphinx) -> dict[str, Any]:
    """Enters the extension."""
    app.connect("builder-inited", _start)
    app.connect("build-finished", _copy_fonts)
    app.add_html_math_renderer("katex", (_inline, None), (_display, None))
    app.add_search_language(Search)
    app.add_css_file("katex/katex.min.css")
    return {"parallel_read_safe": True, "parallel_write_safe": False}
