# SPDX-License-Identifier: BSD-3-Clause
"""The examples in Python of docs/ and of examples/ do what they say."""

import doctest
import importlib.util
import os
import pathlib
import re
import runpy
import subprocess
import sys
import warnings

import pytest

import petzval as pz

ROOT = pathlib.Path(__file__).parents[2]


@pytest.mark.parametrize("page, least", [("PYTHON.md", 20), ("HOWTO_RESTORATION.md", 10)])
def test_page(page, least, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "docs" / page).read_text()
    unfenced = re.sub(r"^```.*$", "", text, flags=re.MULTILINE)
    examples = doctest.DocTestParser().get_doctest(unfenced, {}, page, f"docs/{page}", 0)
    assert len(examples.examples) > least
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pz.Note)
        runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE)
        assert runner.run(examples).failed == 0


BLOCKS = re.findall(r"^```py\n(.*?)^```$", (ROOT / "docs" / "PYTHON.md").read_text(), re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("block", BLOCKS, ids=range(len(BLOCKS)))
def test_script_of_the_page(block, tmp_path):
    """What is no dialogue: a progress bar, a pool of processes."""
    for package in re.findall(r"^(?:import|from) (\w+)", block, re.MULTILINE):
        pytest.importorskip(package)
    given = "" if "import petzval" in block else (
        "import petzval as pz\ncamera = pz.Camera('edmund-54852', sensor='64x48@50')\n")
    script = tmp_path / "script.py"
    script.write_text(given + block)
    subprocess.run([sys.executable, "-W", "ignore", script], cwd=tmp_path, check=True)


def test_readme(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    block = re.search(r"^```python\n(.*?)^```$", (ROOT / "README.md").read_text(), re.MULTILINE | re.DOTALL)
    exec(block[1], {})
    assert (tmp_path / "studio.png").stat().st_size > 10000


def run_as_notebook(source, folder):
    """As Jupyter runs it, cell by cell, with what each cell shows."""
    notebook = os.fspath(folder / f"{source.stem}.ipynb")
    subprocess.run([sys.executable, "-m", "jupytext", "--quiet", "--to", "ipynb", "--output", notebook, source], check=True)
    run = subprocess.run([sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--nbmake", "--nbmake-timeout=1200",
                          notebook], cwd=folder, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr


@pytest.mark.parametrize("script", sorted(path.name for path in (ROOT / "examples" / "python").glob("*.py")))
def test_example(script, tmp_path, monkeypatch):
    """As a notebook where jupytext and nbmake are there, else as a plain script."""
    source = ROOT / "examples" / "python" / script
    for package in re.findall(r"^(?:import|from) (\w+)", source.read_text(), re.MULTILINE):
        pytest.importorskip(package)
    if all(importlib.util.find_spec(each) for each in ("jupytext", "nbmake", "ipykernel")):
        return run_as_notebook(source, tmp_path)
    monkeypatch.chdir(tmp_path)
    runpy.run_path(os.fspath(source), run_name="__main__")
