"""Builds the site: generated pages, notebooks, Sphinx, then the parts that others have built, then a check of all links.

Usage: build.py TARGET SITE, with the folder of built things and the folder of the site. scripts/docs runs it."""

import os
import shutil
import sys
import time
from pathlib import Path

from sphinx.cmd.build import main as sphinx

import gallery
import links
import machines
import messages
import notebooks
import pages
import reference_commands
import reference_python
import runnable

HERE = Path(__file__).resolve().parent
NO_PAGE = "The page is not part of this build. `scripts/web` builds it into `target/web`, and then `scripts/docs` shows it here."
NO_RUST = "The Rust documentation is not part of this build. `cargo doc --workspace --no-deps` writes it into `target/doc`, and then `scripts/docs` copies it here."


def beside(target: Path) -> dict[str, str]:
    """Pages that show what other scripts have built, or say how to build it."""
    page = target / "web/funicular.html"
    live = '<iframe class="live" src="_static/live.html" title="Live page of funicular" loading="lazy"></iframe>'
    shown = f"```{{raw}} html\n{live}\n<p><a href=\"_static/live.html\">Open the page alone</a></p>\n```" if page.is_file() else NO_PAGE
    rust = "<a href=\"../_static/rust/funicular/index.html\">Crates of funicular: documentation of the Rust code</a>"
    has_rust = (target / "doc/funicular/index.html").is_file()
    return {
        "live.md": "# Drag the platform\n\nA robot in your browser: drag the platform, change numbers, see tensions and modes. "
        f"Nothing is sent anywhere. [The page](web.md) explains it.\n\n{shown}\n",
        "reference/rust.md": "# Rust\n\nThe physics is the crate `funicular`, the analyses are `funicular-study`, files of other programs "
        "`funicular-formats`, pages and figures `funicular-pages`, the reference numbers `funicular-validation`. "
        "[Architecture](../project/architecture.md) says what is where.\n\n"
        + (f"```{{raw}} html\n<p>{rust}</p>\n```\n" if has_rust else f"{NO_RUST}\n"),
    }


def copied(target: Path, site: Path) -> None:
    """Puts the live page and the Rust documentation beside the pages."""
    page = target / "web/funicular.html"
    if page.is_file():
        shutil.copy(page, site / "_static/live.html")
    if (target / "doc/funicular/index.html").is_file():
        shutil.copytree(target / "doc", site / "_static/rust", ignore=shutil.ignore_patterns("src", ".lock"), dirs_exist_ok=True)


# What the theme leaves to readers with a keyboard or a screen reader.
FOR_ALL = [
    ('class="caption" role="heading"', 'class="caption" role="heading" aria-level="2"'),
    ('<div class="highlight"><pre>', '<div class="highlight"><pre tabindex="0">'),
    ('<div class="table-wrapper', '<div tabindex="0" class="table-wrapper'),
]


def made_reachable(site: Path, runs: bool) -> None:
    """Gives headings their level, lets keys scroll wide code and tables, and names the Markdown of each
    page. With `runs` the examples of a page run in it."""
    for page in site.rglob("*.html"):
        if "_static" in page.relative_to(site).parts:
            continue
        text = page.read_text(encoding="utf-8")
        for before, after in FOR_ALL:
            text = text.replace(before, after)
        text = machines.linked(page, text)
        text = runnable.linked(site, page, text) if runs else text
        page.write_text(text, encoding="utf-8")


def main() -> int:
    """Builds the site; returns 1 if anything is wrong."""
    started = time.perf_counter()
    target, site = Path(sys.argv[1]), Path(sys.argv[2])
    program = os.environ["FUNICULAR_PROGRAM"]
    sources = target / "site-sources"
    for folder in (sources, site):
        shutil.rmtree(folder, ignore_errors=True)
    try:
        generated = {
            **reference_commands.pages(program),
            "reference/quantities.md": reference_commands.measures(),
            "reference/messages.md": messages.page(),
            "reference/python.md": reference_python.page(),
            **beside(target),
        }
        pages.write(sources, generated)
        gallery.write(program, sources)
        notebooks.write(os.environ["FUNICULAR_PYTHON"], sources / "notebooks")
    except (pages.DeadLink, RuntimeError) as error:
        print(error, file=sys.stderr)
        return 1
    print(f"sources of the site after {time.perf_counter() - started:.0f} s", flush=True)
    if sphinx(["-q", "-W", "--keep-going", "-c", str(HERE), "-b", "html", str(sources), str(site)]) != 0:
        return 1
    machines.write(program, sources, site)
    made_reachable(site, runnable.write(target, site))
    copied(target, site)
    dead = links.dead(site)
    for line in dead:
        print(line, file=sys.stderr)
    size = sum(path.stat().st_size for path in site.rglob("*") if path.is_file())
    print(f"{site}: {len(list(site.rglob('*.html')))} pages, {size / 1e6:.0f} MB; open {site}/index.html")
    return 1 if dead else 0


if __name__ == "__main__":
    sys.exit(main())
