# SPDX-License-Identifier: BSD-3-Clause
"""The examples of docs/PYTHON.md and of examples/ do what they say."""

import doctest
import os
import pathlib
import re
import runpy
import warnings

import pytest

import petzval as pz

ROOT = pathlib.Path(__file__).parents[2]


def test_python_page(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "docs" / "PYTHON.md").read_text()
    unfenced = re.sub(r"^```.*$", "", text, flags=re.MULTILINE)
    examples = doctest.DocTestParser().get_doctest(unfenced, {}, "PYTHON.md", "docs/PYTHON.md", 0)
    assert len(examples.examples) > 20
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pz.Note)
        runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE)
        assert runner.run(examples).failed == 0


def test_readme(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    block = re.search(r"^```python\n(.*?)^```$", (ROOT / "README.md").read_text(), re.MULTILINE | re.DOTALL)
    exec(block[1], {})
    assert (tmp_path / "studio.png").stat().st_size > 10000


@pytest.mark.parametrize("script", sorted(path.name for path in (ROOT / "examples" / "python").glob("*.py")))
def test_example(script, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    pytest.importorskip("scipy")
    runpy.run_path(os.fspath(ROOT / "examples" / "python" / script), run_name="__main__")
