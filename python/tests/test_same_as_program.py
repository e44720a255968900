# SPDX-License-Identifier: BSD-3-Clause
"""Python's numbers are the program's, to the last bit."""

import math

import numpy as np
import pytest

import petzval as pz

# The bundled sensor with these settings, as conftest.py has it.
SENSOR = ["--sensor", "example-vga", "--sensor-set", "columns=96", "--sensor-set", "rows=64", "--sensor-set",
          "pitch_um=40"]
SHOT = ["studio", "--lens", "edmund-54852", "--f-number", 4, "--focus", "1.2m", "--wavelengths", "450,550,650", *SENSOR]


def as_json(column):
    """A column as the program's JSON has it: a gap is null."""
    return [None if isinstance(value, float) and not math.isfinite(value) else value
            for value in (column.tolist() if isinstance(column, np.ndarray) else column)]


def test_image(program, light):
    program.run("image", *SHOT, "-o", "light.npy")
    assert np.array_equal(np.load(program.folder / "light.npy"), light.values)


@pytest.mark.parametrize("method", ["blended", "sections", "none"])
def test_image_by_other_methods(program, camera, method):
    program.run("image", *SHOT, "--method", method, "--supersample", 2, "-o", "light.npy")
    light = camera.image(pz.SceneRequest("studio", wavelengths_nm=[450, 550, 650]), method=method, supersample=2)
    assert np.array_equal(np.load(program.folder / "light.npy"), light.values)


def test_image_by_plans_of_ones_own(program, camera):
    scene = pz.SceneRequest("studio", wavelengths_nm=[450, 550, 650])
    program.run("image", *SHOT, "--nodes", 3, "--tile", 12, "-o", "light.npy")
    assert np.array_equal(np.load(program.folder / "light.npy"), camera.image(scene, nodes=3, tile=12).values)
    program.run("image", *SHOT, "--method", "sections", "--section", 24, "--transform", 64, "--supersample", 3, "-o", "light.npy")
    light = camera.image(scene, method="sections", section=24, transform=64, supersample=3)
    assert np.array_equal(np.load(program.folder / "light.npy"), light.values)


def test_image_with_losses(program, camera):
    program.run("image", *SHOT, "--fresnel", "--absorption", "-o", "light.npy")
    camera.fresnel = camera.absorption = True
    light = camera.image(pz.SceneRequest("studio", wavelengths_nm=[450, 550, 650]))
    assert np.array_equal(np.load(program.folder / "light.npy"), light.values)


def test_raw_image_and_picture(program, camera, light, tmp_path):
    program.run("image", *SHOT, "--seed", 7, "-o", "shot.dng", "-o", "shot.png")
    raw = camera.expose(light, seed=7)
    raw.save(str(tmp_path / "python.dng"))
    assert (tmp_path / "python.dng").read_bytes() == (tmp_path / "shot.dng").read_bytes()
    # A DNG rounds white balance and matrices; the program develops what it holds.
    pz.develop(pz.Raw.load(str(tmp_path / "python.dng"))).save(str(tmp_path / "python.png"))
    assert (tmp_path / "python.png").read_bytes() == (tmp_path / "shot.png").read_bytes()


def test_insets_beside_a_picture(program, camera, light, tmp_path):
    raw = camera.expose(light, seed=7)
    raw.save(str(program.folder / "shot.dng"))
    program.run("develop", "shot.dng", "--inset", "centre,4", "--inset", "3,5", "-o", "beside.png")
    pz.develop(pz.Raw.load(str(program.folder / "shot.dng"))).save(str(tmp_path / "python.png"), insets=["centre,4", "3,5"])
    assert (tmp_path / "python.png").read_bytes() == (program.folder / "beside.png").read_bytes()


def test_exposure_options(program, camera, light, tmp_path):
    light.save(str(tmp_path / "light.exr"))
    program.run("sense", "light.exr", *SENSOR, "--exposure", 0.02, "--without", "read,dark", "--frames", 3, "--gain", 1.5,
                "--conversion-gain", "high", "--seed", 3, "-o", "raw.dng")
    raw = camera.expose(light, exposure=0.02, without=["read", "dark"], frames=3, analog_gain=1.5, gain_mode="high", seed=3)
    program_raw = pz.Raw.load(str(tmp_path / "raw.dng"))
    assert np.array_equal(raw.values, program_raw.values)
    program.run("develop", "raw.dng", "--white-balance", "3200K", "--demosaic", "malvar", "--denoise", 2, "--sharpen", 0.5,
                "--tone", "soft", "--space", "display-p3", "-o", "picture.npy")
    picture = pz.develop(program_raw, white_balance="3200K", demosaic="malvar", denoise=2, sharpen=0.5, tone="soft",
                         space="display-p3")
    assert np.array_equal(np.load(tmp_path / "picture.npy"), picture.values)


@pytest.mark.parametrize("name", sorted(set(pz.analyses()) - {"wavefront-map"}))
def test_analysis(program, name):
    told = program.json("lens", name, "cooke-triplet", *(["--wavelengths", "480,590"] if name != "zernike" else []))
    keywords = {} if name == "zernike" else {"wavelengths_nm": [480, 590]}
    analysis = pz.Lens("cooke-triplet").analyse(name, **keywords)
    for key, table in analysis.tables.items():
        assert {column: [row[column] for row in told[key]] for column in told[key][0]} == {
            column: as_json(values) for column, values in table.items() if column in told[key][0]}
        assert len(table) >= len(told[key][0])


def test_analysis_of_a_camera(program):
    told = program.json("lens", "spots", "double-gauss", "--f-number", 8, "--focus", "3m", "--fields", "0,5", "--field-type",
                        "real_image_height_mm")["rows"]
    spots = pz.Camera("double-gauss", f_number=8, focus="3m").spots([0, 5], field_type="real_image_height_mm")
    assert as_json(spots["rms_radius_um"]) == [row["rms_radius_um"] for row in told]


def test_first_order(program):
    told = program.json("lens", "info", "dgauss-50mm", "--wavelength", 500)
    ours = pz.Lens("dgauss-50mm").first_order(500)
    for name in ["efl_mm", "bfl_mm", "ffl_mm", "f_number", "working_f_number", "image_space_na", "field_of_view_deg",
                 "magnification", "petzval_radius_mm", "total_track_mm", "lagrange_invariant_mm"]:
        assert getattr(ours, name) == told[name], name
    assert ours.exit_pupil.position_mm == told["exit_pupil"]["position_mm"]
    assert ours.entrance_pupil.diameter_mm == told["entrance_pupil"]["diameter_mm"]


def test_psf(program, tmp_path):
    lens = pz.Lens("double-gauss")
    stack = lens.psf(fields=[0, 10], wavelengths_nm=[450, 600], size=64, spacing_um=2)
    for f, field in enumerate([0, 10]):
        for w, wavelength in enumerate([450, 600]):
            program.run("lens", "psf", "double-gauss", "--fields", field, "--wavelengths", wavelength, "--size", 64,
                        "--spacing", 2, "-o", "psf.npy")
            assert np.array_equal(np.load(tmp_path / "psf.npy"), stack.values[f, w])


def test_psf_by_fft(program, tmp_path):
    stack = pz.Lens("double-gauss").psf([0, 10], wavelengths_nm=[550], size=64, spacing_um=1, method="fft", pupil_samples=128)
    for f, field in enumerate([0, 10]):
        program.run("lens", "psf", "double-gauss", "--fields", field, "--wavelengths", 550, "--size", 64, "--spacing", 1,
                    "--method", "fft", "--pupil-samples", 128, "-o", "psf.npy")
        assert np.array_equal(np.load(tmp_path / "psf.npy"), stack.values[f, 0])
    program.run("lens", "psf", "double-gauss", "--fields", "0,10", "--wavelengths", 550, "--size", 64, "--spacing", 1,
                "--method", "fft", "--pupil-samples", 128, "-o", "psf.npz")
    assert np.array_equal(np.load(tmp_path / "psf.npz")["psf"], stack.values)
    with pytest.raises(pz.InputError, match="samples of the FFT span"):
        pz.Lens("double-gauss").psf([10], wavelengths_nm=[550], size=16, spacing_um=40, method="fft")


def test_rays(program, tmp_path):
    rays = np.array([[0, 1, -5, 0, 0.02, 1, 550], [2, -3, -5, 0.01, 0, 1, 550], [50, 0, -5, 0, 0, 1, 550]], float)
    np.savetxt(tmp_path / "rays.csv", rays, "%.17g", ",", header="x_mm,y_mm,z_mm,L,M,N,wavelength_nm", comments="")
    told = program.json("lens", "trace", "cooke-triplet", "--rays", "rays.csv")["rows"]
    ours = pz.Lens("cooke-triplet").trace(rays[:, :3], rays[:, 3:6], 550)
    assert ours.status == [row["status"] for row in told]
    assert as_json(ours.opl_mm) == [row["opl_mm"] for row in told]
    assert [as_json(point) for point in ours.points_mm] == [[row["x_mm"], row["y_mm"], row["z_mm"]] for row in told]


def test_rendering(program, tmp_path):
    program.run("render", "spheres", "--lens", "dgauss-50mm", "--focus", "1.2m", "--size", "48x32", "--wavelengths",
                "450,550,650", "--spp", 4, "--seed", 5, "--depth", "depth.npy", "--albedo",
                "albedo.npy", "-o", "light.npy")
    rendering = pz.Camera("dgauss-50mm", focus="1.2m").render("spheres", size=(48, 32), wavelengths_nm=[450, 550, 650],
                                                              samples_per_pixel=4, seed=5, first_surfaces=True)
    assert np.array_equal(np.load(tmp_path / "light.npy"), rendering.light.values)
    assert np.array_equal(np.load(tmp_path / "depth.npy"), rendering.depth)
    assert np.array_equal(np.load(tmp_path / "albedo.npy"), rendering.albedo)
    assert 0 <= rendering.albedo.min() < rendering.albedo.max() <= 1


def test_rendering_that_is_denoised(program, tmp_path):
    program.run("render", "spheres", "--lens", "dgauss-50mm", "--focus", "1.2m", "--size", "30x20", "--wavelengths", "450,550", "--spp", 8,
                "--denoise-light", "-o", "light.npy")
    rendering = pz.Camera("dgauss-50mm", focus="1.2m").render("spheres", size=(30, 20), wavelengths_nm=[450, 550], samples_per_pixel=8,
                                                              denoise_light=True)
    assert np.array_equal(np.load(tmp_path / "light.npy"), rendering.light.values)
    assert rendering.denoised and "denoised" in rendering.light.provenance and rendering.depth is None


def test_rendering_of_a_camera_that_moves(program, tmp_path):
    program.run("render", "spheres", "--lens", "dgauss-50mm", "--focus", "1.2m", "--size", "30x20", "--wavelengths", 550, "--spp", 2,
                "--camera-move", "0.02,0,0", "--rolling-shutter", 0.5, "--near", 0.5, "--far", 20, "--camera-origin", "front",
                "--segments", "segments.npy", "--flow", "flow.npy", "--light-groups", "lamp.npy", "-o", "light.npy")
    rendering = pz.Camera("dgauss-50mm", focus="1.2m").render(
        "spheres", size=(30, 20), wavelengths_nm=[550], samples_per_pixel=2, camera_move=(0.02, 0, 0), rolling_shutter=0.5,
        near_distance=0.5, far_distance=20, camera_origin="front", segments=True, flow=True,
        light_groups=True)
    assert np.array_equal(np.load(tmp_path / "light.npy"), rendering.light.values)
    assert len(rendering.light_groups) > 1
    for number, light in enumerate(rendering.light_groups):
        assert np.array_equal(np.load(tmp_path / f"lamp-{number}.npy"), light.values)
    with pytest.raises(pz.InputError, match="light_groups"):
        pz.Camera("dgauss-50mm").render("spheres", light_groups=True, ghosts=True)
    assert np.array_equal(np.load(tmp_path / "segments.npy"), rendering.segments) and rendering.segments.max() > 0
    assert np.array_equal(np.load(tmp_path / "flow.npy"), rendering.flow, equal_nan=True)
    assert rendering.flare is None


def test_rendering_focused_as_the_scene_says(program, tmp_path):
    program.run("render", "spheres", "--lens", "dgauss-50mm", "--size", "24x16", "--wavelengths", 550, "--spp", 1, "-o", "light.npy")
    rendering = pz.Camera("dgauss-50mm").render("spheres", size=(24, 16), wavelengths_nm=[550], samples_per_pixel=1,
                                                focus_as_in_scene=True)
    assert np.array_equal(np.load(tmp_path / "light.npy"), rendering.light.values)
    cost = pz.Camera("dgauss-50mm").estimate_render("spheres", size=(24, 16), samples_per_pixel=1, focus_as_in_scene=True)
    assert cost["samples_per_pixel"] == 1 and cost["seconds"] > 0


def test_autofocus_by_other_measures(program):
    told = program.json("focus", "spheres", "--lens", "dgauss-50mm", "--size", "160x120", "--focus-measure", "sml", "--focus-step", 2,
                        "--focus-depth", 0.3, "--focus-search", "scan", "--focus-evaluations", 5)
    ours = pz.Camera("dgauss-50mm").autofocus("spheres", size=(160, 120), focus_measure="sml", focus_step=2, depth_mm=0.3,
                                              focus_search="scan", most_evaluations=5)
    assert ours.film_distance_mm == told["film_distance_mm"]


def test_autofocus(program):
    told = program.json("focus", "spheres", "--lens", "dgauss-50mm", "--size", "160x120")
    ours = pz.Camera("dgauss-50mm").autofocus("spheres", size=(160, 120))
    assert ours.film_distance_mm == told["film_distance_mm"]


def test_target_and_its_sharpness(program, tmp_path):
    program.run("target", "--rectangle", "100x80@5", "--psf", "wavefront", "--w020", 0.3, "--f-number", 5.6, "--wavelength",
                "500,600", "--weights", "1,2", "--size", "200x180", "-o", "target.exr")
    ours = pz.target(rectangle=(100, 80, 5), w_waves={"w020": 0.3}, f_number=5.6, wavelengths_nm=[500, 600], weights=[1, 2],
                     size=(200, 180))
    assert np.array_equal(pz.SpectralImage.load(str(tmp_path / "target.exr")).values, ours.values)
    told = program.json("sfr", "target.exr")["edges"]
    edges = pz.sfr(ours)
    assert [edge.mtf50 for edge in edges] == [edge["mtf50_cpp"] for edge in told]
    assert [edge.sfr.tolist() for edge in edges] == [edge["sfr"] for edge in told]


def test_sharpness_over_the_frame(program, tmp_path):
    program.run("target", "--chart", "slanted-edges", "--size", "200x150mm", "-o", "chart.svg")
    program.run("target", "--polygons", "chart.svg", "--size", "756x567", "--f-number", 8, "--wavelength", 550, "-o", "photo.npy")
    told = program.json("sfr", "photo.npy", "--chart-size", "200x150")["edges"]
    edges = pz.sfr(str(tmp_path / "photo.npy"), chart_mm=(200, 150))
    assert [edge.on_chart for edge in edges] == [tuple(edge["on_chart"].values()) for edge in told]
    # Every edge is as sharp: so is the surface through them.
    middle = edges.map()[20:40, 20:40]
    assert np.nanmax(np.abs(middle - edges.mtf50)) < 1e-3
    assert np.abs(edges.over_height([100, 200]) - edges.mtf50).max() < 1e-3
    program.run("sfr", "photo.npy", "--map", "map.svg")
    assert "meridional" in edges.map_svg() and "meridional" in (tmp_path / "map.svg").read_text()
    with pytest.raises(pz.InputError, match="beyond the edges|does not fall"):
        edges.sharpest_along("x")


def test_drawings_of_edges(program, tmp_path):
    pz.target(rectangle=(100, 100, 5), size=(200, 180)).save(str(tmp_path / "photo.npy"))
    program.run("sfr", "photo.npy", "--annotate", "edges.svg", "--over-height", "height.svg", "--report", "report.html",
                "--pixel-pitch", 4.73)
    edges = pz.sfr(str(tmp_path / "photo.npy"))
    picture = np.load(tmp_path / "photo.npy")
    assert edges.annotated_svg(picture) == (tmp_path / "edges.svg").read_text()
    assert edges.over_height_svg(pitch_um=4.73) == (tmp_path / "height.svg").read_text()
    report = edges.report_html(picture, title="photo.npy", pitch_um=4.73)
    assert report == (tmp_path / "report.html").read_text()
    assert "The edges and their MTF50" in report and "The edges and their MTF50" not in edges.report_html()
    with pytest.raises(pz.InputError, match="10 x 10"):
        edges.annotated_svg(picture[:10, :10])


def test_table(program, tmp_path):
    program.run("optics", "build", "edmund-54852", "--wavelengths", "450,550,650", *SENSOR[:1], "96x64@40", "-o", "table.h5")
    program.run("image", "studio", "--optics", "table.h5", "--sensor", "96x64@40", "--wavelengths", "450,550,650", "-o",
                "light.npy")
    camera = pz.TableCamera(pz.LensDataTable.load(str(tmp_path / "table.h5")), "96x64@40")
    light = camera.image(pz.SceneRequest("studio", wavelengths_nm=[450, 550, 650]))
    assert np.array_equal(np.load(tmp_path / "light.npy"), light.values)


def test_tables_of_other_programs(program, tmp_path):
    program.run("optics", "build", "edmund-54852", "--wavelengths", "450,650", "--image-height", 2, "--fields", 5, "-o", "lens.h5")
    table = pz.LensDataTable.load(str(tmp_path / "lens.h5"))
    program.run("optics", "export", "lens.h5", "--to", "iset", "--psf-size", 64, "--psf-spacing", 1, "--psf-light", 0.5,
                "-o", "program.mat")
    program.run("optics", "export", "lens.h5", "--to", "zemax", "--resample", "-o", "texts")
    with pytest.warns(pz.Note, match="resampled to 64 x 64"):
        table.export(str(tmp_path / "python.mat"), to="iset", psf_size=64, psf_spacing_um=1, psf_light=0.5)
    assert (tmp_path / "python.mat").read_bytes() == (tmp_path / "program.mat").read_bytes()
    table.export(str(tmp_path / "again"), to="zemax", resample=True)
    texts = sorted(path.name for path in (tmp_path / "texts").iterdir())
    assert len(texts) > 10 and texts == sorted(path.name for path in (tmp_path / "again").iterdir())
    assert all((tmp_path / "texts" / name).read_bytes() == (tmp_path / "again" / name).read_bytes() for name in texts)
    for source, options, keywords in (("program.mat", [], {}), ("texts", [], {}),
                                      ("program.mat", ["--from", "iset", "--psf-away", "left", "--psf-centre", "30,31"],
                                       {"source": "iset", "psf_away": "left", "psf_centre": (30, 31)})):
        program.run("optics", "import", source, *options, "-o", "program.h5")
        pz.LensDataTable.import_from(str(tmp_path / source), **keywords).save(str(tmp_path / "python.h5"))
        assert (tmp_path / "python.h5").read_bytes() == (tmp_path / "program.h5").read_bytes()


def test_measured_tables(program, tmp_path):
    rows = [f"{field},550,{f},0.{99 - f},0.{99 - f}" for field in (0, 2, 4) for f in (10, 20, 40, 80)]
    (tmp_path / "mtf.csv").write_text("# focal_length_mm: 25\nfield_mm,wavelength_nm,frequency_cpmm,tangential,sagittal\n"
                                      + "\n".join(rows) + "\n")
    program.run("optics", "import", "mtf.csv", "--g-axis", 0.2, "--vertex-to-sensor", 30, "-o", "program.h5")
    with pytest.warns(pz.Note, match="no distortion and even illumination"):
        table = pz.LensDataTable.import_from(str(tmp_path / "mtf.csv"), g_axis_sr=0.2, vertex_to_sensor_mm=30)
    table.save(str(tmp_path / "python.h5"))
    assert (tmp_path / "python.h5").read_bytes() == (tmp_path / "program.h5").read_bytes()
    for keywords, words in (({"psf_away": "up"}, "`psf_away` and `psf_centre`"), ({"g_axis_sr": 4}, "`g_axis_sr` 4"),
                            ({"source": "oslo"}, "`source` oslo"), ({"psf_centre": (0, 1)}, "counted from 1")):
        with pytest.raises(pz.InputError, match=words):
            pz.LensDataTable.import_from(str(tmp_path / "mtf.csv"), **keywords)
    for keywords, words in (({"psf_size": 1}, "`psf_size` 1"), ({"psf_light": 2}, "`psf_light` 2"), ({"psf_spacing_um": 1e-6}, "GiB")):
        with pytest.raises(pz.InputError, match=words):
            table.export(str(tmp_path / "t.mat"), to="iset", **keywords)
