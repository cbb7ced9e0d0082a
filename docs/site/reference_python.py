"""Reference page of the Python package, made from its stubs and sources without importing them."""

import ast
import re
from dataclasses import dataclass
from pathlib import Path

from pages import ROOT

PACKAGE = ROOT / "crates/funicular-py/python/funicular"
_SECTION = re.compile(r"^(Parameters|Returns|Raises|Yields|Attributes|Examples?|Notes|References)\n-+\n", re.MULTILINE)


@dataclass
class Item:
    """Class or function with the text of its file."""

    node: ast.ClassDef | ast.FunctionDef
    file: Path


def _items() -> dict[str, list[Item]]:
    """All classes and functions of the package by name; a function of several signatures has several."""
    found: dict[str, list[Item]] = {}
    for file in [PACKAGE / "_funicular.pyi", *sorted(PACKAGE.glob("*.py"))]:
        for node in ast.parse(file.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ClassDef | ast.FunctionDef):
                found.setdefault(node.name, []).append(Item(node, file))
    return found


def exported() -> list[str]:
    """Names of `__all__`."""
    for node in ast.parse((PACKAGE / "__init__.py").read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "__all__":
            return [name for name in ast.literal_eval(node.value) if not name.startswith("__")]
    raise RuntimeError("funicular/__init__.py has no __all__")


def signature(node: ast.FunctionDef, of: str = "") -> str:
    """Signature as one would write the call, without the instance."""
    text = ast.unparse(ast.FunctionDef(node.name, node.args, [ast.Pass()], [], node.returns, type_params=[], lineno=0, col_offset=0))
    text = text.removeprefix("def ").removesuffix(":\n    pass")
    text = re.sub(r"\((self|cls)(, /)?(, )?", "(", text, count=1)
    return f"{of}{text}"


def _entries(body: str) -> str:
    """Section of names with indented texts as a definition list."""
    out, block = [], re.split(r"^(?=\S)", body, flags=re.MULTILINE)
    for entry in filter(str.strip, block):
        head, _, rest = entry.partition("\n")
        text = " ".join(rest.split())
        out.append(f"`{head.strip()}`\n: {text}\n" if text else head.strip() + "\n")
    return "\n".join(out)


def prose(docstring: str | None) -> str:
    """Docstring in NumPy's style as Markdown."""
    if not docstring:
        return ""
    text = re.sub(r"^(>>> .*(?:\n.+)*)", r"```pycon\n\1\n```", docstring, flags=re.MULTILINE)
    pieces = _SECTION.split(text)
    out = [pieces[0].strip()]
    for title, body in zip(pieces[1::2], pieces[2::2], strict=True):
        listed = title in ("Parameters", "Raises", "Attributes")
        out.append(f"**{title}**\n\n{_entries(body) if listed else body.strip()}")
    return "\n\n".join(out)


def _is_property(node: ast.FunctionDef) -> bool:
    return any(getattr(one, "id", getattr(one, "attr", "")) == "property" for one in node.decorator_list)


def _methods(node: ast.ClassDef) -> str:
    """Attributes, properties and methods of a class."""
    out = []
    attributes = []
    for at, statement in enumerate(node.body):
        following = node.body[at + 1] if at + 1 < len(node.body) else None
        if isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name):
            is_text = isinstance(following, ast.Expr) and isinstance(following.value, ast.Constant)
            about = str(following.value.value) if is_text else ""  # type: ignore[union-attr]
            if not statement.target.id.startswith("_"):
                attributes.append((statement.target.id, ast.unparse(statement.annotation), about))
        if isinstance(statement, ast.FunctionDef) and _is_property(statement) and not statement.name.startswith("_"):
            returns = ast.unparse(statement.returns) if statement.returns else ""
            attributes.append((statement.name, returns, ast.get_docstring(statement) or ""))
    if attributes:
        out += [f"`{name}: {kind}`\n: {' '.join(about.split())}\n" for name, kind, about in attributes]
    by_name: dict[str, list[ast.FunctionDef]] = {}
    for statement in node.body:
        public = isinstance(statement, ast.FunctionDef) and not statement.name.startswith("_")
        if public and not _is_property(statement):
            by_name.setdefault(statement.name, []).append(statement)
    for name, overloads in by_name.items():
        about = next((text for one in overloads if (text := ast.get_docstring(one))), "")
        lines = "\n".join(signature(one, f"{node.name}.") for one in overloads)
        out.append(f"### `{node.name}.{name}`\n\n```python\n{lines}\n```\n\n{prose(about)}\n")
    return "\n".join(out)


def page() -> str:
    """Page of all public names of the package and of `funicular.plot`."""
    items = _items()
    out = [
        "# Python objects",
        "All public names of the package `funicular`, from its stubs and sources. "
        "[Python](../python.md) is the page to read first. Every object has this text in `help`, too.",
    ]
    for name in exported():
        if name not in items:
            raise RuntimeError(f"`{name}` of funicular.__all__ is in no file")
        node = items[name][0].node
        if isinstance(node, ast.ClassDef):
            bases = ", ".join(ast.unparse(base) for base in node.bases)
            out.append(f"## `{name}`")
            if bases:
                out.append(f"A kind of `{bases}`.")
            out += [prose(ast.get_docstring(node)), _methods(node)]
        else:
            out.append(f"## `{name}`\n\n```python\n{signature(node)}\n```\n\n{prose(ast.get_docstring(node))}")
    plot = ast.parse((PACKAGE / "plot.py").read_text(encoding="utf-8"))
    out.append(f"## `funicular.plot`\n\n{prose(ast.get_docstring(plot))}")
    for function in plot.body:
        if isinstance(function, ast.FunctionDef) and not function.name.startswith("_"):
            lines = signature(function, "plot.")
            about = prose(ast.get_docstring(function))
            out.append(f"### `plot.{function.name}`\n\n```python\n{lines}\n```\n\n{about}")
    return "\n\n".join(out) + "\n"
