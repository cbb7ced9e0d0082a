"""Files of the site for programs that read it: each page as Markdown beside it, `llms.txt` and `llms-full.txt`, and the
JSON Schemas of robot files, requests and results in `schema/`."""

import re
from pathlib import Path, PurePosixPath

from reference_commands import run

# Schemas by the name of their file below `schema/`, which stays, and the word of the program.
SCHEMAS = {
    "robot-file.json": "robot-file",
    "request.json": "request",
    "results.json": "results",
}

SUMMARY = (
    "funicular computes cable-driven parallel robots whose cables sag, stretch and vibrate: equilibrium, stiffness, "
    "natural frequencies, responses, workspaces, simulation, identification, design. It is a program, a Python package, "
    "a WebAssembly module and a Rust library. Units are SI units, and every name of a value ends with its unit."
)
HOW = (
    "`funicular COMMAND ROBOT.toml --key value` prints text; `--format json` prints what `schema/results.json` "
    "describes. "
    "`funicular request FILE.json` runs a request that `schema/request.json` describes. "
    "`funicular-mcp`, a script of the Python package with the extra `mcp`, offers the same commands as tools. "
    "Links below lead to Markdown; the same pages are there with the ending `.html`."
)

_BLOCK = re.compile(
    r"^(?P<ticks>```+|:::+)\{(?P<name>[\w-]+)\}[^\n]*\n(?P<body>.*?)^(?P=ticks)[ \t]*\n?", re.DOTALL | re.MULTILINE
)
_FENCE = re.compile(r"^```[^\n]*\n.*?^```[ \t]*$", re.DOTALL | re.MULTILINE)
_TITLE = re.compile(r"^# +(.+?) *$", re.MULTILINE)


def plain(text: str) -> str:
    """Text of a page without the words of the site's builder: mathematics as GitHub writes it, no lists of pages."""

    def block(found: re.Match[str]) -> str:
        if found["name"] == "math":
            return f"```math\n{found['body']}```\n"
        # Cards and pictures of the site: their text stays, their options do not.
        is_left_out = found["name"] in ("toctree", "raw")
        return "" if is_left_out else re.sub(r"^:\w+:.*\n", "", found["body"], flags=re.MULTILINE)

    before = None
    while before != text:
        before, text = text, _BLOCK.sub(block, text)
    return re.sub(r"\{math\}`([^`]+)`", r"$`\1`$", text)


def title(text: str) -> str:
    """First heading of a page."""
    found = _TITLE.search(text)
    return found[1].replace("`", "") if found else ""


def first_sentence(text: str) -> str:
    """First sentence of a page after its heading, in one line and without links."""
    after = _FENCE.sub("", _TITLE.split(text, maxsplit=1)[-1])
    paragraphs = (part.strip() for part in re.split(r"\n\s*\n", after))
    skipped = ("#", "|", "```", "!", "-", ":", "<", "*")
    words = next((part for part in paragraphs if part and not part.startswith(skipped)), "")
    words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", re.sub(r"\s+", " ", words))
    return re.split(r"(?<=[a-z`)][.!?]) (?=[A-Z`])", words, maxsplit=1)[0].rstrip(":")


def sections(index: str) -> list[tuple[str, list[str]]]:
    """Captions of the site's table of contents, each with the names of its pages."""
    found = []
    for body in re.findall(r"^```\{toctree\}\n(.*?)^```", index, re.DOTALL | re.MULTILINE):
        caption = re.search(r"^:caption: (.*)$", body, re.MULTILINE)
        names = [line for line in body.splitlines() if line and not line.startswith(":")]
        if caption:
            found.append((caption[1], names))
    return found


def _order(pages: dict[str, str], index: str) -> list[tuple[str, list[str]]]:
    """Pages of each caption; those of a folder follow the page that lists them."""
    taken: set[str] = set()
    ordered = []
    for caption, names in sections(index):
        listed = []
        for name in names:
            folder = PurePosixPath(name).parent.as_posix() + "/" if name.endswith("/index") else None
            of_folder = [page for page in pages if folder and page.startswith(folder)]
            listed += [page for page in [name, *of_folder] if page in pages and page not in taken]
        listed = list(dict.fromkeys(listed))
        taken |= set(listed)
        ordered.append((caption, listed))
    left = [name for name in pages if name not in taken and name != "index"]
    return [*ordered, *([("More", left)] if left else [])]


def write(program: str, sources: Path, site: Path) -> None:
    """Writes all these files into the built site."""
    pages = {}
    for path in sorted(sources.rglob("*.md")):
        name = path.relative_to(sources).with_suffix("").as_posix()
        pages[name] = plain(path.read_text(encoding="utf-8"))
        to = site / f"{name}.md"
        to.parent.mkdir(parents=True, exist_ok=True)
        to.write_text(pages[name], encoding="utf-8")

    ordered = _order(pages, (sources / "index.md").read_text(encoding="utf-8"))
    short = ["# funicular", f"> {SUMMARY}", HOW]
    full = list(short)
    for caption, names in ordered:
        lines = [f"- [{title(pages[name])}]({name}.md): {first_sentence(pages[name])}" for name in names]
        short += [f"## {caption}", "\n".join(lines)] if lines else []
        full += [f"<!-- {name}.md -->\n\n{pages[name].strip()}" for name in names]
    about = [f"- [{name}](schema/{name}): JSON Schema, `funicular schema --of {of}`" for name, of in SCHEMAS.items()]
    short += ["## Schemas", "\n".join(about)]
    (site / "llms.txt").write_text("\n\n".join(short) + "\n", encoding="utf-8")
    (site / "llms-full.txt").write_text("\n\n".join(full) + "\n", encoding="utf-8")

    (site / "schema").mkdir(exist_ok=True)
    for name, of in SCHEMAS.items():
        (site / "schema" / name).write_text(run(program, "schema", "--of", of), encoding="utf-8")


def linked(page: Path, text: str) -> str:
    """Page of the site that names its Markdown to programs."""
    if not page.with_suffix(".md").is_file():
        return text
    link = f'<link rel="alternate" type="text/markdown" href="{page.stem}.md">'
    return text.replace("</head>", f"{link}\n</head>", 1)
