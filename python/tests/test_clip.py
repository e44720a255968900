# SPDX-License-Identifier: BSD-3-Clause
"""Clips are the program's, and what they are said to be."""

import numpy as np
import pytest

import petzval as pz

SENSOR = ["--sensor", "third-inch-1280x960", "--sensor-set", "columns=96", "--sensor-set", "rows=64"]
SHOT = ["slanted-edge:0", "--lens", "edmund-54852", *SENSOR, "--method", "none", "--wavelengths", "450,550,650"]
EDGE = pz.SceneRequest("slanted-edge:0", wavelengths_nm=[450, 550, 650])


@pytest.fixture
def camera():
    return pz.Camera("edmund-54852", sensor=pz.Sensor("third-inch-1280x960", {"columns": 96, "rows": 64}))


def assert_frames(program, clip, folder="clip"):
    assert len(clip) == len(list((program.folder / folder).glob("frame-*.dng")))
    for number, raw in enumerate(clip):
        path = program.folder / folder / f"frame-{number:06}.dng"
        raw.save(str(program.folder / "python.dng"))
        assert (program.folder / "python.dng").read_bytes() == path.read_bytes(), number


def test_rolling_shutter_and_flicker(program, camera):
    told = program.json("shoot", *SHOT, "--pan", 40, "--frames", 3, "--shutter", "rolling", "--row-time", 200, "--exposure",
                        "1/500", "--flicker", "mains:50:0.4:0.25", "--seed", 7, "--format", "dng", "-o", "clip")
    clip = camera.shoot(EDGE, 3, pan_deg_per_s=40, shutter="rolling", row_time_us=200, exposure="1/500",
                        flicker="mains:50:0.4:0.25", method="none", seed=7)
    assert (clip.exposure_s, clip.shutter, clip.row_time_s) == (told["exposure_s"], told["shutter"], told["row_time_s"])
    assert clip.instants(0) == told["instants_per_frame"]
    assert_frames(program, clip)


def test_bracket_and_automatic_exposure(program, camera):
    program.run("shoot", *SHOT, "--pan", 10, "--frames", 2, "--fps", 12, "--bracket", "0,-2", "--metering", "average", "--without",
                "shot,read", "--date-time", "2026-11-26 10:00:00", "--format", "dng", "-o", "clip")
    clip = camera.shoot(EDGE, 2, fps=12, pan_deg_per_s=10, bracket_ev=[0, -2], metering="average", without=["shot", "read"],
                        date_time="2026-11-26 10:00:00", method="none")
    assert [raw.date_time for raw in clip] == ["2026-11-26T10:00:00", "2026-11-26T10:00:00.083333"]
    assert clip.timing(1)[0] == 1 / 12 and clip.timing(0, 1)[0] == clip.exposure_s
    assert_frames(program, clip)


def test_path(program, camera, tmp_path):
    (tmp_path / "way.csv").write_text("t_s,right_m,up_m\n0,0,0\n0.05,0.01,0\n0.1,0.01,0.02\n")
    arguments = [*SHOT, "--scene-distance", "1m", "--focus", "1m"]
    program.run("shoot", *arguments, "--frames", 2, "--path", "way.csv", "--exposure", "5ms", "--format", "dng", "-o", "clip")
    camera.focus = "1m"
    scene = pz.SceneRequest("slanted-edge:0", wavelengths_nm=[450, 550, 650], distance_m=1)
    keys = np.array([[0, 0, 0, 0, 0], [0.05, 0, 0, 0.01, 0], [0.1, 0, 0, 0.01, 0.02]])
    for path in (tmp_path / "way.csv", str(tmp_path / "way.csv"), keys):
        assert_frames(program, camera.shoot(scene, 2, path=path, exposure="5ms", method="none"))


def test_events(program, camera):
    program.run("shoot", *SHOT, "--pan", 40, "--frames", 2, "--exposure", "1ms", "--events", "--event-threshold", "0.15,0.25",
                "--event-latency", 1e-4, "--event-refractory", 1e-3, "--event-noise", 0.5, "--event-mismatch", 0.03, "--seed", 3,
                "-o", "clip")
    clip = camera.shoot(EDGE, 2, pan_deg_per_s=40, exposure=1e-3, method="none", seed=3)
    events = clip.events(threshold=(0.15, 0.25), latency_s=1e-4, refractory_s=1e-3, noise_per_s=0.5, mismatch=0.03)
    assert len(events) > 100 and (np.diff(events.t_s) >= 0).all() and set(events.brighter.tolist()) == {0, 1}
    events.save(program.folder / "python.txt")
    assert (program.folder / "python.txt").read_bytes() == (program.folder / "clip" / "events.txt").read_bytes()


def test_a_clip_is_a_sequence(camera):
    clip = camera.shoot(EDGE, 3, exposure=1e-3, method="none", seed=5)
    assert len(clip) == 3 and np.array_equal(clip[-1].values, clip[2].values)
    assert not np.array_equal(clip[0].values, clip[1].values)  # noise is new in each frame
    assert np.array_equal(clip[1].values, clip.frame(1, threads=1).values)
    with pytest.raises(IndexError):
        clip[3]
    assert repr(clip) == "<Clip: 3 frames of 96 x 64, 24 a second, 0.001 s each, global shutter>"


def test_scenes_in_memory(camera):
    still = pz.Scene(np.full((20, 30, 3), 0.1, np.float32), [450, 550, 650], horizontal_angle_deg=60)
    clip = camera.shoot(still, 2, flicker="pwm:1000:0.5", exposure=1e-4, method="none", without=["shot", "read", "dark"])
    # The lamp is on in the first half of each millisecond; 1/24 s is 41 2/3 of them.
    assert clip[0].linear_values.mean() > 1.9 * clip[1].linear_values.mean() - clip[1].black_level


def test_clips_end_when_told_to(camera):
    with pytest.raises(pz.Cancelled):
        camera.shoot(EDGE, 2, exposure=1e-3, progress=lambda *_: False)
    clip = camera.shoot(EDGE, 2, exposure=1e-3, method="none", pan_deg_per_s=40)
    with pytest.raises(pz.Cancelled):
        clip.frame(0, progress=lambda *_: False)
    with pytest.raises(pz.Cancelled):
        clip.events(progress=lambda *_: False)


@pytest.mark.parametrize("keywords, wrong", [
    ({"row_time_us": 20}, 'shutter="rolling"'), ({"shutter": "rolling"}, "`row_time_us` 20"),
    ({"shutter": "roling"}, "sensor, global or rolling"), ({"flicker": "mains:50"}, "would be right"),
    ({"path": [[0, 0]]}, "t_s, pan_deg"), ({"path": "way.csv", "pan_deg_per_s": 3}, "without `pan_deg_per_s`"),
    ({"fps": 0}, "above 0"), ({"exposure": 1.0}, "a lower `fps`"), ({"motion_step_px": 0}, "would be right"),
    ({"move_m_per_s": (1, 0)}, "would be right")])
def test_what_is_wrong(camera, keywords, wrong):
    with pytest.raises(pz.InputError, match=wrong.replace("(", r"\(")):
        camera.shoot(EDGE, 2, **{"exposure": 1e-3, "method": "none", **keywords})


def test_a_clip_needs_a_sensor():
    with pytest.raises(pz.InputError, match="counts photons"):
        pz.Camera("edmund-54852").shoot(EDGE, 2)


def test_events_as_xarray(camera):
    pytest.importorskip("xarray")
    events = camera.shoot(EDGE, 1, exposure=1e-3, method="none", pan_deg_per_s=40).events().to_xarray()
    assert events.t.attrs["units"] == "s" and events.sizes["event"] == len(events.brighter)
