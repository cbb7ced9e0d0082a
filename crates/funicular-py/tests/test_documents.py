"""Python code of the documents runs as it stands, in the order of a page; printed values are those in its comments."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

PAGES = ["quick-start", "workspace", "measuring", "matlab", "python", "tutorials/controller"]


@pytest.mark.parametrize("page", PAGES)
def test_the_code_of_a_page_runs_and_prints_what_it_shows(page: str, tmp_path: Path) -> None:
    blocks = re.findall(r"^```python\n(.*?)^```", (ROOT / f"docs/{page}.md").read_text(), re.DOTALL | re.MULTILINE)
    assert blocks
    code = "\n".join(blocks)
    for folder in ("robots", "docs"):
        os.symlink(ROOT / folder, tmp_path / folder)
    (tmp_path / "page.py").write_text(code)

    done = subprocess.run(
        [sys.executable, "page.py"],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env={**os.environ, "MPLBACKEND": "Agg"},
        check=False,
    )
    assert done.returncode == 0, done.stderr

    # Every line that prints has its output in a comment.
    assert len(re.findall(r"^ *print\(", code, re.MULTILINE)) == len(re.findall(r"^ *print\(.*\)  # ", code, re.MULTILINE))
    assert re.findall(r"^ *print\(.*\)  # (.*)$", code, re.MULTILINE) == done.stdout.splitlines()
