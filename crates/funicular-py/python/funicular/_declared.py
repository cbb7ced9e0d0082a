"""Methods whose keywords are the declared keys of a command.

`declared` makes a method from a function: its parameters are the keys of the command, with their types, defaults and
meanings from the compiled half, and those of the function itself. The function gets what a call gives, in a dictionary.
"""

import inspect
import json
import re
import textwrap
import warnings
from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import Any

from funicular import _words
from funicular._errors import InputError, ResponseWarning
from funicular._funicular import check_files, declarations, outputs_of_commands, suggested
from funicular._hints import in_words

COMMANDS: dict[str, list[dict[str, Any]]] = json.loads(declarations())

# Files that each command writes besides its result.
OUTPUTS: dict[str, list[dict[str, Any]]] = json.loads(outputs_of_commands())

# Headings of the keys of an equilibrium, which its methods do not have, and of its linearisation.
REST = ("State", "Load", "Tensions")
MODEL = ("Model",)

# Keys of the state of a robot.
STATE = tuple(key["name"] for key in COMMANDS["statics"] if key["heading"] in ("State", "Load"))

Given = dict[str, Any]

# Columns of the text of documentation.
_WIDTH = 108

# Types of `funicular._words` whose names are not those of their keywords.
_WORDS = {"to": "ExportFormat"}


def _type(key: dict[str, Any]) -> str:
    """Annotation of a keyword."""
    name, kind = key["name"], str(key["type"])
    if key["names"]:
        alias = _WORDS.get(name, name.title().replace("_", ""))
        kind = alias if hasattr(_words, alias) else f"Literal{key['names']!r}"
    if name == "of" and kind == "str | Sequence[str]":
        kind = "Result | Sequence[Result]"
    return kind


def _shown(key: dict[str, Any]) -> Any:
    """Default in the signature: names and truth values; a number stands in the documentation."""
    return key["default"] if key["names"] or isinstance(key["default"], bool) else None


def _parameter(key: dict[str, Any], *, positional: bool) -> inspect.Parameter:
    kind = inspect.Parameter.POSITIONAL_OR_KEYWORD if positional else inspect.Parameter.KEYWORD_ONLY
    if key["required"]:
        return inspect.Parameter(key["name"], kind, annotation=_type(key))
    default = _shown(key)
    annotation = _type(key) if default is not None else f"{_type(key)} | None"
    return inspect.Parameter(key["name"], kind, default=default, annotation=annotation.replace("Any | None", "Any"))


def _file_parameter(output: dict[str, Any]) -> inspect.Parameter:
    """Keyword of a file that a command writes besides its result."""
    kind = "File | Sequence[File]" if output["several"] else "File"
    return inspect.Parameter(output["key"], inspect.Parameter.KEYWORD_ONLY, default=None, annotation=f"{kind} | None")


def _about_file(output: dict[str, Any]) -> str:
    return f"{output['about']} ({', '.join(output['endings'])})."


def wanted_files(command: str, given: Given) -> list[tuple[str, Path]]:
    """Files that a call wants, in the order of the table, taken out of what it gives."""
    found = []
    for output in OUTPUTS[command]:
        paths = given.pop(output["key"], None)
        listed = [] if paths is None else [paths] if isinstance(paths, (str, PathLike)) else paths
        if not isinstance(listed, (list, tuple)) or not all(isinstance(path, (str, PathLike)) for path in listed):
            raise InputError(f"`{output['key']}` is of type {type(paths).__name__}: give the path of a file")
        found += [(output["key"], Path(path)) for path in listed]
    return found


def check_wanted(command: str, given: Given, wanted: list[tuple[str, Path]]) -> None:
    """Refuses files that cannot be written, before the work."""
    if wanted:
        simple = {key: value if isinstance(value, (bool, str)) else True for key, value in given.items() if value is not None}
        check_files(command, json.dumps(simple), wanted)


def write_wanted(answered: Any, call: str, wanted: list[tuple[str, Path]]) -> None:
    """Writes files of results; `call` is the beginning of the code that makes them."""
    if wanted:
        files = ", ".join(f"{key}={json.dumps(str(path), ensure_ascii=False)}" for key, path in wanted)
        for sentence in answered.write(wanted, f"{call}{files})"):
            warnings.warn(sentence, ResponseWarning, stacklevel=4)


def _about(key: dict[str, Any]) -> str:
    """Meaning of a key, with the names that it can have and what stands for it if it is not given."""
    about = str(key["about"])
    for name, meaning in zip(key["names"], key["meanings"], strict=True):
        about += f"{':' if name == key['names'][0] else ';'} `{name}`"
        about += f" ({meaning[0].lower()}{meaning[1:].rstrip('.')})" if meaning else ""
    default = key["default"]
    if isinstance(default, (int, float)) and not isinstance(default, bool):
        about += f"; {default:g} if not given"
    elif isinstance(default, list) and default:
        about += f"; {', '.join(map(str, default))} if not given"
    elif isinstance(default, str) and not key["names"]:
        about += f"; `{default}` if not given"
    elif key["otherwise"]:
        about += f"; if not given: {key['otherwise']}"
    return f"{about}."


def _sections(text: str) -> dict[str, str]:
    """Sections of a documentation by their headings; the text before them has the heading ""."""
    parts = re.split(r"^(\w+)\n-{3,}\n", inspect.cleandoc(text), flags=re.MULTILINE)
    return {"": parts[0].strip()} | {heading: body.strip() for heading, body in zip(parts[1::2], parts[2::2], strict=True)}


def _described(text: str) -> dict[str, str]:
    """Descriptions of parameters by their names."""
    parts = re.split(r"^(\w[\w, ]*)\n(?=    )", text, flags=re.MULTILINE)
    return {name: inspect.cleandoc(body) for name, body in zip(parts[1::2], parts[2::2], strict=True)}


def _documentation(text: str, keys: list[dict[str, Any]], order: list[str], others: str, files: dict[str, str]) -> str:
    sections = _sections(text)
    own = _described(sections.pop("Parameters", ""))
    written = {name for names in own for name in names.split(", ")}
    described = {key["name"]: textwrap.fill(_about(key), _WIDTH) for key in keys if key["name"] not in written} | files
    lines = []
    for name in order:
        names = next((names for names in own if names.split(", ")[0] == name), name)
        body = own.get(names) or described.get(name)
        if body:
            lines.append(f"{names}\n{textwrap.indent(body, '    ')}")
    parameters = "\n".join(lines)
    if others:
        parameters += f"\n\n{others}" if parameters else others
    made = [sections.pop("")]
    made += [f"Parameters\n----------\n{parameters}"] if parameters else []
    made += [f"{heading}\n{'-' * len(heading)}\n{body}" for heading, body in sections.items()]
    return "\n\n".join(made) + "\n"


def _binder(name: str, parameters: list[inspect.Parameter]) -> Callable[[tuple[Any, ...], Given], Given]:
    """Function that gives the arguments of a call their names; `Signature.bind` takes ten times as long.

    It raises `TypeError` for an argument that the method does not have, that is there twice, or that is missing.
    """
    positional = [p.name for p in parameters if p.kind is inspect.Parameter.POSITIONAL_OR_KEYWORD]
    known = {p.name for p in parameters}
    required = [p.name for p in parameters if p.default is inspect.Parameter.empty]

    def bound(arguments: tuple[Any, ...], keywords: Given) -> Given:
        if len(arguments) > len(positional):
            raise TypeError(
                f"{name}() takes from 1 to {len(positional) + 1} positional arguments but {len(arguments) + 1} were given"
            )
        given = dict(zip(positional, arguments, strict=False))
        for key in keywords:
            if key not in known:
                raise TypeError(f"{name}() got an unexpected keyword argument '{key}'{suggested(key, list(known))}")
            if key in given:
                raise TypeError(f"{name}() got multiple values for argument '{key}'")
        given |= keywords
        for key in required:
            if key not in given:
                kind = "positional" if key in positional else "keyword-only"
                raise TypeError(f"{name}() missing 1 required {kind} argument: '{key}'")
        return given

    return bound


def declared(
    of: type,
    command: str,
    *,
    positional: tuple[str, ...] = (),
    without: tuple[str, ...] = (),
    headings: tuple[str, ...] = (),
    state: bool = False,
    others: str = "",
    files: bool = False,
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Makes a method of the class `of` from a function.

    Parameters
    ----------
    command
        Command whose keys are parameters, besides `robot`.
    positional
        Parameters that a call may give by their place.
    without
        Keys that the method does not have.
    headings
        Headings whose keys the method does not have.
    state
        The keys of the state are parameters, too.
    others
        Sentence that stands for the descriptions of the keys under the headings `REST` and `MODEL`; they are described
        without one.
    files
        The files that the command writes besides its result are keywords.
    """

    outputs = OUTPUTS[command] if files else []

    def made(function: Callable[..., Any]) -> Callable[..., Any]:
        own = list(inspect.signature(function).parameters.values())[2:]
        taken = {"robot", *without, *(p.name for p in own)}
        more = [key for key in COMMANDS["statics"] if state and key["name"] in STATE]
        keys = [key for key in COMMANDS[command] + more if key["name"] not in taken and key["heading"] not in headings]
        by_name = {key["name"]: _parameter(key, positional=key["name"] in positional) for key in keys}
        for p in own:
            kind = inspect.Parameter.POSITIONAL_OR_KEYWORD if p.name in positional else inspect.Parameter.KEYWORD_ONLY
            by_name[p.name] = p.replace(kind=kind)
        by_name |= {output["key"]: _file_parameter(output) for output in outputs}
        parameters = [by_name.pop(name) for name in positional] + list(by_name.values())
        name = f"{of.__name__}.{function.__name__}"

        bound = _binder(name, parameters)
        own_names = [p.name for p in own]

        def method(self: Any, /, *arguments: Any, **keywords: Any) -> Any:
            given = bound(arguments, keywords)
            wanted = wanted_files(command, given) if outputs else []
            check_wanted(command, given, wanted)
            extra = {key: given.pop(key) for key in own_names if key in given}
            try:
                found = function(self, given, **extra)
                write_wanted(getattr(found, "_answered", None), f"robot.{function.__name__}(…, ", wanted)
                return found
            except TypeError as error:
                better = in_words(extra, error)
                if better is None:
                    raise
            raise better

        described = [key for key in keys if not others or key["heading"] not in (*REST, *MODEL)]
        texts = {output["key"]: textwrap.fill(_about_file(output), _WIDTH) for output in outputs}
        method.__name__, method.__qualname__, method.__module__ = function.__name__, name, "funicular"
        method.__doc__ = _documentation(function.__doc__ or "", described, [p.name for p in parameters], others, texts)
        itself = inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY)
        result = inspect.signature(function).return_annotation
        method.__signature__ = inspect.Signature([itself, *parameters], return_annotation=result)  # type: ignore[attr-defined]
        setattr(of, function.__name__, method)
        return method

    return made
