# SPDX-License-Identifier: BSD-3-Clause
"""Calls that fit no signature say which argument is wrong, and what would be right."""

import inspect
import pickle

import numpy as np
import pytest

import petzval as pz


@pytest.mark.parametrize("call, parameter, text", [
    (lambda c: c.image("studio", sorround="zero"), "sorround", "Camera.image() has no keyword `sorround`; `surround` would be right"),
    (lambda c: c.shoot("studio", 3, pan_deg=3), "pan_deg", "`pan_deg_per_s` would be right"),
    (lambda c: pz.Camera("edmund-54852", fnumber=4), "fnumber", "Camera() has no keyword `fnumber`; `f_number` would be right"),
    (lambda c: pz.SceneRequest("studio", distance=1), "distance", "`distance_m` would be right"),
    (lambda c: pz.Lens("edmund-54852", substitution={}), "substitution", "`substitutions` would be right"),
    (lambda c: pz.Surface(5, thickness=3), "thickness", "`thickness_mm` would be right"),
    (lambda c: pz.sfr(np.zeros((9, 9)), chanel="red"), "chanel", "sfr() has no keyword `chanel`; `channel` would be right"),
    (lambda c: c.lens.tolerance(acept=3), "acept", "`accept` would be right"),
    (lambda c: c.lens.spots([0], wavelength_nm=[550]), "wavelength_nm", "`wavelengths_nm` would be right"),
    (lambda c: c.image("studio", supersample="2"), "supersample", "`supersample` of Camera.image() is a str; int would be right"),
    (lambda c: pz.Camera("edmund-54852", f_number="fast"), "f_number", "`f_number` of Camera() is a str; float or None would be right"),
    (lambda c: c.expose("light"), "light", "`light` of Camera.expose() is a str; SpectralImage would be right"),
    (lambda c: c.image("studio", suns=[3]), "suns", "`suns` of Camera.image() is a list; Sequence[Sun or str] would be right"),
    (lambda c: c.image(), "scene", "Camera.image() needs `scene`"),
    (lambda c: c.lens.altered("name"), "value", "Lens.altered() needs `value`"),
    (lambda c: c.image("studio", "product"), None, "Camera.image() takes one argument without a keyword; `method`"),
    (lambda c: pz.LensDataTable.load(3), "path", "`path` of LensDataTable.load() is a int; str would be right")])
def test_misfits(camera, call, parameter, text):
    with pytest.raises(pz.CallError) as caught:
        call(camera)
    assert text in str(caught.value) and caught.value.parameter == parameter
    assert isinstance(caught.value, TypeError) and isinstance(caught.value, pz.InputError)
    assert "incompatible" not in str(caught.value) and len(str(caught.value)) < 700


def test_functions_still_say_what_they_take():
    assert "surround: str" in pz.Camera.image.__doc__ and pz.Camera.image.__name__ == "image"
    assert "Exposes the sensor" in inspect.getdoc(pz.Camera.expose)


def test_other_exceptions_pass(camera):
    class Stop(TypeError):
        pass

    def progress(*_):
        raise Stop("mine")
    with pytest.raises(Stop, match="mine"):
        camera.image("studio", progress=progress)
    with pytest.raises(TypeError, match="from_reflectance"):
        camera.image(3)


def test_subclasses():
    class Zoom(pz.Lens):
        pass
    assert isinstance(Zoom("edmund-54852"), Zoom)
    with pytest.raises(TypeError):
        Zoom("edmund-54852", substitution={})


def test_call_errors_survive_processes():
    error = pickle.loads(pickle.dumps(pz.CallError("what", "better", parameter="name")))
    assert isinstance(error, pz.CallError) and str(error) == "what; better" and error.parameter == "name"
