"""Messages name keywords that exist."""

import inspect
import re
from typing import Any

import funicular
import funicular.plot
from conftest import ROOT

# Keys in messages about what only the program does: figures in files, and options that are methods in Python.
OF_THE_PROGRAM = {"all", "figure_mode", "figure_width_mm", "form"}

# Keys of an experiment in the list `experiments` of `identify`, which the program has as options, too.
OF_EXPERIMENTS = {"measured_lengths_m", "measured_pose", "measured_tensions_n"}


def named() -> dict[str, str]:
    """Keys in the sources with their forms in Python, which `wording.rs` lists where they differ."""
    wording = (ROOT / "crates/funicular-study/src/wording.rs").read_text()
    table = wording.split("const PYTHON_NAMES", 1)[1].split("];", 1)[0]
    forms = dict(re.findall(r'\("(\w+)", "([^"]+)"\)', table))
    assert forms["node"] == "nodes"
    keys: set[str] = set()
    for part in ("funicular", "funicular-study", "funicular-formats", "funicular-pages", "funicular-files"):
        for path in (ROOT / "crates" / part / "src").rglob("*.rs"):
            keys.update(re.findall(r"⟪([a-z_]+)⟫", path.read_text()))
    assert len(keys) > 60
    return {key: forms.get(key, key) for key in keys}


def keywords() -> set[str]:
    """Names of all keywords and methods of the package."""
    found: set[str] = set()
    for module in (funicular, funicular.plot):
        for name in module.__all__:
            of: Any = getattr(module, name)
            if inspect.isclass(of) and issubclass(of, Exception):
                continue
            if inspect.isclass(of) and issubclass(of, dict):
                continue
            members = [member for key, member in inspect.getmembers(of) if not key.startswith("_")] if inspect.isclass(of) else [of]
            for member in filter(callable, members):
                found.add(member.__name__)
                found.update(inspect.signature(member).parameters)
    return found


def test_every_key_of_a_message_is_a_keyword_or_a_method() -> None:
    known = keywords()
    missing = {key: form for key, form in named().items() if form.removesuffix("=True") not in known}
    assert sorted(set(missing) - OF_THE_PROGRAM - OF_EXPERIMENTS) == []
    assert sorted((OF_THE_PROGRAM | OF_EXPERIMENTS) - set(missing)) == [], "these are keywords: they need no exception"
