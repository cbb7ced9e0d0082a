"""Runs the notebooks of docs/notebooks, each in a fresh kernel of the Python that has the package, and checks that every
one shows as many pictures as its metadata say. The site shows them with their outputs."""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

from pages import ROOT

FOLDER = ROOT / "docs/notebooks"
PATIENCE_S = 300
WIDGET = "application/vnd.jupyter.widget-view+json"
IN_PLACE_OF_WIDGET = (
    "<p>In a notebook the page is here, and what you change comes back to Python. "
    '<a href="../live.html">The page in this site</a> runs without a notebook.</p>'
)


def _kernel(python: str, folder: Path) -> None:
    """Kernel of a Python, in a folder that Jupyter searches."""
    made = folder / "kernels/funicular"
    made.mkdir(parents=True)
    arguments = [python, "-m", "ipykernel_launcher", "-f", "{connection_file}", "--log-level=40"]
    (made / "kernel.json").write_text(json.dumps({"argv": arguments, "display_name": "funicular", "language": "python"}))


def pictures(notebook: nbformat.NotebookNode) -> int:
    """Number of pictures that the cells show."""
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    return sum("image/png" in output.get("data", {}) for output in outputs)


def _without_widgets(notebook: nbformat.NotebookNode) -> None:
    """A page without a kernel cannot drive a widget, and its scripts would come from a network: the texts stay."""
    notebook.metadata.pop("widgets", None)
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            if output.get("data", {}).pop(WIDGET, None):
                output["data"]["text/html"] = IN_PLACE_OF_WIDGET


def write(python: str, to: Path) -> None:
    """Runs all notebooks and writes them with their outputs."""
    to.mkdir(parents=True, exist_ok=True)
    version = subprocess.run([python, "-c", "import funicular; print(funicular.__version__)"], capture_output=True, text=True, check=False)
    if version.returncode != 0:
        raise RuntimeError(f"{python} has no package funicular: FUNICULAR_PYTHON has to name one that has\n{version.stderr}")
    with tempfile.TemporaryDirectory() as folder:
        _kernel(python, Path(folder))
        os.environ["JUPYTER_PATH"] = folder
        for path in sorted(FOLDER.glob("*.ipynb")):
            notebook = nbformat.read(path, as_version=4)
            client = NotebookClient(notebook, timeout=PATIENCE_S, kernel_name="funicular", resources={"metadata": {"path": str(ROOT)}})
            try:
                client.execute()
            except CellExecutionError as error:
                raise RuntimeError(f"{path.name}: {error}") from error
            wanted = promised(notebook)
            if pictures(notebook) != wanted:
                raise RuntimeError(f"{path.name}: {pictures(notebook)} pictures, its metadata say {wanted}")
            _without_widgets(notebook)
            nbformat.write(notebook, to / path.name)
            print(f"{path.name}: {wanted} pictures", file=sys.stderr)


def promised(notebook: nbformat.NotebookNode) -> int:
    """Number of pictures that a notebook promises."""
    return int(notebook.metadata["funicular"]["pictures"])
