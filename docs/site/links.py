"""Follows every link of the built site: files, anchors, and nothing that a browser would fetch from a network."""

import re
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

# Attributes that a browser fetches by itself when it opens a page.
FETCHED = {("script", "src"), ("img", "src"), ("iframe", "src"), ("link", "href"), ("source", "src"), ("video", "src")}
# Relations of <link> that are only told, and not fetched.
TOLD = {"canonical", "index", "search", "next", "prev", "author", "license", "genindex"}


class _Page(HTMLParser):
    """Links and anchors of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[tuple[str, bool]] = []
        self.anchors: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        found = {name: value or "" for name, value in attrs}
        for key in ("id", "name"):
            if found.get(key):
                self.anchors.add(found[key])
        told = tag == "link" and found.get("rel", "") in TOLD
        for key in ("href", "src"):
            if key in found and not told:
                self.links.append((found[key], (tag, key) in FETCHED))


def dead(site: Path) -> list[str]:
    """Faults of the links of a site, one sentence each. Pages below _static are those of other builders."""
    read: dict[Path, _Page] = {}

    def page(path: Path) -> _Page:
        if path not in read:
            read[path] = _Page(path.read_text(encoding="utf-8"))
        return read[path]

    faults = []
    for path in sorted(site.rglob("*.html")):
        if "_static" in path.relative_to(site).parts:
            continue
        name = path.relative_to(site)
        for link, fetched in page(path).links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                if fetched and parts.scheme != "data":
                    faults.append(f"{name}: the page would fetch {link} from a network")
                continue
            to = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            to = to / "index.html" if to.is_dir() else to
            if not to.exists():
                faults.append(f"{name}: {link} leads nowhere")
            elif parts.fragment and to.suffix == ".html" and unquote(parts.fragment) not in page(to).anchors:
                faults.append(f"{name}: {link} has no such anchor")
    for style in site.rglob("*.css"):
        if "rust" not in style.parts:
            urls = re.findall(r"url\(\s*['\"]?(https?://[^)'\"]+)", style.read_text(encoding="utf-8"))
            faults += [f"{style.relative_to(site)}: {url} is on a network" for url in urls]
    return faults
