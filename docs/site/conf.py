"""Configuration of the documentation site. `scripts/docs` writes its sources (pages.py) and runs Sphinx on them."""

import sys
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(HERE))

project = "funicular"
author = "The funicular developers"
project_copyright = "2026 The funicular developers"
release = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["version"]
version = release

extensions = ["myst_nb", "sphinx_copybutton", "sphinx_design", "equations", "search_texts"]
myst_enable_extensions = ["dollarmath", "colon_fence", "deflist"]
myst_heading_anchors = 5
# Notebooks are executed by notebooks.py, in a kernel that has the package.
nb_execution_mode = "off"
nb_merge_streams = True
# Pages are in the language of the standard, and a console shows what is no language at all.
suppress_warnings = ["misc.highlighting_failure", "myst.xref_ambiguous"]

html_theme = "furo"
html_title = f"funicular {release}"
html_static_path = ["static"]
html_css_files = ["site.css"]
templates_path = ["templates"]
html_search_scorer = str(HERE / "static/scorer.js")
html_math_renderer = "katex"
html_copy_source = False
html_show_sourcelink = False
# Sphinx fetches pages for the summaries of its results, which a browser refuses to pages that were opened from a folder:
# search_texts.py and scorer.js make excerpts without that.
html_show_search_summary = False
html_search_language = "en"
html_theme_options = {
    "source_repository": "https://github.com/funicular-cdpr/funicular/",
    "source_branch": "main",
    "source_directory": "docs/",
    "top_of_page_buttons": [],
}
copybutton_prompt_text = r"\$ |>>> "
copybutton_prompt_is_regexp = True
