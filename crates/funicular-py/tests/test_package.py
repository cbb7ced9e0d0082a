"""Tests of the complete package: types, imports, the example in README.md, figures."""

import ast
import os
import re
import subprocess
import sys
from pathlib import Path

import funicular
import funicular.plot
import numpy as np
import pytest
from conftest import ROOT, plain_grid

HERE = Path(__file__).parent


def run(*line: object) -> str:
    done = subprocess.run(list(map(str, line)), capture_output=True, text=True, cwd=HERE, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_a_users_script_runs_and_is_typed() -> None:
    assert "certified" not in run(sys.executable, "user_script.py")
    run(sys.executable, "-m", "mypy", "--strict", "user_script.py")


def test_wrong_types_are_found(tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.py"
    wrong.write_text("import funicular\nfunicular.Robot.example().modes(below_hz='20').certfied\n")
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", str(wrong)], capture_output=True, text=True, check=False)
    assert "arg-type" in done.stdout and "certfied" in done.stdout


def test_the_package_itself_is_typed() -> None:
    run(sys.executable, "-m", "mypy", "--config-file", "../pyproject.toml", "--strict", "../python/funicular")


def test_the_types_are_those_of_the_compiled_module() -> None:
    """`scripts/test-python` generates the types; `UPDATE_STUBS=1` stores them."""
    generated = os.environ.get("FUNICULAR_STUBS")
    if not generated:
        pytest.skip("FUNICULAR_STUBS does not name the folder of the generated types")
    committed = HERE.parent / "python/funicular/_funicular.pyi"
    found = list(Path(generated).rglob("_funicular.pyi"))
    assert len(found) == 1
    assert found[0].read_text() == committed.read_text()


@pytest.mark.parametrize("readme", [ROOT / "README.md", HERE.parent / "README.md"], ids=["repository", "package"])
def test_the_example_of_the_readme_runs_as_it_stands(readme: Path, tmp_path: Path) -> None:
    blocks = re.findall(r"```python\n(.*?)```", readme.read_text(), re.DOTALL)
    assert len(blocks) == 1
    done = subprocess.run([sys.executable, "-c", blocks[0]], capture_output=True, text=True, cwd=tmp_path, check=False)
    assert done.returncode == 0, done.stderr
    # Every line that prints has its output in a comment.
    assert re.findall(r"^print\(.*\)  # (.*)$", blocks[0], re.MULTILINE) == done.stdout.splitlines() != []


def test_the_example_of_the_docstring_holds() -> None:
    import doctest

    assert doctest.testmod(funicular).failed == 0 and doctest.testmod(funicular).attempted > 0


def test_extras_are_imported_when_used_only() -> None:
    script = "import sys, funicular, funicular.plot; funicular.Robot.example().modes(5); "
    script += "print([name for name in ('pandas', 'matplotlib', 'plotly', 'tomllib') if name in sys.modules])"
    assert run(sys.executable, "-c", script) == "[]\n"


def test_every_public_item_says_what_it_is() -> None:
    for name in funicular.__all__:
        item = getattr(funicular, name)
        if name.startswith("__"):
            continue
        assert item.__doc__, name
        for key, member in vars(item).items() if isinstance(item, type) else ():
            if not key.startswith("_") and (callable(member) or isinstance(member, property)):
                assert member.__doc__, f"{name}.{key}"


@plain_grid
def test_figures_show_the_numbers(rest: funicular.Equilibrium) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    modes, hz = rest.modes(20), np.linspace(0.1, 10, 100)
    response = rest.frf(hz, "fz", "az")
    axes = funicular.plot.robot(rest)
    assert len(axes.lines) == 7 and axes.get_title() == rest.robot.name
    axes = funicular.plot.frf(hz, [response, 2 * response], labels=["a", "b"], unit="(m/s²)/N")
    assert np.array_equal(axes.lines[0].get_ydata(), abs(response)) and axes.get_yscale() == "log"
    assert funicular.plot.frf(hz, response, ax=axes) is axes and len(axes.lines) == 3
    with pytest.raises(funicular.InputError, match="a row of frequencies"):
        funicular.plot.frf(1.0, 1j)
    points = sum(len(line.get_xdata()) for line in funicular.plot.modes(modes).lines)
    assert points == len(modes) == 147
    for drawn in (axes, funicular.plot.robot(rest)):
        drawn.figure.canvas.draw()


@plain_grid
def test_interactive_figures_show_them_too(rest: funicular.Equilibrium) -> None:
    pytest.importorskip("plotly")
    modes, hz = rest.modes(20), np.linspace(0.1, 10, 100)
    assert len(funicular.plot.robot(rest, backend="plotly").data) == 8
    figure = funicular.plot.frf(hz, rest.frf(hz, "fz", "az"), backend="plotly")
    assert len(figure.data[0].y) == 100 and figure.layout.yaxis.type == "log"
    assert sum(len(trace.x) for trace in funicular.plot.modes(modes, backend="plotly").data) == 147
    with pytest.raises(funicular.InputError, match="matplotlib or plotly"):
        funicular.plot.modes(modes, backend="bokeh")  # type: ignore[arg-type]


def test_modules_import_each_other_in_one_direction() -> None:
    """No import of the package's own modules stands in a function, and there is no circle of imports."""
    folder = HERE.parent / "python/funicular"
    imports: dict[str, set[str]] = {}
    for path in folder.glob("*.py"):
        tree = ast.parse(path.read_text())
        nodes = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
        own = [node for node in nodes if (node.module or "").startswith("funicular")]
        assert set(own) <= set(tree.body), f"{path.name}: an import of the package's own modules is not at the top"
        names = [node.module.removeprefix("funicular").lstrip(".") for node in own if node.module]
        names += [alias.name for node in own if node.module == "funicular" for alias in node.names]
        imports[path.stem] = {name for name in names if (folder / f"{name}.py").exists()}
    assert imports["_results"] == {"_errors", "_reading", "_show"}, "results know no presentation"

    order: list[str] = []
    while len(order) < len(imports):
        free = [name for name, needed in imports.items() if name not in order and needed <= set(order)]
        assert free, f"a circle of imports among {sorted(set(imports) - set(order))}"
        order += free
