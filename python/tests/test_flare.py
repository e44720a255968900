# SPDX-License-Identifier: BSD-3-Clause
"""Light that goes astray is the program's."""

import numpy as np
import pytest

import petzval as pz

SHOT = ["studio", "--lens", "cooke-triplet", "--sensor", "64x48@300", "--wavelengths", "450,550,650", "--surround", "extend",
        "--method", "none"]
SCENE = pz.SceneRequest("studio", wavelengths_nm=[450, 550, 650])


@pytest.fixture
def camera():
    return pz.Camera("cooke-triplet", sensor="64x48@300")


def test_suns_and_ghosts(program, camera):
    told = program.json("image", *SHOT, "--sun", "12,6", "--sun", "-30,4:20000", "--ghosts", "--ghost-neglect", 1e-3,
                        "--ghost-reflections", 4, "--sun-diameter", 1, "--sun-light", "D65", "--ghost-layer", "ghosts.npy", "-o",
                        "light.npy")["flare"]
    suns = [pz.Sun(12, 6, diameter_deg=1, light="D65"), pz.Sun(-30, 4, illuminance_lx=20000, diameter_deg=1, light="D65")]
    keywords = dict(surround="extend", method="none", suns=suns, ghosts=True, ghost_neglect=1e-3, ghost_reflections=4)
    light, flare = camera.image_and_flare(SCENE, **keywords)
    assert np.array_equal(np.load(program.folder / "light.npy"), light.values)
    assert np.array_equal(np.load(program.folder / "ghosts.npy"), flare.ghosts.values)
    assert np.array_equal(light.values, camera.image(SCENE, **keywords).values)
    assert flare.sources == told["sources"] and flare.ways == told["ways"]
    for name in ("ways_neglected", "neglected_share", "flux_w_per_nm", "frame_flux_w_per_nm"):
        assert getattr(flare, name) == told[name], name
    for ours, theirs in zip(flare.pairs, told["pairs"], strict=True):
        assert {**ours, "seconds": 0} == {**theirs, "seconds": 0}


def test_stars(program, camera):
    program.run("image", *SHOT, "--f-number", 11, "--set", 'surfaces[3].blades={"count":7}', "--sun", "6,4", "--starburst", "-o",
                "star.npy")
    camera.lens.surfaces[3].blades = (7, 0)
    camera.f_number = 11
    light, flare = camera.image_and_flare(SCENE, surround="extend", method="none", suns=["6,4"], starburst=True)
    assert np.array_equal(np.load(program.folder / "star.npy"), light.values)
    assert flare.ghosts is None and flare.stars is not None


def test_layers_add_up(camera):
    keywords = dict(surround="extend", method="none")
    plain = camera.image(SCENE, **keywords)
    light, flare = camera.image_and_flare(SCENE, suns=[pz.Sun(5, 3)], ghosts=True, **keywords)
    layers = flare.suns.values.astype(float) + flare.ghosts.values
    assert plain.values + layers == pytest.approx(light.values, rel=1e-5)
    flare.add_to(plain)
    assert np.array_equal(plain.values, light.values)


def test_in_three_dimensions(program):
    program.run("render", "lamps", "--lens", "dgauss-50mm", "--focus", "0.6m", "--size", "30x20", "--spp", 2, "--wavelengths",
                "450,550", "--sun", "12,3", "--ghosts", "--ghost-layer", "ghosts.npy", "-o", "light.npy")
    rendering = pz.Camera("dgauss-50mm", focus="0.6m").render("lamps", size=(30, 20), samples_per_pixel=2,
                                                              wavelengths_nm=[450, 550], suns=["12,3"], ghosts=True)
    assert np.array_equal(np.load(program.folder / "light.npy"), rendering.light.values)
    assert np.array_equal(np.load(program.folder / "ghosts.npy"), rendering.flare.ghosts.values)


def test_layers_live_as_long_as_their_views(camera):
    ghosts = camera.image_and_flare(SCENE, surround="extend", method="none", suns=["5,3"], ghosts=True)[1].ghosts
    assert not ghosts.values.flags.owndata and ghosts.values.sum() > 0


@pytest.mark.parametrize("keywords, wrong", [
    ({"suns": ["12"]}, "`suns`"), ({"suns": [pz.Sun(85, 0)]}, "`suns`"), ({"suns": [pz.Sun(1, 0, light="moonshine")]}, "moonshine"),
    ({"suns": [pz.Sun(1, 0, diameter_deg=-1)]}, "`diameter_deg`"), ({"ghosts": True, "ghost_threshold": -1}, "`ghost_threshold`"),
    ({}, "`suns`, `ghosts` or `starburst`")])
def test_what_is_wrong(camera, keywords, wrong):
    with pytest.raises(pz.InputError, match=wrong):
        camera.image_and_flare(SCENE, surround="extend", method="none", **keywords)


def test_a_sun_says_what_it_is():
    assert repr(pz.Sun(20, 15)) == "Sun(20.0, 15.0, illuminance_lx=100000.0, diameter_deg=0.53, light='5772K')"


def test_flare_can_be_stopped(camera):
    with pytest.raises(pz.Cancelled):
        camera.image(SCENE, surround="extend", method="none", suns=["5,3"], ghosts=True, progress=lambda *_: False)
