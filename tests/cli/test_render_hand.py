# SPDX-License-Identifier: BSD-3-Clause
"""petzval render in the hand: stopped, previewed, aimed, exposed, swept."""

import json
import random
import re
import signal
import subprocess
import time
import unittest

import numpy

from picture_files import read_png
from petzval_cli import PROGRAM, ProgramTest

SCENE = """LookAt 0 0 -1  0 0 0  0 1 0
Camera "perspective" "float fov" 60
Film "rgb" "integer xresolution" 48 "integer yresolution" 36 "float diagonal" 40
WorldBegin
LightSource "infinite" "rgb L" [ .02 .02 .02 ]
AttributeBegin AreaLightSource "diffuse" "blackbody L" 2800 "float scale" 300 Translate -.3 .6 .3 Shape "sphere" "float radius" .05 AttributeEnd
Material "diffuse" "rgb reflectance" [ .7 .1 .1 ]
Shape "bilinearmesh" "point3 P" [ -2 -2 1  2 -2 1  -2 1 1  2 1 1 ]
"""
LENS = ["--lens", "dgauss-50mm", "--focus", "2m"]


class RenderHand(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "s.pbrt").write_text(SCENE)

    def stopped(self, options, wait_s):
        """A rendering that SIGINT ends: its exit code and what it said."""
        with subprocess.Popen([PROGRAM, "render", "s.pbrt", *LENS, "--size", "96x72", "--spp", "4000", "--wavelengths", "500,600",
                               "--threads", "1", "-o", "p.npy", *options], cwd=self.folder, stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True) as running:
            time.sleep(wait_s)
            running.send_signal(signal.SIGINT)
            said = running.stderr.read()
        return running.returncode, said

    def test_gives_a_picture_whenever_it_is_stopped(self):
        chance = random.Random(5)
        for _ in range(20):
            (self.folder / "p.npy").unlink(missing_ok=True)
            code, said = self.stopped([], chance.uniform(0.5, 1.5))
            self.assertEqual(code, 130, said)
            self.assertIn("the picture so far is written", said)
            self.assertIn("--checkpoint", said)
            picture = numpy.load(self.folder / "p.npy")
            self.assertEqual(picture.shape, (72, 96, 2))
            self.assertGreater((picture > 0).mean(), 0.1)

    def test_light_groups_add_up_through_pieces(self):
        whole = ["render", "s.pbrt", *LENS, "--size", "24x16", "--spp", "8", "--wavelengths", "500,600", "--diffraction", "--quiet"]
        self.assert_succeeds(*whole, "-o", "plain.npy")
        groups = [*whole, "-o", "p.npy", "--light-groups", "lamp.npy"]
        self.assert_succeeds(*groups)
        once = [numpy.load(self.folder / f"{name}.npy") for name in ("plain", "p", "lamp-0", "lamp-1")]
        self.assertTrue(numpy.array_equal(once[0], once[1]))
        numpy.testing.assert_allclose(once[2] + once[3], once[1], 1e-5, 1e-9)
        self.assertGreater(min(once[2].sum(), once[3].sum()), 0.01 * once[1].sum())
        self.assert_succeeds(*groups, "--region", "0,0,10,16", "--checkpoint", "left")
        self.assert_succeeds(*groups, "--region", "10,0,14,16", "--checkpoint", "right")
        self.assert_succeeds("merge", "left", "right", "-o", "both", "--quiet")
        self.assert_succeeds(*groups, "--checkpoint", "both")
        for before, name in zip(once[1:], ("p", "lamp-0", "lamp-1")):
            self.assertTrue(numpy.array_equal(before, numpy.load(self.folder / f"{name}.npy")), name)
        self.assert_refused(*whole, "--checkpoint", "both", "-o", "p.npy", words=["another picture", "light-groups"])
        self.assert_refused(*groups, "--ghosts", words=["--light-groups", "ghosts"])
        self.assert_refused(*whole, "-o", "lamp-1.npy", "--light-groups", "lamp.npy", words=["lamp-1.npy", "same file"])
        self.assert_refused(*whole, "-o", "p.npy", "--light-groups", "lamp.png", words=[".exr", ".npy"])

    def test_resumes_to_the_same_bytes_wherever_it_is_stopped(self):
        whole = ["render", "s.pbrt", *LENS, "--size", "96x72", "--spp", "120", "--wavelengths", "500,600", "--quiet"]
        self.assert_succeeds(*whole, "-o", "whole.npy")
        chance = random.Random(6)
        command = [PROGRAM, *whole, "--checkpoint", "c.petzval", "-o", "p.npy"]
        for _ in range(5):
            with subprocess.Popen(command, cwd=self.folder, stderr=subprocess.DEVNULL) as running:
                time.sleep(chance.uniform(0.05, 0.5))
                running.send_signal(signal.SIGINT)
            self.assertIn(running.returncode, (0, 130, -signal.SIGINT))
        self.assert_succeeds(*command[1:])
        self.assertEqual((self.folder / "p.npy").read_bytes(), (self.folder / "whole.npy").read_bytes())

    def test_shows_a_preview(self):
        code, said = self.stopped(["--preview", "now.png"], 3)
        self.assertEqual(code, 130, said)
        self.assertEqual((self.folder / "now.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assert_refused("render", "s.pbrt", *LENS, "--preview", "now.jpg", "-o", "p.png", words=["now.jpg", ".png"])

    def test_tells_what_is_in_the_picture_and_what_is_sharp(self):
        picture = ["render", "s.pbrt", *LENS, "--spp", "2", "--size", "240x180", "-o", "a.png"]
        said = self.json_of(*picture)
        self.assertAlmostEqual(said["distance_in_focus_m"], 2, places=6)
        self.assertLess(said["depth_of_field_near_m"], 2)
        self.assertGreater(said["depth_of_field_far_m"], 2)
        self.assertAlmostEqual(said["film_width_mm"], 32)
        # 2 atan(w/2s') of a lens of 50.4 mm.
        self.assertAlmostEqual(said["horizontal_field_of_view_deg"], 34.6, delta=0.5)
        text = self.assert_succeeds(*picture)
        self.assertRegex(text, r"view +34\.\d x 26\.\d degrees on a film of 32 x 24 mm; f = 50\.\d+ mm, f/2\.\d+")
        self.assertRegex(text, r"focus +2 m from the film; sharp to a pixel from 1\.\d+ m to 2\.\d+ m")

    def test_focuses_on_a_pixel(self):
        near = self.json_of("render", "s.pbrt", "--lens", "dgauss-50mm", "--focus", "pixel@24,30", "--spp", "2", "-o", "a.png")
        self.assertAlmostEqual(near["distance_in_focus_m"], 2, delta=2e-3)
        for focus, words in [("pixel@24", ["pixel@", "120,80"]), ("pixel@99,3", ["99,3", "48 x 36"])]:
            self.assert_refused("render", "s.pbrt", "--lens", "dgauss-50mm", "--focus", focus, "-o", "x.png", words=words)

    def test_draws_the_zones_into_every_picture(self):
        shot = ["render", "s.pbrt", *LENS, "--spp", "2", "--quiet"]
        for sensor in ([], ["--sensor", "third-inch-1280x960", "--size", "48x36"]):
            self.assert_succeeds(*shot, *sensor, "--show-zones", "-o", "a.png")
            pixels = read_png(self.folder / "a.png")
            self.assertEqual((len(pixels[0]), len(pixels)), (48, 36))
            yellow = {(x, y) for y, row in enumerate(pixels) for x, pixel in enumerate(row) if pixel == (255, 231, 0)}
            rim = {(x, y) for x in range(16, 32) for y in range(12, 24) if x in (16, 31) or y in (12, 23)}  # the middle ninth
            self.assertEqual(yellow, rim, sensor)

    def test_is_not_dazzled_by_a_lamp(self):
        # The lamp is thousands of times brighter than the wall, and 1 % of the picture and more.
        lamp = SCENE.replace('"float radius" .05', '"float radius" .3')
        (self.folder / "lamp.pbrt").write_text(lamp)
        said = self.petzval("render", "lamp.pbrt", "--pinhole", "--spp", "16", "-o", "a.png", "-o", "a.exr")
        self.assertIn("of what is no lamp", said.stderr)
        brighter = self.petzval("render", "lamp.pbrt", "--pinhole", "--spp", "16", "--exposure-compensation", "1", "-o", "b.png")
        white = [float(re.search(r"white is ([\d.e+]+) lx", each.stderr)[1]) for each in (said, brighter)]
        self.assertAlmostEqual(white[1] / white[0], 0.5, places=3)
        # White is what saturates ISO 100: 78/100/t lux.
        fixed = self.petzval("render", "lamp.pbrt", "--pinhole", "--spp", "2", "--exposure", "1/50", "-o", "b.png")
        self.assertIn("white is 39 lx", fixed.stderr)
        ev = self.petzval("render", "s.pbrt", *LENS, "--f-number", "4", "--spp", "2", "--exposure", "ev:10", "-o", "b.png", "--json")
        n = json.loads(ev.stdout)["working_f_number"]
        self.assertAlmostEqual(float(re.search(r"white is ([\d.e+]+) lx", ev.stderr)[1]), 0.78 * 1024 / n**2, delta=0.05)
        self.assert_refused("render", "s.pbrt", *LENS, "--exposure", "1", "--white", "3", "-o", "x.png", words=["--white", "--exposure"])

    def test_develops_by_the_light_of_the_lamp(self):
        # A red wall fills the frame: it is not the grey of the world.
        shot = ["render", "s.pbrt", *LENS, "--sensor", "third-inch-1280x960", "--size", "48x36", "--spp", "32", "--quiet"]
        self.assert_succeeds(*shot, "-o", "a.dng")
        neutral = self.json_of(*shot, "-o", "b.dng")["as_shot_neutral"]
        lamp = self.json_of(*shot, "--illuminant", "2800K", "-o", "c.dng")["as_shot_neutral"]
        for ours, right in zip(neutral, lamp):
            self.assertAlmostEqual(ours / right, 1, delta=0.15)  # the sky is a part of the light
        self.assert_succeeds(*shot, "-o", "d.exr")
        self.assert_succeeds("sense", "d.exr", "--sensor", "third-inch-1280x960", "--quiet", "-o", "d.dng")
        self.assertEqual((self.folder / "a.dng").read_bytes(), (self.folder / "d.dng").read_bytes())

    def test_layers_stand_beside_the_light(self):
        options = ["render", "s.pbrt", "--pinhole", "--wavelengths", "500,600", "--spp", "4", "--quiet"]
        self.assert_succeeds(*options, "--layers", "-o", "a.exr", "--depth", "d.npy", "--albedo", "r.npy", "--normals", "n.npy")
        channels = (self.folder / "a.exr").read_bytes()[:2000]
        for name in (b"Z\0", b"N.X\0", b"N.Y\0", b"N.Z\0", b"S0.500,0nm\0", b"T.500,0nm\0"):
            self.assertIn(name, channels, name)
        depth, albedo = numpy.load(self.folder / "d.npy"), numpy.load(self.folder / "r.npy")
        self.assertTrue(numpy.isinf(depth[0]).any(), "above the wall there is nothing")
        self.assertAlmostEqual(depth[30, 24], 2, places=5)
        self.assertLessEqual(albedo.max(), 1 + 1e-6)
        self.assert_refused(*options, "--layers", "-o", "x.png", words=["--layers", ".exr"])
        self.assert_succeeds(*options, "--segments", "s.npy", "-o", "b.npy")
        segments = numpy.load(self.folder / "s.npy")
        self.assertEqual(segments.shape, (*depth.shape, 3))
        self.assertTrue((segments[0, :, 0] == -1).any())
        self.assertGreaterEqual(segments[30, 24, 0], 0)

    def test_scales_the_lights(self):
        for scale, name in (("1", "a"), ("4", "b")):
            self.assert_succeeds("render", "s.pbrt", "--pinhole", "--spp", "4", "--light-scale", scale, "--quiet", "-o", f"{name}.npy")
        a, b = (numpy.load(self.folder / f"{name}.npy") for name in "ab")
        numpy.testing.assert_allclose(b, 4 * a, rtol=1e-5)

    def test_estimates_before_it_works(self):
        said = self.json_of("render", "s.pbrt", *LENS, "--size", "400x300", "--spp", "100", "--dry-run")
        self.assertEqual(said["samples_per_pixel"], 100)
        self.assertGreater(said["seconds"], said["probe_seconds"])
        self.assertGreaterEqual(said["memory_bytes"], 400 * 300 * 31 * 8)
        self.assertIn("spheres", self.assert_succeeds("render", "--list"))
        self.assertIn("spheres", self.assert_succeeds("scene", "list"))

    def test_names_what_a_checkpoint_differs_in(self):
        options = ["render", "s.pbrt", "--lens", "dgauss-50mm", "--spp", "16", "--checkpoint", "c.petzval", "--quiet"]
        self.assert_succeeds(*options, "--focus", "2m", "-o", "a.npy")
        self.assert_refused(*options, "--focus", "3m", "-o", "b.npy", words=["c.petzval", "focus: film"])
        self.assert_refused(*options, "--focus", "2m", "--camera-at", "0,0,-2", "-o", "b.npy", words=["c.petzval", "camera's place"])

    def test_sweeps_focus_and_keeps_the_world(self):
        said = self.json_of("sweep", "render", "s.pbrt", "--lens", "dgauss-50mm", "--spp", "4", "--vary", "focus=1m:0.5m:2m", "-o", "pull")
        self.assertEqual([row["focus"] for row in said["rows"]], ["1m", "1.5m", "2m"])
        for row, metres in zip(said["rows"], (1, 1.5, 2)):
            self.assertAlmostEqual(row["distance_in_focus_m"], metres, places=6)
        self.assert_succeeds("render", "s.pbrt", "--lens", "dgauss-50mm", "--spp", "4", "--focus", "1.5m", "--quiet", "-o", "one.png")
        self.assertEqual((self.folder / "pull/point-0001.png").read_bytes(), (self.folder / "one.png").read_bytes())
        self.assertTrue((self.folder / "pull/contact-sheet.png").exists())
        five = self.json_of("sweep", "render", "s.pbrt", "--lens", "dgauss-50mm", "--spp", "2", "--vary", "f-number=2.8:8", "--frames", "5",
                            "-o", "stops")
        numpy.testing.assert_allclose([row["f-number"] for row in five["rows"]], numpy.linspace(2.8, 8, 5))
        for vary, words in [("focus=1m:2m", ["--frames"]), ("focus=1m:0.5:2m", ["one unit"]), ("focus=1m:2m:0.5m", ["1m:0.5m:2m"])]:
            self.assert_refused("sweep", "render", "s.pbrt", "--lens", "dgauss-50mm", "--vary", vary, "-o", "x", words=words)
        self.assert_refused("render", "s.pbrt", "--vary", "focus=1m:2m", "-o", "x.png", words=["petzval sweep render"])


if __name__ == "__main__":
    unittest.main()
