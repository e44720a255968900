# SPDX-License-Identifier: BSD-3-Clause
"""From a scene to a developed picture: sense, develop, measure, and what they refuse."""

import json
import math
import re
import struct
import unittest

from petzval_cli import ProgramTest
from sample_files import SMALL_BAYER


LENS_INFO, EXIF, OPCODE_LIST_3, SUB_DIRECTORIES, STRIP_OFFSETS = 50736, 34665, 51022, 330, 273


def directories(file):
    """Tags of the first directory and of the one below it, with their counts and values or places (TIFF 6.0)."""
    def entries(place):
        count = struct.unpack_from("<H", file, place)[0]
        return {tag: (count, value) for tag, _, count, value in
                (struct.unpack_from("<HHII", file, place + 2 + 12 * i) for i in range(count))}

    first = entries(struct.unpack_from("<I", file, 4)[0])
    return first, entries(first[SUB_DIRECTORIES][1])


def raw_bytes(file, count):
    strips, place = directories(file)[1][STRIP_OFFSETS]
    at = place if strips == 1 else struct.unpack_from("<I", file, place)[0]
    return file[at:at + count]


class SensorChain(ProgramTest):
    def make_light(self, *options, sensor="96x64@3.75", name="light.exr"):
        self.assert_succeeds("image", "studio", "--lens", "edmund-54852", "--sensor", sensor, "--method", "none",
                             "--wavelengths", "400:20:700", "--quiet", "-o", name, *options)

    def make_raw(self, *options, name="raw.dng"):
        if not (self.folder / "light.exr").exists():
            self.make_light()
        return self.assert_succeeds("sense", "light.exr", "--sensor", "third-inch-1280x960", "--illuminant", "D65",
                                    "-o", name, *options)

    def test_same_bytes_for_any_number_of_threads(self):
        self.make_raw("--threads", "1", name="one.dng")
        self.make_raw("--threads", "2", name="two.dng")
        self.make_raw("--seed", "2", name="other.dng")
        files = self.contents()
        self.assertEqual(files["one.dng"], files["two.dng"])
        self.assertNotEqual(files["one.dng"], files["other.dng"])

    def test_automatic_exposure_stays_below_saturation(self):
        self.make_light()
        summary = self.json_of("sense", "light.exr", "--sensor", "third-inch-1280x960", "-o", "raw.dng", "--quiet")
        self.assertGreater(summary["exposure_s"], 0)
        for row in summary["rows"]:
            self.assertLess(row["clipped_percent"], 1)
        more = self.json_of("sense", "light.exr", "--sensor", "third-inch-1280x960", "--exposure-compensation", "1",
                            "-o", "raw.dng", "--quiet")
        self.assertAlmostEqual(more["exposure_s"] / summary["exposure_s"], 2, 9)

    def test_mosaics_that_others_do_not_know_are_noted_and_have_a_picture_beside(self):
        self.make_light(sensor="96x64@2.4")
        for sensor, noted in (("rgbw-1280x960", True), ("third-inch-1280x960", False)):
            said = self.petzval("sense", "light.exr", "--sensor", sensor, "--sensor-set", "pitch_um=2.4",
                                "--illuminant", "D65", "-o", f"{sensor}.dng", "-o", f"{sensor}.tif")
            self.assertEqual(said.returncode, 0, said.stderr)
            self.assertEqual("note: few other programs develop" in said.stderr, noted, sensor)
        files = self.contents()
        picture_bytes, mosaic_bytes = 96 * 64 * 3 * 2, 96 * 64 * 2
        self.assertGreater(len(files["rgbw-1280x960.dng"]), picture_bytes)
        self.assertLess(len(files["third-inch-1280x960.dng"]), 2 * mosaic_bytes)
        # What others see is what `develop` makes of the mosaic.
        said = self.assert_succeeds("develop", "rgbw-1280x960.dng", "-o", "linear.dng")
        self.assertIn("WGWRGWRWWBWGBWGW", said)
        linear = self.contents()["linear.dng"]
        self.assertEqual(raw_bytes(linear, picture_bytes), raw_bytes(files["rgbw-1280x960.dng"], picture_bytes))
        # Both say what camera and lens made them, and how the lens bends.
        for file in (linear, files["rgbw-1280x960.dng"]):
            first, below = directories(file)
            self.assertIn(LENS_INFO, first)
            self.assertIn(EXIF, first)
            self.assertIn(OPCODE_LIST_3, below)

    def test_date_and_time_are_what_the_user_says(self):
        """The computer's clock is in no file: the same command makes the same bytes on any day."""
        for name in ("a.dng", "b.dng"):
            self.make_raw("--date-time", "2026-11-26 10:07:09.25", name=name)
        self.make_raw(name="none.dng")
        for raw in ("a", "none"):
            self.assert_succeeds("develop", f"{raw}.dng", "-o", f"{raw}.png", "-o", f"{raw}.jpg", "-o", f"{raw}-linear.dng", "--quiet")
        files = self.contents()
        self.assertEqual(files["a.dng"], files["b.dng"])
        for name in ("a.dng", "a.png", "a.jpg", "a-linear.dng"):
            self.assertEqual(files[name].count(b"2026:11:26 10:07:09\0"), 2, name)  # DateTime, DateTimeOriginal
            self.assertEqual(files[name].count(b"250000\0"), 1, name)
        for name in ("none.dng", "none.png", "none.jpg", "none-linear.dng"):
            self.assertIsNone(re.search(rb"[12]\d\d\d:\d\d:\d\d", files[name]), name)
        self.assert_refused("sense", "light.exr", "--sensor", "third-inch-1280x960", "--date-time", "today", "-o", "c.dng",
                            words=["today", "2026-11-26 10:00:00"])

    def test_brightness_by_itself_undoes_the_exposure(self):
        self.make_raw("--exposure-compensation", "-5", name="dark.dng")
        said = self.json_of("develop", "dark.dng", "--brightness", "auto", "-o", "a.png", "--quiet")
        self.make_raw(name="light.dng")
        level = self.json_of("develop", "light.dng", "--brightness", "auto", "-o", "b.png", "--quiet")
        # Noise, a twentieth of white in blocks of 16 pixels, raises the brightest hundredth a little.
        self.assertAlmostEqual(said["brightness_ev"] - level["brightness_ev"], 5, delta=0.15)
        self.assert_refused("develop", "dark.dng", "--brightness", "bright", "-o", "c.png", words=("--brightness", "auto"))

    IMAGE = ("image", "colorchecker", "--lens", "edmund-54852", "--method", "none", "--wavelengths", "400:20:700")

    def test_a_chart_is_found_seven_stops_below_its_exposure(self):
        self.assert_succeeds(*self.IMAGE, "--sensor", "third-inch-1280x960", "--exposure-compensation", "-7",
                             "-o", "dark.dng", "--quiet")
        for brightness in ("0", "auto"):
            self.assert_succeeds("develop", "dark.dng", "--brightness", brightness, "-o", "dark.png", "--quiet")
            with self.subTest(brightness=brightness):
                self.assertLess(self.json_of("measure", "colour", "dark.png")["mean_delta_e_2000"], 5)

    def test_image_runs_the_lot_as_by_halves(self):
        self.write("small.json", SMALL_BAYER)
        exposing = ("--exposure", "0.004", "--gain", "1", "--frames", "2", "--without", "prnu", "--seed", "7")
        developing = ("--demosaic", "malvar", "--space", "display-p3", "--sharpen", "0.5")
        said = self.json_of(*self.IMAGE, "--sensor", "small.json", *exposing, *developing, "--step", "linear=one.npy",
                            "-o", "light.exr", "-o", "one.dng", "-o", "one.png", "-o", "one.tif", "--quiet")
        self.assertEqual(said["exposure_s"], 0.004)
        self.assert_succeeds("sense", "light.exr", "--sensor", "small.json", *exposing, "-o", "two.dng")
        self.assert_succeeds("develop", "two.dng", *developing, "--step", "linear=two.npy", "-o", "two.png", "-o",
                             "two.tif")
        files = self.contents()
        for extension in ("dng", "png", "tif", "npy"):
            self.assertEqual(files[f"one.{extension}"], files[f"two.{extension}"], extension)
        # The picture is the same without the raw file, and with an exposure by EV, whose f-number is the lens's.
        self.assert_succeeds(*self.IMAGE, "--sensor", "small.json", *exposing, *developing, "-o", "alone.png")
        self.assertEqual(self.contents()["alone.png"], files["one.png"])
        self.assert_succeeds(*self.IMAGE, "--sensor", "small.json", "--exposure", "ev:8", "-o", "ev1.dng", "-o", "l.exr")
        self.assert_succeeds("sense", "l.exr", "--sensor", "small.json", "--exposure", "ev:8", "-o", "ev2.dng")
        files = self.contents()
        self.assertEqual(files["ev1.dng"], files["ev2.dng"])
        self.assertIn(b"Edmund Optics 54-852", files["ev1.dng"])

    def test_pixel_aperture_and_low_pass_enter_once(self):
        """The SFR of sensed slanted edges is that of the lens times photosite times four-dot filter, each once. A picture has the light within
        the windows of its PSFs, brought to 1, so that its SFR lies between that of all light and that over what windows hold, to 0.001 of
        the picture and 0.001 of `sfr`. Any of the three left out or entered twice is off by 0.03 and more."""
        pitch, tilt, frequencies = 5, math.radians(5), [0.1, 0.2, 0.3, 0.4, 0.5]
        cpmm = ",".join(f"{1e3 * f / pitch:g}" for f in frequencies)
        lens = ("--lens", "cooke-triplet", "--focus", "design", "--wavelengths", "550")
        rows = self.json_of("lens", "mtf", "cooke-triplet", "--fields", "0", "--wavelengths", "550", "--frequencies", cpmm, "--as-psf")["rows"]
        mono = {**SMALL_BAYER, "columns": 160, "rows": 160, "pitch_um": pitch,
                "channels": [{"name": "grey", "quantum_efficiency": [{"wavelengths_nm": [400, 700], "values": [0.5, 0.5]}]}],
                "gain_modes": [{"name": "base", "full_well_e": 60000, "dn_per_e": 1, "read_noise_e": 0}],
                "adc": {"bits": 16, "black_level_dn": 100}}
        del mono["mosaic"]

        def sinc(x):
            return math.sin(math.pi * x) / (math.pi * x)

        for optics, width, dots in (({"photosite": {"fill_factor": 0.49}}, 0.7, 0), ({"low_pass_um": 2.5}, 1, 0.5),
                                    ({"photosite": {"shape": "rectangle", "width_um": 4, "height_um": 4}, "low_pass_um": 2}, 0.8, 0.4)):
            with self.subTest(optics=optics):
                self.write("mono.json", {**mono, **optics})
                said = self.json_of("image", "slanted-edge:5", *lens, "--sensor", "mono.json", "--scene-size", "1600x1600", "-o", "light.exr",
                                    "--quiet")
                self.assert_succeeds("sense", "light.exr", "--sensor", "mono.json", "--without", "shot,read,dsnu,prnu", "-o", "raw.npy")
                edge, = self.json_of("sfr", "raw.npy", "--roi", "4,20,152,120")["edges"]
                measured = {round(f, 2): sfr for f, sfr in zip(edge["frequencies_cpp"], edge["sfr"])}
                for f, row in zip(frequencies, rows):
                    expected = (row["tangential"] + row["sagittal"]) / 2
                    for g in (f * math.cos(tilt), f * math.sin(tilt)):
                        expected *= sinc(width * g) * math.cos(math.pi * dots * g)
                    self.assertGreater(measured[f], expected - 0.002)
                    self.assertLess(measured[f], expected / said["least_captured"] + 0.002)
                self.write("mono.json", mono)
                self.assert_refused("sense", "light.exr", "--sensor", "mono.json", "-o", "raw.dng", words=["pixel aperture", '"box"'])

    def test_targets_are_sensed_through_their_photosite(self):
        mono = {**SMALL_BAYER, "columns": 160, "rows": 160, "pitch_um": 4, "low_pass_um": 2,
                "photosite": {"shape": "rectangle", "width_um": 2.8, "height_um": 2.8},
                "channels": [{"name": "grey", "quantum_efficiency": [{"wavelengths_nm": [400, 700], "values": [0.5, 0.5]}]}]}
        del mono["mosaic"]
        self.write("mono.json", mono)
        target = ("target", "--half-plane", "95", "--size", "96x96", "--pixel-pitch", "4", "--low-pass", "0.5x0.5", "--quiet")
        self.assert_succeeds(*target, "--photosite", "rectangle:0.7x0.7", "-o", "fits.exr")
        self.assert_succeeds("sense", "fits.exr", "--sensor", "mono.json", "-o", "raw.dng")
        self.assert_succeeds(*target, "-o", "square.exr")
        self.assert_refused("sense", "square.exr", "--sensor", "mono.json", "-o", "raw2.dng", words=["rectangle 1 x 1", "0.7 x 0.7"])

    def test_image_fills_in_the_exit_pupil_for_microlenses(self):
        """No --exit-pupil is needed, and what comes in at an angle is lost in part."""
        flat = {**SMALL_BAYER, "microlens": {"angles_deg": [0, 60], "response": [1, 0.2]}}
        self.write("tilted.json", flat)
        self.assert_succeeds(*self.IMAGE, "--sensor", "tilted.json", "--exposure", "0.004", "-o", "light.exr", "-o", "with.dng")
        with_it = self.json_of("sense", "light.exr", "--sensor", "tilted.json", "--exposure", "0.004", "-o", "a.dng")["rows"]
        without = self.json_of("sense", "light.exr", "--sensor", "tilted.json", "--exposure", "0.004", "--without", "microlens", "-o",
                               "b.dng")["rows"]
        for lossy, whole in zip(with_it, without):
            self.assertLess(lossy["mean_e"], whole["mean_e"])

    def test_renderings_know_their_lens_too(self):
        self.write("wall.pbrt", 'LookAt 0 0 -1  0 0 0  0 1 0\nCamera "perspective"\n'
                   'Film "rgb" "integer xresolution" 32 "integer yresolution" 24 "float diagonal" 0.15\nWorldBegin\n'
                   'LightSource "infinite" "rgb L" [ 1 1 1 ]\n')
        self.assert_succeeds("render", "wall.pbrt", "--lens", "dgauss-50mm", "--film-distance", "38", "--spp", "4", "-o", "light.exr")
        self.write("small.json", SMALL_BAYER)
        self.assert_succeeds("sense", "light.exr", "--sensor", "small.json", "--exposure", "ev:8", "-o", "raw.dng")
        self.assertIn(b"Double Gauss 50 mm", self.contents()["raw.dng"])

    def test_renderings_are_made_for_a_sensor(self):
        """render --sensor | sense | develop: size, pitch, photosite and filter are the sensor's, and light without them is refused."""
        self.write("wall.pbrt", 'Camera "perspective"\nWorldBegin\nLightSource "infinite" "rgb L" [ 1 1 1 ]\n')
        self.write("small.json", {**SMALL_BAYER, "photosite": {"fill_factor": 0.49}, "low_pass_um": 2})
        render = ("render", "wall.pbrt", "--lens", "dgauss-50mm", "--film-distance", "38", "--spp", "16", "--wavelengths", "400:50:700")
        said = self.json_of(*render, "--sensor", "small.json", "-o", "light.exr")
        self.assertEqual((said["columns"], said["rows"], said["pitch_um"]), (96, 64, 3.75))
        self.assertIn("0.7 x 0.7 pitches, low-pass 0.53", said["pixel_aperture"])
        self.assert_succeeds("sense", "light.exr", "--sensor", "small.json", "--exposure", "ev:8", "-o", "raw.dng")
        self.assert_succeeds("develop", "raw.dng", "-o", "shot.png", "--quiet")
        plain = self.json_of(*render, "--sensor", "96x64@3.75", "-o", "plain.exr")
        self.assertEqual(plain["pixel_aperture"], "box")
        self.assertAlmostEqual(said["mean_irradiance"] / plain["mean_irradiance"], 1, delta=1e-3)
        self.assert_refused("sense", "plain.exr", "--sensor", "small.json", "-o", "no.dng", words=["pixel aperture", '"box"'])
        middle = self.json_of(*render, "--sensor", "small.json", "--size", "32x16", "-o", "middle.exr")
        self.assertEqual((middle["columns"], middle["rows"], middle["pitch_um"]), (32, 16, 3.75))
        self.assert_refused(*render, "--sensor", "small.json", "--size", "100x16", "-o", "no.exr", words=["96 x 64"])
        self.assert_refused(*render, "--sensor", "small.json", "--film-diagonal", "3", "-o", "no.exr", words=["diagonal"])

    def test_image_shows_the_light_itself_where_that_is_asked_for(self):
        self.write("small.json", SMALL_BAYER)
        self.assert_succeeds(*self.IMAGE, "--sensor", "96x64@3.75", "-o", "frame.png", "--quiet")
        self.assert_succeeds(*self.IMAGE, "--sensor", "small.json", "--picture", "irradiance", "-o", "light.png",
                             "-o", "shot.dng", "--quiet")
        self.assert_succeeds(*self.IMAGE, "--sensor", "small.json", "-o", "shot.png", "--quiet")
        files = self.contents()
        self.assertEqual(files["frame.png"], files["light.png"])
        self.assertNotEqual(files["frame.png"], files["shot.png"])

    def test_image_refuses_what_its_sensor_cannot_do(self):
        self.write("small.json", SMALL_BAYER)
        refuse = lambda *options, words: self.assert_refused(*self.IMAGE, *options, words=words)
        refuse("--sensor", "96x64@3.75", "-o", "a.exr", "-o", "a.dng", words=["channels"])
        refuse("-o", "a.dng", words=["--sensor"])
        refuse("--sensor", "96x64@3.75", "-o", "a.tif", words=["a.tif", "developed"])
        refuse("--sensor", "96x64@3.75", "--frames", "2", "-o", "a.png", words=["--frames", "no effect"])
        refuse("--sensor", "small.json", "--sharpen", "1", "-o", "a.dng", words=["--sharpen", "no effect"])
        refuse("--sensor", "small.json", "--picture", "developed", "-o", "a.dng", words=["--picture"])
        refuse("--sensor", "small.json", "-o", "a.dng", "-o", "no/a.png", words=["no"])
        refuse("--sensor", "small.json", "--gain", "3", "-o", "a.dng", words=["gain", "1 would be right"])
        refuse("--sensor", "small.json", "--conversion-gain", "huge", "-o", "a.dng", words=["huge", "base"])
        odd = json.loads(json.dumps(SMALL_BAYER).replace('"blue"', '"far red"').replace('"spectrum": "far red"', '"spectrum": "blue"'))
        self.write("odd.json", odd)
        refuse("--sensor", "odd.json", "-o", "a.dng", words=["far red", "sense"])
        # A picture needs no DNG. (And the wrong scene is not even looked at.)
        self.assert_succeeds(*self.IMAGE, "--sensor", "odd.json", "-o", "odd.png", "--quiet")
        self.assert_refused("image", "no-such-scene", "--lens", "edmund-54852", "--sensor", "small.json", "--gain", "3", "-o", "a.png",
                            words=["gain"])
        refuse("--sensor", "small.json", "--exposure", "soon", "-o", "a.exr", "-o", "a.png", words=["soon"])
        refuse("--sensor", "small.json", "--white-balance", "1,2", "-o", "a.dng", "-o", "a.png", words=["3 channels"])

    def test_outputs_appear_all_or_none(self):
        self.make_light()
        self.assert_refused("sense", "light.exr", "--sensor", "third-inch-1280x960", "-o", "a.dng", "-o", "b.jpg",
                            words=["b.jpg", ".dng"])
        self.assert_refused("sense", "light.exr", "--sensor", "third-inch-1280x960", "-o", "a.dng", "-o", "no/b.npy",
                            words=["no"])

    def test_light_for_another_sensor_is_refused(self):
        self.make_light()
        self.assert_refused("sense", "light.exr", "--sensor", "raspberry-pi-hq", "-o", "a.dng", words=["3.75", "1.55"])
        self.assert_refused("sense", "light.exr", "--sensor", "96x64@3.75", "-o", "a.dng", words=["channels"])
        self.assert_refused("sense", "light.exr", "--sensor", "third-inch-1280x960", "--without", "shots", "-o", "a.dng",
                            words=["shots", "shot, dark"])
        self.assert_refused("sense", "light.exr", "--sensor", "third-inch-1280x960", "--exposure", "soon", "-o", "a.dng",
                            words=["soon", "auto"])

    def test_develop_writes_every_step_and_format(self):
        self.make_raw()
        self.assert_succeeds("develop", "raw.dng", "-o", "a.png", "-o", "a.tif", "-o", "a.exr", "-o", "a.npy", "--step",
                             "demosaic=d.exr", "--step", "linear=l.npy", "--space", "display-p3", "--quiet")
        self.assertTrue({"a.png", "a.tif", "a.exr", "a.npy", "d.exr", "l.npy"} <= set(self.contents()))
        for method in ("bilinear", "malvar", "gradient", "general"):
            self.assertEqual(self.json_of("develop", "raw.dng", "--demosaic", method, "-o", "b.png")["demosaic"], method)
        report = self.json_of("develop", "raw.dng", "-o", "b.png")
        self.assertAlmostEqual(report["temperature_k"], 6504, delta=30)
        self.assert_refused("develop", "raw.dng", "--step", "sky=a.png", "-o", "c.png", words=["sky"])
        self.assert_refused("develop", "raw.dng", "--white-balance", "1,2", "-o", "c.png", words=["3 channels"])
        self.assert_refused("develop", "light.exr", "-o", "c.png", words=["light.exr"])

    def test_measures_print_rows(self):
        self.make_raw()
        sensor = self.json_of("measure", "sensor", "icx625-mono", "--csv", "t.csv", "--plot", "t.svg")
        self.assertAlmostEqual(sensor["dn_per_e"], 2.7, delta=0.05)
        self.assertGreater(len(sensor["rows"]), 10)
        self.assertTrue({"t.csv", "t.svg"} <= set(self.contents()))
        self.assertLess(self.json_of("measure", "matrix", "full-frame-24mp")["rows"][0]["mean_delta_e_2000"], 3)
        self.assertEqual(len(self.json_of("measure", "shading", "raw.dng", "--cells", "3")["rows"]), 27)
        self.assert_succeeds("develop", "raw.dng", "-o", "a.png", "--quiet")
        self.assertEqual(self.json_of("measure", "scielab", "a.png", "a.png")["rows"][0]["max"], 0)
        self.assert_refused("measure", "scielab", "a.png", "a.png", "--distance", "0", words=["--distance", "a number above 0"])
        self.assert_refused("measure", "colour", "a.png", "--corners", "1,2,3", words=["8"])

    def test_contradictory_sensors_are_refused_with_the_reason(self):
        sound = json.loads(json.dumps({
            "format": "petzval-sensor/1", "name": "n", "source": "s", "columns": 96, "rows": 64, "pitch_um": 3.75,
            "channels": [{"name": "grey", "quantum_efficiency": [{"wavelengths_nm": [400, 700], "values": [0.5, 0.5]}]}],
            "gain_modes": [{"name": "base", "full_well_e": 10000, "dn_per_e": 0.4, "read_noise_e": 3}],
            "adc": {"bits": 12, "black_level_dn": 64}}))
        self.make_light()
        self.write("sound.json", sound)
        self.assert_succeeds("sense", "light.exr", "--sensor", "sound.json", "-o", "raw.dng", "--quiet")
        wrong = [
            (lambda s: s["adc"].update(white_level_dn=5000), ["12 bits", "4095"]),
            (lambda s: s["adc"].update(black_level_dn=4095), ["below the white level"]),
            (lambda s: s["channels"][0]["quantum_efficiency"][0].update(values=[0.5, 1.5]), ["1.5", "700 nm"]),
            (lambda s: s["gain_modes"][0].update(read_noise_e=-1), ["read_noise_e", "-1"]),
            (lambda s: s.update(prnu_percent=-0.1), ["prnu_percent"]),
            (lambda s: s.update(mosaic=[["grey", "pink"]]), ["pink"]),
            (lambda s: s.update(crosstalk=[[0, 0.2, 0], [0.2, 0.9, 0.2], [0, 0.2, 0]]), ["1.7"]),
            (lambda s: s.pop("channels"), ["channels"]),
            (lambda s: s.update(gain_modes=[]), ["conversion gain"]),
            (lambda s: s.update(photosite={"shape": "star", "width_um": 1, "height_um": 1}), ["star"]),
            (lambda s: s.update(photosite={"shape": "ellipse", "width_um": 3, "height_um": 3}), ["box", "ellipse"]),
        ]
        for alter, words in wrong:
            sensor = json.loads(json.dumps(sound))
            alter(sensor)
            self.write("wrong.json", sensor)
            with self.subTest(words=words):
                self.assert_refused("sense", "light.exr", "--sensor", "wrong.json", "-o", "a.dng", words=words)


if __name__ == "__main__":
    unittest.main()
