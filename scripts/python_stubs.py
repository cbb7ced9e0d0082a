"""Types of the Python package that PyO3 does not declare: the methods that `_declared` makes, and overloads.

Runs with the installed package, on the `.pyi` of its compiled half. The methods have their parameters from the declared
keys of the commands. `adaptive` decides between two types of a result: a function with the keyword
`adaptive: bool = False` and the type `A | B` of its result becomes three overloads: `A` for False, `B` for True, and
`A | B` for a value that is known only at run time.
"""

import inspect
import re
import sys
import textwrap
from pathlib import Path
from typing import Any

import funicular
import funicular.results

FUNCTION = re.compile(r"^( *)def (?P<head>.*)adaptive: bool = False(?P<tail>.*) -> (?P<plain>.*?) \| (?P<chosen>.*):$", re.MULTILINE)

# Names in the types of the methods, by their modules.
NAMES = {
    "collections.abc": ("Callable", "Mapping", "Sequence"),
    "concurrent.futures": ("Executor",),
    "funicular._design": ("Designed",),
    "funicular._identify": ("Identified",),
    "funicular._live": ("Live",),
    "funicular._pages": ("Page",),
    "funicular._results": ("Equilibria", "Modes", "ReducedModel", "Results", "StateSpaceModel"),
    "funicular._sweeps": ("Sweep",),
    "funicular._uncertainty": ("Uncertainty",),
    "funicular._words": tuple(name for name in vars(funicular._words) if name[0].isupper() and name != "Literal"),
    "funicular.results": tuple(of.__name__ for of in funicular._results.OF_COMMANDS.values()),
    "numpy": ("complex128", "float64"),
    "numpy.typing": ("ArrayLike", "NDArray"),
    "os": ("PathLike",),
    "typing": ("Any", "Literal", "SupportsFloat", "SupportsIndex", "overload"),
}


def shown(parameter: inspect.Parameter) -> str:
    """Parameter as in a signature; annotations are texts."""
    default = parameter.default
    if default is inspect.Parameter.empty:
        value = ""
    else:
        value = f' = "{default}"' if isinstance(default, str) else f" = {default!r}"
    return f"{parameter.name}: {parameter.annotation}{value}".replace("File", "str | PathLike[str]")


def declaration(method: Any) -> str:
    """Method with its types and its documentation."""
    signature = inspect.signature(method)
    _, *parameters = signature.parameters.values()
    listed = ["self", "/"]
    for parameter in parameters:
        if parameter.kind is inspect.Parameter.KEYWORD_ONLY and "*" not in listed:
            listed.append("*")
        listed.append(shown(parameter))
    text = textwrap.indent(f'"""\n{inspect.cleandoc(method.__doc__)}\n"""', "    ")
    return f"def {method.__name__}({', '.join(listed)}) -> {signature.return_annotation}:\n{text}\n"


def with_methods(text: str, of: type) -> str:
    """Types of a class with those of its declared methods, in alphabetical order."""
    methods = sorted((name, method) for name, method in vars(of).items() if isinstance(getattr(method, "__signature__", None), inspect.Signature))
    begin = re.search(rf"^class {of.__name__}\b.*:$", text, re.MULTILINE)
    assert begin and methods, of
    end = re.search(r"^(?=\S)", text[begin.end() + 1 :], re.MULTILINE)
    at = begin.end() + 1 + end.start() if end else len(text)
    body = "".join(textwrap.indent(declaration(method), "    ") for _, method in methods)
    return f"{text[:at].rstrip()}\n{body}\n{text[at:]}"


def overloads(function: re.Match[str]) -> str:
    indent, head, tail, plain, chosen = function.groups()
    # The text of documentation stays with the last overload.
    of = [("adaptive: Literal[False] = False", plain), ("adaptive: Literal[True]", chosen)]
    lines = [f"{indent}@overload\n{indent}def {head}{adaptive}{tail} -> {result}: ...\n" for adaptive, result in of]
    return "".join(lines) + f"{indent}@overload\n{indent}def {head}adaptive: bool{tail} -> {plain} | {chosen}:"


def with_imports(text: str) -> str:
    """Types with imports of the names that they use."""
    head, all_names, rest = text.partition("\n__all__")
    imported = set(re.findall(r"\w+", " ".join(re.findall(r"^from .* import (.*)$", head, re.MULTILINE))))
    missing = {module: [name for name in names if name not in imported and re.search(rf"\b{name}\b", rest)] for module, names in NAMES.items()}
    lines = [f"from {module} import {', '.join(names)}" for module, names in missing.items() if names]
    return head.rstrip() + "\n" + "\n".join(lines) + "\n" + all_names + rest


# Methods of the compiled half that only declared methods call.
PRIVATE = re.compile(r"^    def _[a-z]\w*[a-z]\(.*:(?: \.\.\.)?\n(?:        .*\n|\n(?=        ))*", re.MULTILINE)

for path in map(Path, sys.argv[1:]):
    text = PRIVATE.sub("", path.read_text())
    # Further keywords have no type in the compiled half.
    text = re.sub(r"(\*\*\w+)(?=[,)])", r"\1: Any", text)
    for of in (funicular.Analyses, funicular.Robot):
        text = with_methods(text, of)
    path.write_text(with_imports(FUNCTION.sub(overloads, text)))
