# SPDX-License-Identifier: BSD-3-Clause
"""Names of outputs: never those of what is read, never one name twice, and known to be good before the work begins."""

import os
import shutil
import subprocess
import unittest

from petzval_cli import ProgramTest
from sample_files import SINGLET

LENS = ["--lens", "edmund-54852", "--sensor", "16x12@100", "--wavelengths", "550"]
TABLE = ["--fields", "2", "--wavelengths", "550", "--image-height", "1", "--quiet"]
# Hours of work: a refusal that comes after it does not come.
SLOW = ["image", "studio", "--lens", "dgauss-50mm", "--sensor", "3000x2000@10", "--wavelengths", "400:10:700", "--method", "exact"]
IN_TIME_S = 600
NOBODY = 65534

TEXTURED = """
Film "rgb" "integer xresolution" [16] "integer yresolution" [12] "string filename" "x.exr"
Camera "perspective" "float fov" [40]
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Texture "bark" "spectrum" "imagemap" "string filename" "bark.png"
Material "diffuse" "texture reflectance" "bark"
Translate 0 0 3
Shape "sphere" "float radius" [1]
"""


class OutputOverInput(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("lens.json", SINGLET)
        self.write("rays.csv", "x_mm,y_mm,z_mm,L,M,N,wavelength_nm\n0,0.1,-5,0,0,1,587.56\n")
        self.assert_succeeds("scene", "convert", "wall", "wall.exr", "--scene-size", "40x30", "--wavelengths", "550")
        self.assert_succeeds("scene", "convert", "cards", "--depth", "depth.npy", "--scene-size", "40x30")

    def assert_keeps(self, source, *command):
        self.assert_refused(*command, words=["would overwrite", source])

    def test_lenses(self):
        self.assert_keeps("lens.json", "lens", "convert", "lens.json", "lens.json")
        self.assert_keeps("lens.json", "lens", "scale", "lens.json", "--factor", "2", "-o", "lens.json")
        self.assert_keeps("lens.json", "optics", "build", "lens.json", *TABLE, "-o", "lens.json")
        self.assert_keeps("rays.csv", "lens", "trace", "lens.json", "--rays", "rays.csv", "-o", "rays.csv")

    def test_tables(self):
        self.assert_succeeds("optics", "build", "lens.json", *TABLE, "-o", "table.h5")
        self.assert_keeps("table.h5", "optics", "import", "table.h5", "--from", "hdf5", "-o", "table.h5")
        shutil.copy(self.folder / "table.h5", self.folder / "table.mat")
        self.assert_keeps("table.mat", "optics", "export", "table.mat", "--to", "iset", "--resample", "-o", "table.mat")

    def test_scenes(self):
        self.assert_keeps("wall.exr", "image", "wall.exr", *LENS, "-o", "wall.exr")
        self.assert_keeps("wall.exr", "image", "wall.exr", *LENS, "-o", "fine.npy", "-o", "wall.exr")
        self.assert_keeps("depth.npy", "image", "wall.exr", "--scene-depth", "depth.npy", *LENS, "-o", "depth.npy")
        self.assert_keeps("wall.exr", "scene", "convert", "wall.exr", "wall.exr")

    def test_what_is_read_with_a_scene(self):
        self.write("cube.hdr", "ENVI\nsamples = 2\nlines = 2\nbands = 1\ndata type = 4\ninterleave = bsq\nwavelength = {550}\n")
        self.write("cube.img", bytes(16))
        self.write("array.npy", (self.folder / "depth.npy").read_bytes())
        self.write("array.json", {"wavelengths_nm": [550]})
        for scene, output in [("cube.hdr", "cube.img"), ("cube.img", "cube.hdr"), ("array.npy", "array.json")]:
            self.assert_keeps(output, "image", scene, *LENS, "-o", output)
        self.assert_refused("image", "cube.hdr", *LENS, "-o", "cube.dat", words=["irradiance is written as"])

    def test_bundled_files_by_name(self):
        (self.folder / "data" / "lenses").mkdir(parents=True)
        os.symlink(os.path.join(os.environ["PETZVAL_DATA"], "glass"), self.folder / "data" / "glass")
        self.write("data/lenses/mine.json", SINGLET)
        bundled = {"env": dict(os.environ, PETZVAL_DATA=str(self.folder / "data"))}
        scale = ["lens", "scale", "mine", "--factor", "2", "-o"]
        self.assert_refused(*scale, "data/lenses/mine.json", words=["would overwrite", "mine"], **bundled)
        self.assert_succeeds(*scale, "data/lenses/twice.json", **bundled)
        self.assert_succeeds(*scale, "mine.json", **bundled)

    def test_light_and_shapes(self):
        self.assert_succeeds("image", "wall", "--lens", "edmund-54852", "--sensor", "third-inch-1280x960", "--sensor-set",
                             "columns=16", "--sensor-set", "rows=12", "--wavelengths", "550", "-o", "light.exr")
        self.assert_keeps("light.exr", "sense", "light.exr", "--sensor", "third-inch-1280x960", "-o", "light.exr")
        self.write("shape.svg", '<svg xmlns="http://www.w3.org/2000/svg"><rect width="9" height="9"/></svg>')
        self.assert_keeps("shape.svg", "target", "--polygons", "shape.svg", "-o", "out.png", "--plot", "shape.svg")
        self.write("sfr.csv", "frequency_cpp,sfr\n0,1\n0.5,0.2\n")
        self.assert_keeps("sfr.csv", "sfr", "edge.png", "--plot", "a.svg", "--against", "sfr.csv", "--csv", "sfr.csv")

    def test_what_the_scene_of_a_rendering_names(self):
        self.write("scene.pbrt", TEXTURED)
        self.assert_succeeds("scene", "convert", "checkerboard", "bark.png", "--scene-size", "32x32")
        render = ["render", "scene.pbrt", "--pinhole", "--wavelengths", "550", "--spp", "1"]
        self.assert_succeeds(*render, "-o", "out.png")
        self.assert_keeps("bark.png", *render, "-o", "bark.png")
        self.assert_keeps("scene.pbrt", *render, "-o", "out.png", "--checkpoint", "scene.pbrt")

    def test_other_ways_of_writing_a_name(self):
        (self.folder / "below").mkdir()
        os.symlink("wall.exr", self.folder / "link.exr")
        for source, output in [("wall.exr", "./wall.exr"), ("wall.exr", "below/../wall.exr"), ("wall.exr", "link.exr"),
                               ("link.exr", "wall.exr"), (str(self.folder / "wall.exr"), "wall.exr")]:
            self.assert_keeps(source, "image", source, *LENS, "-o", output)

    def test_the_same_name_twice(self):
        for first, second in [("x.npy", "x.npy"), ("x.npy", "./x.npy"), (str(self.folder / "x.npy"), "x.npy")]:
            self.assert_refused("image", "wall", *LENS, "-o", first, "-o", second, words=["same file", "of its own"])
        (self.folder / "x.npy").touch()
        os.symlink("x.npy", self.folder / "y.npy")
        self.assert_refused("image", "wall", *LENS, "-o", "x.npy", "-o", "y.npy", words=["same file"])
        self.assert_refused("lens", "wavefront", "lens.json", "--plot", "w.svg", "--map", "w.svg", words=["--plot", "--map"])
        self.assert_refused("develop", "raw.dng", "-o", "a.png", "--step", "linear=./a.png", words=["same file"])

    def test_a_name_of_its_own_is_written(self):
        """A file beside those that are read may be there and is replaced: what is refused above is not just what exists."""
        self.write("other.exr", "old")
        self.assert_succeeds("image", "wall.exr", *LENS, "-o", "other.exr")
        self.assertNotEqual((self.folder / "other.exr").read_bytes(), b"old")
        self.assert_succeeds("lens", "convert", "lens.json", "again.json")
        self.assert_succeeds("lens", "convert", "lens.json", "again.json")


class OutputsBeforeTheWork(ProgramTest):
    def test_kinds_of_tables(self):
        self.write("lens.json", SINGLET)
        self.assert_refused("optics", "build", "lens.json", *TABLE, "-o", "table.txt", words=["table.txt", ".h5"])
        self.assert_succeeds("optics", "build", "lens.json", *TABLE, "-o", "table.hdf5")
        self.assert_refused("optics", "import", "table.hdf5", "--from", "hdf5", "-o", "b.mat", words=["b.mat", ".h5"])
        self.assert_refused("optics", "export", "table.hdf5", "--to", "iset", "--resample", "-o", "b.txt", words=["b.txt", ".mat"])
        self.write("taken", "")
        zemax = ["optics", "export", "table.hdf5", "--to", "zemax", "--resample", "-o"]
        self.assert_refused(*zemax, "taken", words=["taken"])
        self.assert_refused(*zemax, "nowhere/texts", words=["nowhere/texts", "make it first"])
        self.assert_succeeds(*zemax, "texts/")

    def test_no_name(self):
        self.assert_refused("image", "wall", *LENS, "-o", "", words=["--output", "empty", "would be right"])
        self.assert_refused("sweep", "image", "wall", *LENS, "--vary", "f-number=2,4", "-o", "", words=["--output", "empty"])

    def test_a_folder_that_is_not_there(self):
        self.assert_refused(*SLOW, "-o", "nowhere/x.npy", words=["nowhere/x.npy", "make it first"], timeout=IN_TIME_S)
        self.assert_refused(*SLOW, "-o", "/proc/x.npy", code=1, words=["/proc/x.npy: "], timeout=IN_TIME_S)
        self.write("taken", "")
        self.assert_refused("demo", "-o", "taken", words=["taken"], timeout=IN_TIME_S)
        self.assert_refused("demo", "-o", "taken/below", words=["taken"], timeout=IN_TIME_S)

    @unittest.skipUnless(os.geteuid() == 0, "only root may become somebody else; test_output_files has this for others")
    def test_a_folder_without_permission(self):
        locked = self.folder / "locked"
        locked.mkdir(mode=0o755)
        os.chmod(self.folder, 0o755)

        def as_nobody(*command):
            return self.petzval(*command, timeout=IN_TIME_S, preexec_fn=lambda: os.setuid(NOBODY))

        try:
            reachable = as_nobody("lens", "info", "edmund-54852").returncode == 0
        except (OSError, subprocess.SubprocessError):
            reachable = False
        if not reachable:
            self.skipTest("others may not come to where the program, its data or temporary files are")
        for command, named in [([*SLOW, "-o", "locked/x.npy"], "locked/x.npy"),
                               ([*SLOW, "-o", "locked/x.dng", "-o", "locked/x.png"], "locked/x.dng"),
                               (["demo", "-o", "locked/demo"], "locked/demo"),
                               (["sweep", *SLOW, "--vary", "f-number=2,4", "-o", "locked/sweep"], "locked/sweep"),
                               (["optics", "build", "edmund-54852", "-o", "locked/t.h5"], "locked/t.h5")]:
            done = as_nobody(*command)
            self.assert_error(done, 1, named)
            self.assertNotIn(".petzval", done.stderr)
        self.assertEqual(list(locked.iterdir()), [])


if __name__ == "__main__":
    unittest.main()
