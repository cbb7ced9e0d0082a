"""Pages in HTML; each is one file that opens offline."""

import json
from dataclasses import dataclass
from html import escape
from os import PathLike
from pathlib import Path
from typing import Any

from funicular import _show
from funicular._errors import InputError
from funicular._funicular import Answered, try_file, write_file
from funicular._results import ArrayFields, with_arrays


@dataclass(frozen=True, repr=False)
class Page:
    """A page in HTML; notebooks show it."""

    html: str
    """Text of the page, with its figures, its numbers and the library that draws them."""
    warnings: tuple[str, ...]
    """Caveats, which also stand on the page."""

    def write(self, path: str | PathLike[str]) -> None:
        """Writes the page; the file is complete or absent."""
        if Path(path).suffix.lower() in (".svg", ".pdf", ".png"):
            raise InputError(
                f"{path} would hold one figure, but this is a page in HTML: give a name that ends in .html, or draw a "
                "figure with funicular.plot"
            )
        write_file(Path(path), self.html)

    def __repr__(self) -> str:
        return f"<Page: {len(self.html) / 1e6:.1f} MB of HTML>"

    def _repr_html_(self) -> str:
        frame = "width: 100%; height: 800px; border: 0"
        return f'<iframe srcdoc="{escape(self.html)}" style="{frame}"></iframe>'


def page(html: str, warnings: list[str], path: str | PathLike[str] | None = None) -> Page:
    """Makes a page, and writes it if a path is given."""
    made = Page(html, tuple(warnings))
    if path is not None:
        made.write(path)
    return made


def try_page(path: str | PathLike[str] | None) -> None:
    """Tries the file of a page before the work for it."""
    if path is not None:
        try_file(Path(path))


def page_of_result(answered: Answered, path: str | PathLike[str] | None) -> Page:
    """Makes the page of a result of `identify`, `design` or `uncertainty`, and writes it if a path is given."""
    own = json.loads(answered.request)
    command = own.pop("command")
    del own["robot"], own["schema"]
    # Measurements are too long to be repeated on the page.
    measured = ["experiments"] if own.pop("experiments", None) else []
    call = f"robot.{command}({', '.join(filter(None, [*measured, _keywords(own)]))}).page()"
    return page(answered.page(call), [], path)


class Answer(ArrayFields):
    """Results that the compiled half holds with their request: keys, table and page follow from it."""

    details: dict[str, Any]
    _answered: Answered

    def page(self, path: str | PathLike[str] | None = None) -> Page:
        """Makes a page in HTML about the results, which notebooks show, and writes it if a path is given."""
        return page_of_result(self._answered, path)

    def to_dict(self) -> dict[str, Any]:
        """Keys of the program's JSON, with arrays for lists of numbers."""
        found: dict[str, Any] = with_arrays(self.details)
        return found

    def to_pandas(self) -> Any:
        """Makes a table of pandas with the columns of the program's CSV, and their units in `attrs`; pandas has to be installed."""
        return _show.table(self)

    def to_latex(self) -> str:
        """Rounded table of the results for LaTeX, with the rules of booktabs and the numbers of siunitx."""
        return self._answered.reading_table(True)

    def to_markdown(self) -> str:
        """Rounded table of the results for Markdown."""
        return self._answered.reading_table(False)


def report_call(state: str, request: str) -> str:
    """Code that makes a report again; state and request are JSON."""
    given = json.loads(state)
    own = {key: value for key, value in json.loads(request).items() if key != "robot" and key not in given}
    return f"robot.equilibrium({_keywords(given)}).report({_keywords(own)})"


def _keywords(given: dict[str, object]) -> str:
    return ", ".join(f"{key}={value!r}" for key, value in given.items())
