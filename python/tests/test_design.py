# SPDX-License-Identifier: BSD-3-Clause
"""Lenses as they are built, and better ones: the same as the program's."""

import numpy as np
import petzval as pz
import pytest


def test_tolerances_are_the_programs(program):
    lens = pz.Lens("cooke-triplet")
    ours = lens.tolerance([0, 14], builds=20, accept=16, seed=3)
    theirs = program.json("lens", "tolerance", "cooke-triplet", "--fields", "0,14", "--builds", 20, "--accept", 16,
                          "--seed", 3)
    assert [row["worst_change"] for row in ours.tables["rows"].rows] == [row["worst_change"] for row in theirs["rows"]]
    assert ours.facts["yield"] == [theirs["yield"], *theirs["yield_interval_95"]]
    assert ours.tables["builds"]["overall"].shape == (20,)
    assert "svg" in str(ours.plot)[:200]


def test_a_record_of_builds_serves_the_program(program, tmp_path):
    record = str(tmp_path / "builds.txt")
    lens = pz.Lens("cooke-triplet")
    lens.tolerance([0, 14], wavelengths_nm=[550], builds=6, seed=3, record=record)
    kept = (tmp_path / "builds.txt").read_bytes()
    theirs = program.json("lens", "tolerance", "cooke-triplet", "--fields", "0,14", "--wavelengths", "550", "--builds", 6,
                          "--seed", 3, "--record", record)
    assert (tmp_path / "builds.txt").read_bytes() == kept
    assert theirs["builds"] == 6
    with pytest.raises(pz.InputError, match="not the same seed"):
        lens.tolerance([0, 14], wavelengths_nm=[550], builds=6, seed=4, record=record)


def test_a_build_is_the_row_of_its_number():
    lens = pz.Lens("cooke-triplet")
    worst = lens.tolerance(builds=3).tables["builds"]["worst"]
    # Judged where it stands: focused already, nothing to gain.
    again = [lens.built(n).tolerance(builds=0, tolerances=["thickness_mm@1=1e-9"]).facts["designed_worst"][0]
             for n in range(3)]
    np.testing.assert_allclose(again, worst, rtol=1e-6)
    assert lens.built(0).to_json() != lens.built(1).to_json() == lens.built(1).to_json()


def test_an_optimised_lens_is_better():
    lens = pz.Lens("cooke-triplet")
    better, report = lens.optimise(["radii", "gaps", "image"])
    assert report.facts["after"][0] < report.facts["before"][0]
    assert better.efl_mm == pytest.approx(lens.efl_mm, rel=1e-3)
    assert len(report.tables["numbers"].rows) == 9


def test_a_decentred_lens_is_aligned():
    lens = pz.Lens("cooke-triplet")
    lens.sensor_pose = {"tilt_x_deg": 0.2}
    better, report = lens.optimise(["poses"])
    assert [row["number"] for row in report.tables["numbers"].rows] == ["sensor_pose.tilt_x_deg"]
    assert better.sensor_pose["tilt_x_deg"] == pytest.approx(0, abs=2e-3)
    with pytest.raises(pz.InputError, match="azimuth"):
        lens.optimise(["poses"], azimuths_deg=[float("nan")])


def test_rays_alone_make_a_lens(program, tmp_path):
    table = tmp_path / "rays.csv"
    program.run("lens", "transfer", "cooke-triplet", "--set", "aperture.f_number=8", "--bands", 550, "--film-radius", 8, "-o", table)
    box = pz.Lens.from_rays(str(table), tolerance_mm=1e-3)
    assert box.efl_mm == pytest.approx(pz.Lens("cooke-triplet").efl_mm, rel=1e-4)
    with pytest.raises(pz.InputError, match="rays"):
        table.write_text("".join(table.read_text().splitlines(keepends=True)[:60]))
        pz.Lens.from_rays(str(table))


def test_errors_say_what_would_be_right():
    lens = pz.Lens("cooke-triplet")
    with pytest.raises(pz.InputError, match="commercial"):
        lens.built(0, grade="best")
    with pytest.raises(pz.InputError, match="radii, thicknesses"):
        lens.optimise(["bendings"])


def test_glasses_are_chosen():
    lens = pz.Lens("plano-convex")
    better, report = lens.optimise(glasses=5)
    assert better.surfaces[0].glass != lens.surfaces[0].glass
    assert report.facts["after"][0] < lens.optimise()[1].facts["after"][0]
    assert report.tables["glasses"].rows[0]["glass"] in str(better.surfaces[0].glass)
    with pytest.raises(pz.InputError, match="element_tilt_deg"):
        lens.tolerance(tolerances=["tilt=3"])


def test_a_tilted_plane_has_depth():
    flat = pz.SceneRequest("grid", width_m=0.2, distance_m=0.5, wavelengths_nm=[550]).read()
    assert flat.horizontal_angle_deg == pytest.approx(2 * np.degrees(np.arctan(0.2)))
    tilted = pz.SceneRequest("grid", width_m=0.2, distance_m=0.5, tilt_deg=30, wavelengths_nm=[550]).read()
    assert tilted.depth_m is not None and np.ptp(tilted.depth_m) > 0.05


def test_a_build_is_found_from_its_photograph():
    """The sensor 40 um too near, on a picture with noise: within four of the stated deviations."""
    lens = pz.Lens("cooke-triplet").scaled(0.2)
    near = lens.copy()
    near.surfaces[-1].thickness_mm -= 0.04
    sensor = pz.Sensor("icx625-mono", {"columns": 240, "rows": 200})
    camera = pz.Camera(near, focus="design", sensor=sensor)
    raw = camera.expose(camera.image(pz.SceneRequest("slanted-board:5", wavelengths_nm=[550])), seed=1)
    built, report = lens.fit_build(pz.sfr(raw), sensor=sensor, wavelengths_nm=[550], free=["defocus_mm"])
    value, deviation = report["value"][0], report["deviation"][0]
    assert abs(value + 0.04) < 4 * deviation < 0.01
    assert built.surfaces[-1].thickness_mm == pytest.approx(lens.surfaces[-1].thickness_mm + value, abs=1e-9)
