# SPDX-License-Identifier: BSD-3-Clause
"""Apertures, poses, groups and tolerances of lenses, and lenses made of lenses."""

import json
import pickle

import numpy as np
import pytest

import petzval as pz

FIGURES = [{"rectangle": (8, 5), "decentre_mm": (0, 0.5), "rotation_deg": 30}, {"ellipse": (2, 1.5), "obscures": True}]


@pytest.fixture
def lens():
    return pz.Lens("cooke-triplet")


def test_apertures_are_those_of_the_file(program, lens):
    lens.surfaces[2].apertures = FIGURES
    in_file = json.loads(lens.to_json())["surfaces"][2]["apertures"]
    assert in_file == [{"rectangle": [8, 5], "decentre_mm": [0, 0.5], "rotation_deg": 30},
                       {"ellipse": [2, 1.5], "obscures": True}]
    assert [dict(each) for each in pz.Lens.from_json(lens.to_json()).surfaces[2].apertures] == FIGURES
    told = program.json("lens", "spots", "cooke-triplet", "--set", f"surfaces[2].apertures={json.dumps(in_file)}", "--fields", "0,10")
    assert lens.spots([0, 10])["rms_radius_um"].tolist() == [row["rms_radius_um"] for row in told["rows"]]


def test_apertures_stop_rays(lens):
    """On a plane of its own in front of the lens the law is the figure itself."""
    front = pz.Surface(None, 5, apertures=FIGURES)
    lens.surfaces.insert(0, front)
    y, x = np.mgrid[-9.03:9:0.5, -9.03:9:0.5]  # no point lies on an edge
    points = np.stack([x.ravel(), y.ravel(), np.full(x.size, -1.0)], 1)
    status = np.array(lens.trace(points, np.tile([0.0, 0, 1], (x.size, 1))).status)
    turn = np.radians(30)
    along = np.cos(turn) * x + np.sin(turn) * (y - 0.5)
    across = -np.sin(turn) * x + np.cos(turn) * (y - 0.5)
    open_ = (abs(along) < 8) & (abs(across) < 5) & ((x / 2) ** 2 + (y / 1.5) ** 2 > 1)
    lens.surfaces[0].apertures = ()
    without = np.array(lens.trace(points, np.tile([0.0, 0, 1], (x.size, 1))).status)
    assert ((without == "ok") & ~open_.ravel()).any() and ((without == "ok") & open_.ravel()).any()
    assert np.array_equal(status == "ok", (without == "ok") & open_.ravel())


def test_poses_are_those_of_the_file(program, lens):
    lens.surfaces[1].pose = {"tilt_x_deg": 0.2}
    lens.groups = [{"surfaces": (2, 3), "pose": {"decentre_y_mm": 0.05}, "pivot_mm": 1}]
    lens.sensor_pose = {"tilt_y_deg": -0.1}
    again = pz.Lens.from_json(lens.to_json())
    assert dict(again.surfaces[1].pose) == {"tilt_x_deg": 0.2} and dict(again.sensor_pose) == {"tilt_y_deg": -0.1}
    assert again.groups[0]["surfaces"] == (2, 3) and dict(again.groups[0]["pose"]) == {"decentre_y_mm": 0.05}
    program.folder.joinpath("lens.json").write_text(lens.to_json())
    told = program.json("lens", "spots", "lens.json", "--fields", "0,10", "--field-azimuth", 90)
    spots = lens.spots([0, 10], azimuth_deg=90)
    assert spots["rms_radius_um"].tolist() == [row["rms_radius_um"] for row in told["rows"]]
    assert not np.array_equal(spots["rms_radius_um"], lens.spots([0, 10])["rms_radius_um"])


def test_surfaces_survive_processes():
    surface = pz.Surface(50, 5, "N-BK7", semi_diameter_mm=10, stop=True, conic=-1, asphere={4: 1e-6}, blades=(7, 10),
                         apertures=FIGURES, pose={"shift_z_mm": 0.1})
    again = pickle.loads(pickle.dumps(surface))
    assert repr(again) == repr(surface)
    assert [dict(each) for each in again.apertures] == FIGURES and dict(again.pose) == {"shift_z_mm": 0.1}


def test_tolerances_of_the_lens(program, lens):
    lens.tolerances = ["element_tilt_deg@2-3=0.05", "radius_percent@1=0.2"]
    assert lens.tolerances == ("element_tilt_deg@2-3=0.05", "radius_percent@1=0.2")
    assert pz.Lens.from_json(lens.to_json()).tolerances == lens.tolerances
    program.folder.joinpath("lens.json").write_text(lens.to_json())
    told = program.json("lens", "tolerance", "lens.json", "--builds", 6, "--accept", 30, "--ignore-apertures")
    ours = lens.tolerance(builds=6, accept=30, ignore_apertures=True)
    for column in told["rows"][0]:
        assert list(ours[column]) == [row[column] for row in told["rows"]], column
    assert ours.facts["yield"][0] == told["yield"]


def test_scaled_and_reversed(program):
    program.run("lens", "scale", "double-gauss", "--efl", 25, "-o", "scaled.json")
    program.run("lens", "reverse", "tessar", "-o", "turned.json")
    scaled, turned = pz.Lens("double-gauss").scaled(efl_mm=25), pz.Lens("tessar").reversed()
    scaled.save(str(program.folder / "ours.json"))
    assert (program.folder / "ours.json").read_text() == (program.folder / "scaled.json").read_text()
    turned.save(str(program.folder / "ours.json"))
    assert (program.folder / "ours.json").read_text() == (program.folder / "turned.json").read_text()
    assert pz.Lens("double-gauss").scaled(0.5).efl_mm == pytest.approx(pz.Lens("double-gauss").efl_mm / 2, rel=1e-12)
    with pytest.raises(pz.InputError, match="one of them would be right"):
        scaled.scaled()


def test_optimised(program, lens):
    program.run("lens", "optimise", "cooke-triplet", "--variable", "radii", "--rounds", 3, "--ignore-apertures", "-o", "better.json")
    better, report = lens.optimise(["radii"], rounds=3, ignore_apertures=True)
    better.save(str(program.folder / "ours.json"))
    assert (program.folder / "ours.json").read_text() == (program.folder / "better.json").read_text()
    assert report.facts["start"] == [0]


def test_mtf_as_of_the_psf(program):
    told = program.json("lens", "mtf", "double-gauss", "--fields", 5, "--wavelengths", 550, "--frequencies", "20,60", "--as-psf")
    ours = pz.Lens("double-gauss").mtf([5], wavelengths_nm=[550], frequencies_cpmm=[20, 60], as_psf=True)
    assert ours["sagittal"].tolist() == [row["sagittal"] for row in told["rows"]]


@pytest.mark.parametrize("over_frame", [False, True])
def test_tables_are_built(program, over_frame):
    program.run("optics", "build", "edmund-54852", "--wavelengths", "450,550", "--sensor", "32x24@100", "--fields", 7, "--places", 5,
                "--f-number", 4, "--focus", "1.2m", *(["--over-frame"] if over_frame else []), "-o", "table.h5")
    theirs = pz.LensDataTable.load(str(program.folder / "table.h5"))
    camera = pz.Camera("edmund-54852", sensor="32x24@100", f_number=4, focus="1.2m")
    ours = pz.LensDataTable.build(camera, wavelengths_nm=[450, 550], fields=7, places=5, over_frame=over_frame)
    for name in ("fields", "wavelengths_nm", "real_image_height_mm", "g_source_sr", "g_sensor_sr", "image_x_mm"):
        assert np.array_equal(getattr(ours, name), getattr(theirs, name)), name
    ours.save(str(program.folder / "ours.h5"))
    light = [pz.TableCamera(table, "32x24@100").image(pz.SceneRequest("studio", wavelengths_nm=[450, 550], distance_m=1.2),
                                                      surround="extend").values
             for table in (ours, pz.LensDataTable.load(str(program.folder / "ours.h5")), theirs)]
    assert np.array_equal(light[0], light[1]) and np.array_equal(light[0], light[2])
    with pytest.raises(pz.Cancelled):
        pz.LensDataTable.build(camera, progress=lambda *_: False)


def test_tables_have_the_fields_that_pictures_need(program):
    program.run("optics", "build", "m12-4.5mm", "--wavelengths", 550, "--sensor", "320x240@15", "--tolerance", "3e-4", "-o", "table.h5")
    theirs = pz.LensDataTable.load(str(program.folder / "table.h5"))
    ours = pz.LensDataTable.build(pz.Camera("m12-4.5mm", sensor="320x240@15"), wavelengths_nm=[550], tolerance=3e-4)
    assert np.array_equal(ours.fields, theirs.fields) and len(ours.fields) > 31
    with pytest.raises(pz.InputError, match="tolerance"):
        pz.LensDataTable.build(pz.Camera("m12-4.5mm", sensor="320x240@15"), tolerance=-1)


@pytest.mark.parametrize("spoil, wrong", [
    (lambda lens: setattr(lens.surfaces[0], "apertures", [{"rectangel": (1, 1)}]), '"rectangle" would be right'),
    (lambda lens: setattr(lens.surfaces[0], "apertures", [{"obscures": True}]), "rectangle or an ellipse"),
    (lambda lens: setattr(lens.surfaces[0], "pose", {"tilt_deg": 1}), "would be right"),
    (lambda lens: setattr(lens, "groups", [{"pose": {}}]), "which surfaces move"),
    (lambda lens: setattr(lens, "tolerances", ["radius@1=0.1"]), "radius_percent")])
def test_what_is_wrong(lens, spoil, wrong):
    with pytest.raises(pz.InputError, match=wrong):
        spoil(lens)


def test_impossible_apertures_are_refused(lens):
    lens.surfaces[0].apertures = [{"ellipse": (-1, 2)}]
    with pytest.raises(pz.InputError):
        lens.validate()


def test_coatings_and_scatter_by_surface():
    lens = pz.Lens("cooke-triplet")
    bare, first = lens.polarisation([0], wavelengths_nm=[550])["transmittance_percent"][0], lens.surfaces[0]
    assert first.coating is None and first.scatter is None
    first.coating, first.scatter = "mgf2", {"roughness_nm": 2, "dust_percent": 0.05}
    assert lens.polarisation([0], wavelengths_nm=[550])["transmittance_percent"][0] > bare + 1
    same = pz.Lens("cooke-triplet").altered("surfaces[0].coating", "mgf2").altered("surfaces[0].scatter.roughness_nm", 2)
    assert lens.surfaces[0].coating == same.surfaces[0].coating == "mgf2"
    for again in (pz.Lens.from_json(lens.to_json()).surfaces[0], pickle.loads(pickle.dumps(first))):
        assert (again.coating, again.scatter) == ("mgf2", {"roughness_nm": 2, "dust_percent": 0.05})
    for value in (0.005, [[400, 0.03], [600, 0.01]]):
        first.coating = value
        assert first.coating == value
    first.coating = None
    assert first.coating is None
    with pytest.raises(pz.InputError, match="coating"):
        first.coating = "mgf3"
    with pytest.raises(pz.InputError, match="roughness"):
        first.scatter = {"roughness": 2}


def test_gratings_ideal_lenses_and_immersed_objects():
    """The grating equation and f tan of its angle, worked by hand; pickled and in the native file."""
    front = pz.Surface(thickness_mm=1, stop=True)
    front.grating = {"lines_per_mm": 300, "order": 1}
    back = pz.Surface(thickness_mm=50)
    back.ideal_lens = {"focal_length_mm": 50}
    lens = pz.Lens(surfaces=[front, back], aperture={"stop_semi_diameter_mm": 4}, wavelengths_nm=[550])
    assert dict(lens.surfaces[0].grating) == {"lines_per_mm": 300, "order": 1, "rotation_deg": 0}
    again = pickle.loads(pickle.dumps(lens.surfaces[0]))
    assert dict(again.grating) == dict(front.grating) and again.ideal_lens is None
    assert dict(pickle.loads(pickle.dumps(lens)).surfaces[1].ideal_lens) == {"focal_length_mm": 50}
    sine = 300 * 550e-6
    table = lens.distortion([0])
    assert table["image_height_mm"].tolist() == pytest.approx([50 * sine / (1 - sine ** 2) ** 0.5], abs=1e-9)
    lens.surfaces[0].grating = None
    assert lens.surfaces[0].grating is None
    with pytest.raises(pz.InputError, match="lines_per_mm"):
        lens.surfaces[0].grating = {"order": 1}
    lens.object_distance_mm, lens.object_glass = 100, pz.Glass.constant(1.5)
    assert lens.altered("object_distance_mm", 90).object_glass.index(550) == pytest.approx(1.5)
