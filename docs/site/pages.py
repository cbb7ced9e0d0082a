"""Sources of the site: the pages of docs/ and some of the root, with the mathematics and links of GitHub put into words of
MyST, and theory and validation divided into chapters. Every relative link and anchor is followed; a dead one is an error."""

import os
import re
import shutil
import sys
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

ROOT = Path(__file__).resolve().parent.parent.parent
REPOSITORY = "https://github.com/funicular-cdpr/funicular"
# Pages outside docs/ that the site has, with their names there.
OTHERS = {
    "robots/README.md": "robots.md",
    "CHANGELOG.md": "project/changelog.md",
    "CONTRIBUTING.md": "project/contributing.md",
    "ARCHITECTURE.md": "project/architecture.md",
    "DESIGN.md": "project/design.md",
    "docs/site/index.md": "index.md",
}
# Pages that are too long for one: a chapter begins at each `## `.
DIVIDED = ["docs/theory.md", "docs/validation.md"]
# Files that people read at GitHub, in place of which the site has a page that is made from them.
MADE_FROM = {"docs/site/messages.toml": "reference/messages.md"}
# Folders of docs/ that are no pages.
NO_PAGES = ("docs/site/",)

_TOKEN = re.compile(
    r"(?P<fence>^(?P<ticks>```+|~~~+)(?P<language>[^\n]*)\n(?P<body>.*?)^(?P=ticks)[ \t]*$)"
    r"|(?P<math>\$`(?P<tex>[^`]+)`\$)"
    r"|(?P<code>(?P<mark>`+)(?!`).*?(?<!`)(?P=mark)(?!`))"
    r"|(?P<link>\]\((?P<target>[^()\s]+)\))",
    re.DOTALL | re.MULTILINE,
)
_HEADING = re.compile(r"^(#{1,6}) +(.+?) *$", re.MULTILINE)


class DeadLink(Exception):
    """Link that leads nowhere."""


@dataclass
class Page:
    """Page of the site: its text as in the repository, and where it goes."""

    source: str
    staged: str
    text: str
    level: int = 0
    """Levels by which its headings go up, because it is a chapter of a longer page."""
    anchors: set[str] = field(default_factory=set)


def slug(heading: str, taken: set[str]) -> str:
    """Anchor that GitHub gives to a heading."""
    heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    base = re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")
    made, count = base, 0
    while made in taken:
        count += 1
        made = f"{base}-{count}"
    return made


def _without_code(text: str) -> str:
    """Text whose blocks of code are empty lines, at the same places."""
    return _TOKEN.sub(lambda found: re.sub(r"[^\n]", " ", found[0]) if found["fence"] else found[0], text)


def _anchored(page: Page) -> Page:
    for _, heading in _HEADING.findall(_without_code(page.text)):
        page.anchors.add(slug(heading, page.anchors))
    return page


def divided(source: str, staged: str, text: str) -> list[Page]:
    """The chapters of a long page, after the page that lists them."""
    starts = [found.start() for found in re.finditer(r"^## ", _without_code(text), re.MULTILINE)]
    pieces = [text[a:b] for a, b in zip([0, *starts], [*starts, len(text)], strict=True)]
    folder = PurePosixPath(staged).with_suffix("")
    pages = [Page(source, f"{folder}/index.md", pieces[0])]
    for piece in pieces[1:]:
        name = slug(piece.split("\n", 1)[0].lstrip("# "), set())
        pages.append(Page(source, f"{folder}/{name}.md", piece, level=1))
    chapters = "\n".join(PurePosixPath(page.staged).name for page in pages[1:])
    pages[0].text = re.sub(r"^Contents:\n.*?\n\n", "", pages[0].text, flags=re.DOTALL | re.MULTILINE)
    pages[0].text += f"\n```{{toctree}}\n:maxdepth: 1\n\n{chapters}\n```\n"
    return pages


def collected() -> list[Page]:
    """All pages that are written by hand."""
    pages = []
    names = [path.relative_to(ROOT).as_posix() for path in sorted((ROOT / "docs").rglob("*.md"))]
    for source in [name for name in names if not name.startswith(NO_PAGES)] + list(OTHERS):
        staged = OTHERS.get(source, source.removeprefix("docs/"))
        text = (ROOT / source).read_text(encoding="utf-8")
        pages += divided(source, staged, text) if source in DIVIDED else [Page(source, staged, text)]
    return [_anchored(page) for page in pages]


class Site:
    """Pages and where their links lead."""

    def __init__(self, pages: list[Page], generated: set[str]) -> None:
        self.pages = pages
        # Names of pages that are made from the program, which have no source.
        self.generated = generated
        self.files: set[str] = set()
        self.by_source: dict[str, list[Page]] = {}
        for page in pages:
            self.by_source.setdefault(page.source, []).append(page)

    def resolved(self, page: Page, target: str) -> str:
        """Target of a link as a page of the site needs it."""
        if re.match(r"[a-z]+:", target):
            return target
        path, _, anchor = target.partition("#")
        source = os.path.normpath(os.path.join(os.path.dirname(page.source), path)) if path else page.source
        here = os.path.dirname(page.staged) or "."
        if source in self.by_source:
            found = self.by_source[source]
            if anchor:
                found = [one for one in found if anchor in one.anchors]
                if not found:
                    raise DeadLink(f"{page.source}: there is no heading #{anchor} in {source}")
            staged = "" if found[0] is page and anchor else os.path.relpath(found[0].staged, here)
            return f"{staged}#{anchor}" if anchor else staged
        inside = MADE_FROM.get(source, source.removeprefix("docs/"))
        if inside in self.generated:
            return os.path.relpath(inside, here) + (f"#{anchor}" if anchor else "")
        if not (ROOT / source).exists():
            raise DeadLink(f"{page.source}: {target} leads nowhere")
        if source.startswith("docs/") and (ROOT / source).is_file():
            self.files.add(source)
            return os.path.relpath(inside, here)
        kind = "tree" if (ROOT / source).is_dir() else "blob"
        return f"{REPOSITORY}/{kind}/main/{source}"

    def text(self, page: Page) -> str:
        """Text of a page in words of MyST."""

        def token(found: re.Match[str]) -> str:
            if found["fence"]:
                return f"```{{math}}\n{found['body']}```" if found["language"] == "math" else found[0]
            if found["math"]:
                return f"{{math}}`{found['tex']}`"
            return f"]({self.resolved(page, found['target'])})" if found["link"] else found[0]

        text = page.text
        if page.level:
            plain = _without_code(text)
            for heading in reversed(list(_HEADING.finditer(plain))):
                text = text[: heading.start()] + text[heading.start() + page.level :]
        return _TOKEN.sub(token, text)


def write(folder: Path, generated: dict[str, str]) -> None:
    """Writes the sources of the site into a folder."""
    site = Site(collected(), set(generated))
    dead = []
    for page in site.pages:
        to = folder / page.staged
        to.parent.mkdir(parents=True, exist_ok=True)
        try:
            to.write_text(site.text(page), encoding="utf-8")
        except DeadLink as error:
            dead.append(str(error))
    if dead:
        raise DeadLink("\n".join(dead))
    for name, text in generated.items():
        to = folder / name
        to.parent.mkdir(parents=True, exist_ok=True)
        to.write_text(text, encoding="utf-8")
    for source in site.files:
        to = folder / source.removeprefix("docs/")
        to.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / source, to)


if __name__ == "__main__":
    try:
        write(Path(sys.argv[1]), {})
    except DeadLink as error:
        sys.exit(str(error))
