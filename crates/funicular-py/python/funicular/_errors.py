"""Exceptions. They carry the same messages as the program: value, limit and remedy."""

from typing import NamedTuple

from funicular._funicular import shown


class Error(Exception):
    """Base of all exceptions of funicular."""

    __module__ = "funicular"

    def __init__(self, message: str = "") -> None:
        # Arguments are part of messages: they can be long, and hold what acts on a terminal.
        super().__init__(shown(message))


class InputError(Error, ValueError):
    """An argument is wrong; the message says which and what to give."""

    __module__ = "funicular"


class Issue(NamedTuple):
    """One error in a robot file, with its place."""

    line: int
    column: int
    message: str
    help: str | None


class RobotFileError(Error, ValueError):
    """A robot file cannot be used; the message shows its lines with carets under the errors."""

    __module__ = "funicular"

    issues: list[Issue]
    """Errors, in the order of the file."""

    def __init__(self, message: str, issues: list[tuple[int, int, str, str | None]] | None = None) -> None:
        super().__init__(message)
        self.issues = [Issue(*issue) for issue in issues or []]


class StaticsError(Error):
    """No such equilibrium exists, or none was found."""

    __module__ = "funicular"

    code: str
    """Reason as one word that stays the same between versions; also the `status` of a row of `Equilibria`."""

    def __init__(self, message: str, code: str = "") -> None:
        super().__init__(message)
        self.code = code


class DynamicsError(Error):
    """The robot cannot be linearised with the requested models."""

    __module__ = "funicular"


class ResponseError(Error):
    """The response is not finite."""

    __module__ = "funicular"


class ResponseWarning(UserWarning):
    """Peaks of a response lie between its frequencies, so that their heights are read too low."""

    __module__ = "funicular"


class RobotWarning(UserWarning):
    """The robot of a map or sweep has a value that no usual robot has, which is likely a slip."""

    __module__ = "funicular"


class MeasurementWarning(UserWarning):
    """A file of measurements has functions that were left out, or units that were converted."""

    __module__ = "funicular"


class NoSolutionError(Error):
    """The request is correct, but it has no result."""

    __module__ = "funicular"


class FileError(Error):
    """A file cannot be written, or a file of a sweep cannot be read or belongs to another sweep."""

    __module__ = "funicular"


def needs(what: str, package: str) -> ImportError:
    """Error for an optional package that is not installed."""
    return ImportError(f"{what} needs the package {package}: pip install {package}")
