# SPDX-License-Identifier: BSD-3-Clause
"""Data sets: the same bytes as the program's, and items as arrays."""

import json
import pathlib

import numpy as np
import petzval as pz
import pytest
from petzval import dataset

RECIPE = {
    "format": "petzval-dataset/1", "items": 3, "items_per_part": 2, "seed": 5,
    "parameters": {"lens": "edmund-54852", "stop_down_ev": {"uniform": [0, 2]}, "scene": "grid",
                   "sensor": "full-frame-24mp"},
    "sensor_set": ["columns=48", "rows=32"], "wavelengths_nm": "500,600", "tolerance": 0.02,
    "truth": ["raw", "sharp", "psf", "rays", "electrons"], "psf_grid": {"rows": 1, "columns": 2, "size": 5}}


def test_bytes_are_the_programs(tmp_path, program):
    path = tmp_path / "recipe.json"
    path.write_text(json.dumps(RECIPE))
    assert dataset.make(path, tmp_path / "ours")["items"] == 3
    program.json("dataset", "make", path, "-o", tmp_path / "theirs")
    ours = {file.name: file.read_bytes() for file in (tmp_path / "ours").iterdir()}
    assert len(ours) == 7
    assert ours == {file.name: file.read_bytes() for file in (tmp_path / "theirs").iterdir()}
    assert dataset.verify(tmp_path / "ours") == []
    assert dataset.info(tmp_path / "ours")["items_done"] == 3


def test_items_are_arrays_that_agree_with_each_other(tmp_path):
    dataset.make(RECIPE, tmp_path / "set")
    items = dataset.Dataset(tmp_path / "set", only=["psf", "electrons", "raw", "rays"])
    assert len(items) == 3 and items[-1]["facts"]["item"] == 2
    item = items[1]
    assert item["psf"].shape == (1, 2, 2, 5, 5) and item["rays"].shape == (32, 48, 2)
    assert "picture" not in item and item["raw"][:2] == b"II"
    # Electrons without noise against the noisy raw image: within one per cent, many times the deviation of the mean.
    facts = item["facts"]["picture"]
    path = tmp_path / "item.dng"
    path.write_bytes(item["raw"])
    raw = pz.Raw.load(str(path))
    signal = (np.asarray(raw.linear_values, float) - facts["black_dn"]) / facts["dn_per_e"]
    mean, expected = signal.mean(), item["electrons"].mean()
    assert mean == pytest.approx(expected, rel=0.01)
    with pytest.raises(IndexError):
        items[3]


def test_recipes_fit_the_published_schema():
    jsonschema = pytest.importorskip("jsonschema")
    docs = pathlib.Path(__file__).parents[2] / "docs"
    valid = jsonschema.Draft202012Validator(json.loads((docs / "dataset-recipe.schema.json").read_text())).is_valid
    assert valid(RECIPE)
    parameters = {**RECIPE["parameters"], "light_kelvin@1": {"normal": [4000, 500], "within": [2700, 6500]}, "world": "spheres"}
    del parameters["scene"]
    assert valid({**RECIPE, "parameters": parameters})
    for wrong in ({"items": 0}, {"format": "petzval-dataset/2"}, {"truth": ["shape"]}, {"extra": 1}, {"bits": 12},
                  {"psf_grid": {"size": 4}}, {"parameters": {"lens": "x", "sensor": "y"}},
                  {"parameters": {**RECIPE["parameters"], "f_number": {"uniform": [1, 2], "choose": [1]}}},
                  {"parameters": {**RECIPE["parameters"], "f_number": "wide"}}, {"parameters": {**parameters, "scene": "grid"}}):
        assert not valid({**RECIPE, **wrong}), wrong
        with pytest.raises(pz.InputError):
            dataset.estimate({**RECIPE, **wrong}, probes=1)


def test_errors_say_what_would_be_right(tmp_path):
    with pytest.raises(pz.InputError, match="no parameter"):
        dataset.make({**RECIPE, "parameters": {"lenz": 1}}, tmp_path / "set")
    dataset.make(RECIPE, tmp_path / "set", shard=(0, 2))
    with pytest.raises(pz.InputError, match="another recipe"):
        dataset.make({**RECIPE, "seed": 6}, tmp_path / "set")
    with pytest.raises(pz.Cancelled):
        dataset.make(RECIPE, tmp_path / "set", progress=lambda fraction, what: False)
