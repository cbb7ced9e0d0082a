"""Page of all figures with the lines that make them: those of the program are drawn while the site is built, those of the
Python scripts by scripts/test-python."""

import ast
import shutil
import subprocess
from pathlib import Path

from pages import ROOT

EXAMPLES = ROOT / "crates/funicular-py/examples"
STAGE = "docs/tutorials/stage.toml"
# Title, lines of the program, and the figure among the files that they write.
DRAWN = [
    ("The robot with its hanging cables", [f"statics {STAGE} -o robot.svg"], "robot.svg"),
    ("All natural frequencies, and how much the platform takes part", [f"modes {STAGE} --below-hz 8 -o spectrum.svg"], "spectrum.svg"),
    ("One mode", ["modes robots/cogiro.toml --below-hz 7 --figure-mode 18 -o shape.svg"], "shape.svg"),
    ("A response with its peaks", [f"frf {STAGE} --from-hz 0.5 --to-hz 10 --adaptive --input fz --output az -o response.svg"], "response.svg"),
    ("Errors of the cable models", [f"compare {STAGE} --below-hz 8 -o models.svg"], "models.svg"),
    (
        "A slice of the workspace",
        [f"map {STAGE} --grid x=-6:6:49 --grid y=-4:4:33 --grid z=2 --quantity tension-max -o map.parquet", "plot map.parquet --quantity tension-max -o tension.svg"],
        "tension.svg",
    ),
    (
        "Frequencies over a value",
        ["sweep robots/yuan2014-4mm.toml --vary platform.mass_kg=10.55:86.35:40 --quantity frequencies:8 -o sweep.parquet", "plot sweep.parquet --quantity frequencies:8 -o curves.svg"],
        "curves.svg",
    ),
]


def _drawn(program: str, folder: Path) -> str:
    """Figures of the program."""
    for name in ("robots", "docs"):
        (folder / name).symlink_to(ROOT / name)
    parts = []
    for title, lines, figure in DRAWN:
        for line in lines:
            done = subprocess.run([program, *line.split(" ")], cwd=folder, capture_output=True, text=True, check=False)
            if done.returncode != 0:
                raise RuntimeError(f"gallery: funicular {line}: {done.stderr}")
        listing = "\n".join(f"funicular {line}" for line in lines)
        parts.append(f"### {title}\n\n![{title}]({figure})\n\n```sh\n{listing}\n```")
    for name in ("robots", "docs"):
        (folder / name).unlink()
    return "\n\n".join(parts)


def _scripts() -> str:
    """Figures of the Python scripts."""
    parts = []
    for script in sorted(EXAMPLES.glob("*.py")):
        figure = ROOT / f"docs/figures/gallery/{script.stem}.png"
        source = script.read_text(encoding="utf-8")
        names = [script.stem] if figure.is_file() else ["bode", "map", "shape"] if script.stem == "journal" else []
        if not names:
            continue
        about = " ".join((ast.get_docstring(ast.parse(source)) or script.stem).split())
        pictures = "\n".join(f"![{name}](../figures/gallery/{name}.png)" for name in names)
        parts.append(f"### {script.stem}.py\n\n{about}\n\n{pictures}\n\n````{{dropdown}} The script\n```python\n{source.rstrip()}\n```\n````")
    return "\n\n".join(parts)


def write(program: str, sources: Path) -> None:
    """Writes the page with its figures."""
    folder = sources / "gallery"
    folder.mkdir(parents=True, exist_ok=True)
    text = (
        "# Gallery\n\nEvery figure of the program and of the Python package, with the lines that make it.\n\n"
        "## Figures of the program\n\nThese were drawn while this page was built. `-o FILE.pdf` gives the same figure for a paper.\n\n"
        f"{_drawn(program, folder)}\n\n## Figures of Python scripts\n\nThe scripts are in `crates/funicular-py/examples`.\n\n{_scripts()}\n"
    )
    shutil.copytree(ROOT / "docs/figures/gallery", sources / "figures/gallery", dirs_exist_ok=True)
    for path in folder.iterdir():
        if path.suffix != ".svg":
            path.unlink()
    (folder / "index.md").write_text(text, encoding="utf-8")
