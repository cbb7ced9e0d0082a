"""Exceptions. Their texts are the program's: the value, the limit, and what to do."""

from typing import NamedTuple


class Error(Exception):
    """Whatever funicular has to say against a request."""

    __module__ = "funicular"


class InputError(Error, ValueError):
    """An argument that has to change."""

    __module__ = "funicular"


class Issue(NamedTuple):
    """One thing that is wrong with a robot file."""

    line: int
    column: int
    message: str
    help: str | None


class RobotFileError(Error, ValueError):
    """A robot file that cannot be used; the message shows its lines, with carets under what is wrong."""

    __module__ = "funicular"

    issues: list[Issue]
    """What is wrong, in the order of the file."""

    def __init__(self, message: str, issues: list[tuple[int, int, str, str | None]] | None = None) -> None:
        super().__init__(message)
        self.issues = [Issue(*issue) for issue in issues or []]


class StaticsError(Error):
    """There is no such equilibrium, or none was found."""

    __module__ = "funicular"

    code: str
    """Why not, in a word that does not change; the `status` of a row of `Equilibria`."""

    def __init__(self, message: str, code: str = "") -> None:
        super().__init__(message)
        self.code = code


class DynamicsError(Error):
    """The robot cannot be linearised as asked."""

    __module__ = "funicular"


class ResponseError(Error):
    """There is no finite response."""

    __module__ = "funicular"


class NoSolutionError(Error):
    """Nothing is wrong with the request, and there is no such result."""

    __module__ = "funicular"


class FileError(Error):
    """A file that cannot be written, or a file of a sweep that cannot be read or belongs to another sweep."""

    __module__ = "funicular"
