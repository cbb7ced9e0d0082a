"""Files for citing: what is made from CITATION.cff, the paper, and what a release refuses to publish."""

import importlib.util
import json
import re
import subprocess
import sys
from types import ModuleType

import pytest
from conftest import ROOT

PAPER = (ROOT / "paper/paper.md").read_text()


@pytest.fixture(scope="module")
def citation() -> ModuleType:
    spec = importlib.util.spec_from_file_location("citation", ROOT / "scripts/citation.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_files_are_those_of_the_citation_and_name_persons(citation: ModuleType) -> None:
    texts = citation.texts()
    assert texts == {name: (ROOT / name).read_text() for name in ("codemeta.json", ".zenodo.json")}
    authors = [
        {
            "given-names": "Ada",
            "family-names": "Rope",
            "orcid": "https://orcid.org/0000-0001-2345-6789",
            "affiliation": "A",
        },
        {"name": "The makers"},
    ]
    person, makers = citation.persons(authors)
    assert person["@id"] == authors[0]["orcid"] and person["familyName"] == "Rope"
    assert makers == {"@type": "Organization", "name": "The makers"}
    assert citation.creators(authors)[0] == {"name": "Rope, Ada", "affiliation": "A", "orcid": "0000-0001-2345-6789"}
    assert json.loads(texts[".zenodo.json"])["title"].startswith("funicular: ")


def test_a_release_is_refused_while_places_are_open(citation: ModuleType) -> None:
    done = subprocess.run([sys.executable, ROOT / "scripts/citation.py", "--publish"], capture_output=True, text=True, check=False)
    marks = PAPER.count(citation.MARK)
    assert (done.returncode == 1) == (marks > 0)
    assert done.stderr.count("paper/paper.md:") == marks
    filled = "authors:\n  - family-names: Rope\nrepository-code: x\ndate-released: 2030-01-01\ndoi: 10.5281/z.1\n"
    assert citation.open_places("# Summary", filled) == []
    assert len(citation.open_places("FILL IN: names", "authors:\n  - name: All\nrepository-code: x\n")) == 4


def test_the_paper_has_the_form_of_its_journal() -> None:
    _, head, text = PAPER.split("---\n", 2)
    assert len(text.split()) <= 1750
    sections = re.findall(r"^# (.+)$", text, re.MULTILINE)
    assert sections == [
        "Summary",
        "Statement of need",
        "State of the field",
        "Software design",
        "Research impact statement",
        "AI usage disclosure",
        "Acknowledgements",
        "References",
    ]
    for key in ("title:", "tags:", "authors:", "affiliations:", "date:", "bibliography: paper.bib"):
        assert key in head
    entries = re.findall(r"^@\w+\{(\w+),$", (ROOT / "paper/paper.bib").read_text(), re.MULTILINE)
    assert len(entries) == len(set(entries)) and set(re.findall(r"@(\w+\d{4})", text)) == set(entries)


def test_the_numbers_of_the_paper_are_those_of_the_program() -> None:
    robots = [path for path in (ROOT / "robots").glob("*.toml") if path.name != "Cargo.toml"]
    assert len(robots) == 17 and "seventeen robot files" in PAPER
    passed = re.search(r"^(\d+) of (\d+) comparisons pass\b", (ROOT / "docs/validation.md").read_text(), re.MULTILINE)
    assert passed and passed[1] == passed[2] and int(passed[1]) > 1400 and "more than 1,400 comparisons" in PAPER
