# SPDX-License-Identifier: BSD-3-Clause
"""Scattered light: Camera.image(scatter=…) and lens.glare()."""

import numpy as np
import pytest

import petzval as pz


def test_scatter_takes_from_bright_points_and_gives_to_dark_places():
    camera = pz.Camera("cooke-triplet", sensor="48x32@500")
    scene = pz.SceneRequest("points:3", horizontal_angle_deg=30, wavelengths_nm=[550])
    plain, scattered = (np.asarray(camera.image(scene, method="none", surround="extend", scatter=each).values)
                        for each in (None, "roughness=4,dust=0.05"))
    assert scattered.max() < plain.max()
    assert (scattered[plain == 0] > 0).all()
    with pytest.raises(pz.InputError, match="roughness=1.5"):
        camera.image(scene, method="none", surround="extend", scatter="lens")


def test_glare_falls_with_the_square_of_the_roughness():
    lens = pz.Lens("cooke-triplet")
    two, one = (lens.glare([0, 15], scatter=f"roughness={nm}", wavelengths_nm=[550])["veiling_glare_index_percent"][0] for nm in (2, 1))
    assert two / one == pytest.approx(4, rel=0.01)
