# SPDX-License-Identifier: BSD-3-Clause
"""petzval render and petzval focus: pictures of three-dimensional scenes, and what they refuse."""

import unittest

from petzval_cli import ProgramTest

SCENE = """LookAt 0 0 -1  0 0 0  0 1 0
Camera "perspective"
Film "rgb" "integer xresolution" 32 "integer yresolution" 24 "float diagonal" 40
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Texture "t" "spectrum" "checkerboard" "float uscale" 40 "float vscale" 40 "rgb tex1" [ .9 .9 .9 ] "rgb tex2" [ .1 .1 .1 ]
Material "diffuse" "texture reflectance" "t"
Shape "bilinearmesh" "point3 P" [ -2 -2 .4  2 -2 .4  -2 2 .4  2 2 .4 ]
"""
LENS = ["--lens", "dgauss-50mm", "--film-distance", "38"]


class Render(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "s.pbrt").write_text(SCENE)

    def test_writes_every_output(self):
        said = self.json_of("render", "s.pbrt", *LENS, "--spp", "8", "-o", "a.exr", "-o", "a.npy", "-o", "a.png", "--depth",
                            "d.npy", "--normals", "n.npy", "--albedo", "r.npy")
        self.assertEqual((said["columns"], said["rows"]), (32, 24))
        self.assertEqual(said["film_distance_mm"], 38)
        self.assertGreater(said["camera_rays_passed"] / said["camera_rays"], 0.9)
        self.assertEqual(sorted(self.contents()), ["a.exr", "a.npy", "a.png", "d.npy", "n.npy", "r.npy", "s.pbrt"])

    def test_seed_decides_and_threads_do_not(self):
        def picture(*options):
            self.assert_succeeds("render", "s.pbrt", *LENS, "--spp", "4", "--quiet", *options, "-o", "p.npy")
            return (self.folder / "p.npy").read_bytes()
        self.assertEqual(picture("--threads", "1"), picture("--threads", "2"))
        self.assertNotEqual(picture(), picture("--seed", "7"))

    def test_refuses_what_makes_no_sense(self):
        for options, part in [
                (["--spp", "0"], "--spp"), (["--size", "0x4"], "--size"), (["--size", "big"], "--size"),
                (["--film-distance", "-1"], "film"), (["--pinhole", "--lens", "dgauss-50mm"], "--pinhole"),
                (["--film-distance", "30"], "--lens"), (["--lens", "no-such-lens"], "no-such-lens"),
                ([*LENS, "--aperture-diameter", "0"], "stop"), ([*LENS, "--focus-distance", "1"], "either"),
                ([*LENS, "--aperture-diameter", "3", "--f-number", "4"], "either"),
                (["--lens", "dgauss-50mm", "--focus-distance", "0.01"], "focus"), ([*LENS, "--scene-unit", "0"], "--scene-unit")]:
            with self.subTest(options=options):
                self.assert_refused("render", "s.pbrt", *options, "-o", "x.npy", words=[part])
        self.assert_refused("render", "s.pbrt", "-o", "x.jpg", words=[".exr"])
        self.assert_refused("render", "s2.pbrt", "-o", "x.npy", words=["s2.pbrt"])

    def test_lists_what_is_not_supported(self):
        (self.folder / "s.pbrt").write_text('WorldBegin\nMaterial "hair"\nShape "curve"\n')
        rows = self.json_of("render", "s.pbrt", "--list-unsupported")["rows"]
        self.assertEqual([(row["line"], row["column"]) for row in rows], [(2, 1), (3, 1)])
        self.assert_refused("render", "s.pbrt", "-o", "x.npy", words=["s.pbrt:2:1: "])

    def test_focuses_on_the_wall(self):
        (self.folder / "z.txt").write_text("0.1 0.9 0.1 0.9\n")
        said = self.json_of("focus", "s.pbrt", "--lens", "dgauss-50mm", "--zones", "z.txt", "--size", "128x96", "--plot", "f.svg")
        self.assertLessEqual(len(said["rows"]), 12)
        self.assertTrue((self.folder / "f.svg").read_text().startswith("<"))
        # The wall stands 1.4 m from the film: the paraxial focus of that distance, within the depth of focus.
        exact = self.json_of("render", "s.pbrt", "--lens", "dgauss-50mm", "--focus-distance", "1.4", "--spp", "4", "-o", "x.npy")
        self.assertAlmostEqual(said["film_distance_mm"], exact["film_distance_mm"], delta=2 * 40 / 160)
        picture = self.json_of("render", "s.pbrt", "--lens", "dgauss-50mm", "--autofocus", "z.txt", "--size", "128x96", "--spp",
                               "4", "-o", "y.npy")
        self.assertAlmostEqual(picture["film_distance_mm"], said["film_distance_mm"], delta=1e-9)


if __name__ == "__main__":
    unittest.main()
