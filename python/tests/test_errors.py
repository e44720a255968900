# SPDX-License-Identifier: BSD-3-Clause
"""What is wrong, where, and what would be right."""

import pathlib
import pickle
import re
import warnings

import numpy as np
import pytest

import petzval as pz
from petzval import _errors, _petzval


def test_parts(tmp_path):
    path = tmp_path / "lens.json"
    path.write_text('{"format": "petzval-lens/1",\n "name": 3}')
    with pytest.raises(pz.InputError) as caught:
        pz.Lens(str(path))
    assert caught.value.file == str(path) and caught.value.line
    assert str(caught.value).startswith(f"{path}:{caught.value.line}:")
    assert isinstance(caught.value, ValueError) and isinstance(caught.value, pz.Error)


def test_keywords(camera):
    with pytest.raises(pz.InputError) as caught:
        camera.image("studio", surround="beyond")
    assert (caught.value.parameter, caught.value.remedy) == ("surround", "error, zero or extend would be right")
    with pytest.raises(pz.InputError) as caught:
        camera.focus = "3"
    assert caught.value.parameter == "focus" and "3m or 3mm" in caught.value.remedy
    with pytest.raises(pz.InputError) as caught:
        camera.image(pz.SceneRequest("studio", horizontal_angle_deg=5))
    assert "scene." not in str(caught.value) and "--" not in str(caught.value)


def test_nearest_names():
    with pytest.raises(pz.InputError, match="edmund-54852"):
        pz.Lens("edmund-54582")
    with pytest.raises(pz.InputError, match="H-LAK10"):
        pz.Glass("H-LAK100")


def test_errors_survive_processes():
    error = pz.InputError("`focus` 3: a length needs its unit", "3m would be right", "a.json", 3, 7, "focus")
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.line, again.column, again.parameter) == (str(error), 3, 7, "focus")


def test_a_full_disk(light):
    with pytest.raises(pz.Error):
        light.save("/dev/full/light.npy")


def test_notes_are_warnings(camera):
    with pytest.warns(pz.Note, match="`focus_wavelength_nm` sets another") as notes:
        camera.image(pz.SceneRequest("studio", wavelengths_nm=[550]), method="none")
    assert notes[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error", pz.Note)
        with pytest.raises(pz.Note):
            camera.image(pz.SceneRequest("studio", wavelengths_nm=[550]), method="none")


def test_other_types_are_refused_with_what_would_be_right(tmp_path):
    camera = pz.Camera("edmund-54852", sensor="32x24@100")
    with pytest.raises(TypeError, match="from_reflectance"):
        camera.image(np.zeros((24, 32, 3), np.float32))
    with pytest.raises(TypeError, match="a Lens would be right"):
        pz.Camera(5)
    with pytest.raises(TypeError, match="768x576@6.25"):
        pz.Camera("edmund-54852", sensor=(32, 24))
    pz.Lens("edmund-54852").save(str(tmp_path / "mine.json"))
    assert pz.Camera(tmp_path / "mine.json").lens.efl_mm == camera.lens.efl_mm
    with pytest.raises(pz.InputError, match=r"field 5 \(paraxial_image_height_mm\)"):
        camera.psf([5], field_type="paraxial_image_height_mm", wavelengths_nm=[550])
    stack = camera.psf([0], wavelengths_nm=[550], size=32)
    assert stack.shape == stack.values.shape


# Of the part of the library that the package does not have: the bench in a browser.
NOT_IN_PYTHON = {"port"}


def keywords(scope):
    """Names of the arguments of all functions below, and of all attributes."""
    names = set()
    for name in dir(scope):
        value = getattr(scope, name)
        for signature in getattr(value, "__nb_signature__", None) or ():
            names |= set(re.findall(r"[(,*] ?(\w+):", signature[0]))
        if isinstance(value, type) and not name.startswith("__"):
            names |= {each for each in dir(value) if not each.startswith("_")} | keywords(value)
    return names


def test_every_parameter_is_a_keyword():
    """What the library's messages name in backquotes is a keyword or an attribute of the package."""
    source = pathlib.Path(__file__).parents[2] / "src" / "petzval"
    if not source.is_dir():
        pytest.skip("the sources are not here")
    literal, name = re.compile(r'"((?:[^"\\\n]|\\.)*)"'), re.compile(r"`([a-z][a-z0-9_.]*)`")
    named = {each for path in source.rglob("*.[hc]*") for line in path.read_text().splitlines()
             if not line.lstrip().startswith("//") for text in literal.findall(line) for each in name.findall(text)}
    assert len(named) > 40
    known = keywords(_petzval) | set(dir(_petzval))
    unknown = {each for each in named if _errors.keyword(each).partition(",")[0] not in known}
    assert unknown == NOT_IN_PYTHON


@pytest.mark.parametrize("spoil", [
    lambda lens: setattr(lens, "surfaces", []), lambda lens: setattr(lens.surfaces[3], "stop", False),
    lambda lens: setattr(lens.surfaces[2], "thickness_mm", float("nan")),
    lambda lens: setattr(lens.surfaces[0], "asphere", {-3: 1.0}), lambda lens: setattr(lens.surfaces[0], "shape", {"kind": "qcon"}),
    lambda lens: setattr(lens.surfaces[3], "blades", (10**6, 0)), lambda lens: setattr(lens, "wavelengths_nm", []),
    lambda lens: setattr(lens, "aperture", {"f_number": 0})])
def test_a_spoilt_lens_is_refused(spoil):
    lens = pz.Lens("cooke-triplet")
    spoil(lens)
    rays = np.zeros((1, 3)), np.ones((1, 3))
    for use in (lens.first_order, lens.psf, lens.spots, lens.draw, lens.to_json, lens.validate, lambda: lens.trace(*rays),
                lambda: pickle.dumps(lens), lambda: lens.save("lens.json"), lambda: lens.altered("name", "x"),
                lambda: pz.Camera(lens, sensor="8x8@100").image("studio"), lambda: pz.target(rectangle=(9, 9, 5), lens=lens)):
        with pytest.raises(pz.InputError):
            use()
    assert repr(lens) and repr(lens.surfaces)
