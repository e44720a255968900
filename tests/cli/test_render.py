# SPDX-License-Identifier: BSD-3-Clause
"""petzval render and petzval focus: pictures of three-dimensional scenes, and what they refuse."""

import pathlib
import re
import resource
import signal
import struct
import subprocess
import sys
import time
import unittest

from petzval_cli import PROGRAM, ProgramTest

SCENE = """LookAt 0 0 -1  0 0 0  0 1 0
Camera "perspective"
Film "rgb" "integer xresolution" 32 "integer yresolution" 24 "float diagonal" 40
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Texture "t" "spectrum" "checkerboard" "float uscale" 40 "float vscale" 40 "rgb tex1" [ .9 .9 .9 ] "rgb tex2" [ .1 .1 .1 ]
Material "diffuse" "texture reflectance" "t"
Shape "bilinearmesh" "point3 P" [ -2 -2 .4  2 -2 .4  -2 2 .4  2 2 .4 ]
"""
PLY = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
0 0 9
1 0 9
0 1 9
3 0 1 2
"""
EXAMPLES = pathlib.Path(__file__).parents[2] / "examples"
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
        for file, shape in [("a.npy", b"(24, 32, 31)"), ("r.npy", b"(24, 32, 31)"), ("n.npy", b"(24, 32, 3)"), ("d.npy", b"(24, 32)")]:
            self.assertIn(shape, (self.folder / file).read_bytes()[:128], file)

    def test_albedo_has_the_bands_of_a_pixel_side_by_side(self):
        red = SCENE.replace('"texture reflectance" "t"', '"rgb reflectance" [ .9 .1 .1 ]')
        (self.folder / "red.pbrt").write_text(red)
        self.assert_succeeds("render", "red.pbrt", *LENS, "--spp", "4", "--quiet", "-o", "a.npy", "--albedo", "r.npy")
        data = (self.folder / "r.npy").read_bytes()
        values = struct.unpack(f"<{24 * 32 * 31}f", data[-4 * 24 * 32 * 31:])
        middle = values[31 * (12 * 32 + 16):31 * (12 * 32 + 17)]
        self.assertLess(middle[13], 0.3)  # 530 nm
        self.assertGreater(middle[25], 0.7)  # 650 nm

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
                ([*LENS, "--aperture-diameter", "0"], "stop"), ([*LENS, "--focus", "1m"], "--focus"),
                ([*LENS, "--aperture-diameter", "3", "--f-number", "4"], "--f-number"),
                ([*LENS, "--zone", "0.1,0.9,0.1,0.9"], "--film-distance"), (["--lens", "dgauss-50mm", "--focus", "1m", "--focus-distance", "1"], "--focus-distance"),
                (["--lens", "dgauss-50mm", "--focus", "1m", "--zone", "0.1,0.9,0.1,0.9"], "--focus 1m"), (["--focus", "auto"], "--lens"),
                (["--lens", "dgauss-50mm", "--focus", "1.2"], "1.2m"), (["--pinhole", "--focus", "1m"], "--lens"),
                (["--lens", "dgauss-50mm", "--focus", "1cm"], "focus"), ([*LENS, "--scene-unit", "0"], "--scene-unit")]:
            with self.subTest(options=options):
                self.assert_refused("render", "s.pbrt", *options, "-o", "x.npy", words=[part])
        self.assert_refused("render", "s.pbrt", "-o", "x.jpg", words=[".exr"])
        self.assert_refused("render", "s2.pbrt", "-o", "x.npy", words=["s2.pbrt"])

    def test_a_lens_that_passes_no_light_says_so(self):
        for more in ([], ["--sampling", "exit-pupil"]):
            self.assert_refused("render", "s.pbrt", *LENS, "--aperture-diameter", "1e-9", *more, "-o", "x.npy",
                                words=["no light reaches the film", "stop"])

    def test_two_million_triangles_are_ready_in_five_seconds(self):
        """Processor time of the whole run, from the file to the search tree and a picture of one pixel."""
        side = 1000
        row = [struct.pack("<3f", 2 * j / side - 1, 0, 0)[:4] for j in range(side + 1)]
        vertices = b"".join(x + struct.pack("<2f", 2 * i / side - 1, 3 + 1e-3 * (i % 2))
                            for i in range(side + 1) for x in row)
        face = struct.Struct("<B3IB3I")
        faces = b"".join(face.pack(3, k + 1, k, k + side + 1, 3, k + 1, k + side + 2, k + side + 1)
                         for i in range(side) for k in range(i * (side + 1), i * (side + 1) + side))
        header = ("ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
                  "property float z\nelement face %d\nproperty list uchar uint vertex_indices\nend_header\n")
        (self.folder / "sheet.ply").write_bytes((header % ((side + 1) ** 2, 2 * side * side)).encode() + vertices + faces)
        (self.folder / "big.pbrt").write_text('Camera "perspective" "float fov" 20\nWorldBegin\nLightSource "infinite"\n'
                                              'Shape "plymesh" "string filename" "sheet.ply"\n')
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.assert_succeeds("render", "big.pbrt", "--pinhole", "--size", "1x1", "--spp", "1", "--quiet", "-o", "one.npy")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.assertLess(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 5)

    def test_nine_of_ten_camera_rays_pass(self):
        # Films as large as what the lens images: the fisheye's circle, 78 degrees from the axis, is 27 mm wide.
        for lens, diagonal in (("dgauss-50mm", 43), ("wide-22mm", 43), ("telephoto-250mm", 43), ("fisheye-10mm", 24)):
            said = self.assert_succeeds("render", "spheres", "--lens", lens, "--film-diagonal", diagonal, "--focus",
                                        "2m", "--size", "40x30", "--spp", "16", "-o", "p.npy")
            with self.subTest(lens=lens):
                self.assertGreater(float(re.search(r"([\d.]+) % of \d+ camera rays pass", said)[1]), 90)

    def test_lists_what_is_not_supported(self):
        (self.folder / "s.pbrt").write_text('WorldBegin\nMaterial "hair"\nShape "nurbs"\n')
        rows = self.json_of("render", "s.pbrt", "--list-unsupported")["rows"]
        self.assertEqual([(row["line"], row["column"]) for row in rows], [(2, 1), (3, 1)])
        self.assert_refused("render", "s.pbrt", "-o", "x.npy", words=["s.pbrt:2:1: "])

    def test_diffracts(self):
        def picture(*options):
            self.assert_succeeds("render", "s.pbrt", *LENS, "--f-number", "64", "--spp", "8", "--wavelengths", "550", "--quiet",
                                 *options, "-o", "p.npy")
            return (self.folder / "p.npy").read_bytes()
        waves = picture("--diffraction", "--threads", "1")
        self.assertEqual(waves, picture("--diffraction", "--threads", "2"))
        self.assertNotEqual(waves, picture())
        self.assertNotEqual(waves, picture("--diffraction", "--blades", "5"))
        self.assert_refused("render", "s.pbrt", "--pinhole", "--diffraction", "-o", "p.npy", words=["diffraction"])

    def test_reads_gltf(self):
        subprocess.run([sys.executable, EXAMPLES / "gltf_vases.py", self.folder / "vases.gltf"], check=True)
        def picture(*options):
            self.assert_succeeds("render", "vases.gltf", "--size", "16x12", "--spp", "4", "--quiet", *options, "-o", "p.npy")
            return (self.folder / "p.npy").read_bytes()
        self.assertEqual(picture("--threads", "1"), picture("--threads", "2"))
        self.assertNotEqual(picture(), picture("--sky", "100"))
        text = (self.folder / "vases.gltf").read_text()
        (self.folder / "vases.gltf").write_text(text.replace('"KHR_materials_emissive_strength": {"', '"KHR_materials_iridescence": {}, "KHR_materials_emissive_strength": {"'))
        rows = self.json_of("render", "vases.gltf", "--list-unsupported")["rows"]
        self.assertEqual([(row["path"], row["unsupported"]) for row in rows], [("materials[4].extensions.KHR_materials_iridescence", "this extension")])
        self.assert_refused("render", "vases.gltf", "-o", "x.npy", words=["materials[4].extensions.KHR_materials_iridescence", "--list-unsupported"])
        done = self.petzval("render", "vases.gltf", "--skip-unsupported", "--size", "16x12", "--spp", "4", "-o", "x.npy")
        self.assertEqual(done.returncode, 0)
        self.assertIn("left out", done.stderr)
        (self.folder / "vases.gltf").write_text(text[:5000])
        self.assert_refused("render", "vases.gltf", "-o", "x.npy", words=["no sound glTF"])

    def test_focuses_on_the_wall(self):
        (self.folder / "z.txt").write_text("0.1 0.9 0.1 0.9\n")
        said = self.json_of("focus", "s.pbrt", "--lens", "dgauss-50mm", "--zones", "z.txt", "--size", "128x96", "--plot", "f.svg")
        self.assertLessEqual(len(said["rows"]), 12)
        self.assertTrue((self.folder / "f.svg").read_text().startswith("<"))
        # The wall stands 1.4 m from the film: the paraxial focus of that distance, within the depth of focus.
        exact = self.json_of("render", "s.pbrt", "--lens", "dgauss-50mm", "--focus", "1.4m", "--spp", "4", "-o", "x.npy")
        self.assertAlmostEqual(said["film_distance_mm"], exact["film_distance_mm"], delta=2 * 40 / 160)
        picture = self.json_of("render", "s.pbrt", "--lens", "dgauss-50mm", "--autofocus", "z.txt", "--size", "128x96", "--spp",
                               "4", "-o", "y.npy")
        self.assertAlmostEqual(picture["film_distance_mm"], said["film_distance_mm"], delta=1e-9)

    def test_counts_what_the_lens_takes(self):
        def mean(*options):
            return self.json_of("render", "s.pbrt", *LENS, "--spp", "16", *options, "-o", "a.npy")["mean_irradiance"]
        clear = mean()
        # Eight of the ten refracting surfaces lie between air and glass.
        self.assertAlmostEqual(mean("--coating", "0.01") / clear, 0.99 ** 8, delta=1e-4)
        # Each takes 6 to 7 % at right angles, for indices of 1.6 to 1.72, and more at the rim.
        bare = mean("--fresnel") / clear
        self.assertTrue(0.5 < bare < 0.94 ** 8, bare)
        (self.folder / "c.csv").write_text("wavelength_nm,air_glass\n400,0\n700,0\n")
        self.assertAlmostEqual(mean("--coating", "c.csv", "--fresnel") / clear, 1, delta=1e-3)  # cement: 4e-4
        self.assert_refused("render", "s.pbrt", "--fresnel", "-o", "a.npy", words=["--lens"])

    def test_ends_at_a_noise(self):
        noisy = self.json_of("render", "s.pbrt", *LENS, "--noise", "0.1", "-o", "a.npy")
        quiet = self.json_of("render", "s.pbrt", *LENS, "--noise", "0.03", "--threads", "1", "-o", "b.npy")
        self.assertTrue(0.03 < noisy["noise"] <= 0.1, noisy["noise"])
        self.assertTrue(0.01 < quiet["noise"] <= 0.03, quiet["noise"])
        self.assertLess(noisy["samples_per_pixel"], quiet["samples_per_pixel"])
        self.assert_succeeds("render", "s.pbrt", *LENS, "--noise", "0.03", "--threads", "2", "-o", "c.npy")
        self.assertEqual((self.folder / "b.npy").read_bytes(), (self.folder / "c.npy").read_bytes())
        done = self.petzval("render", "s.pbrt", *LENS, "--noise", "0.001", "--spp", "64", "-o", "d.npy")
        self.assertIn("a larger --spp", done.stderr)
        self.assertIsNone(self.json_of("render", "s.pbrt", *LENS, "--spp", "4", "-o", "e.npy")["noise"])
        self.assert_refused("render", "s.pbrt", *LENS, "--noise", "0", "-o", "x.npy", words=["--noise"])

    def rendering(self, output, **changed):
        """The words of a rendering that saves itself after every pass, with some options changed or (None) left out."""
        options = {"lens": "dgauss-50mm", "film-distance": 38, "spp": 256, "size": "64x48", "seed": 3, "threads": 2,
                   "checkpoint": "c.petzval", "checkpoint-seconds": 0,
                   **{name.replace("_", "-"): value for name, value in changed.items()}}
        words = [word for name, value in options.items() if value is not None for word in ("--" + name, str(value))]
        return ["render", "s.pbrt", *words, "-o", output]

    def killed(self):
        """Starts a rendering and kills it as soon as it has saved anything."""
        with subprocess.Popen([PROGRAM, *self.rendering("killed.npy")], cwd=self.folder, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as running:
            until = time.monotonic() + 60
            while not (self.folder / "c.petzval").exists() and running.poll() is None and time.monotonic() < until:
                time.sleep(0.005)
            running.kill()
        self.assertEqual(running.returncode, -signal.SIGKILL, "killed before its end, or it ended too soon to tell")
        self.assertTrue((self.folder / "c.petzval").exists())
        self.assertFalse((self.folder / "killed.npy").exists())

    def test_goes_on_after_a_kill_to_the_same_bytes(self):
        self.killed()
        self.assert_succeeds(*self.rendering("resumed.npy"))
        self.assert_succeeds(*self.rendering("whole.npy", threads=1, checkpoint=None, checkpoint_seconds=None))
        self.assertEqual((self.folder / "resumed.npy").read_bytes(), (self.folder / "whole.npy").read_bytes())

    def test_writes_what_there_is_when_stopped_and_goes_on_to_the_same_bytes(self):
        picture, checkpoint = self.folder / "p.npy", self.folder / "c.petzval"
        for sent in (signal.SIGINT, signal.SIGTERM):
            picture.unlink(missing_ok=True)
            with subprocess.Popen([PROGRAM, *self.rendering("p.npy")], cwd=self.folder, stdout=subprocess.DEVNULL,
                                  stderr=subprocess.PIPE, text=True) as running:
                until, before = time.monotonic() + 60, checkpoint.stat().st_mtime_ns if checkpoint.exists() else 0
                while running.poll() is None and time.monotonic() < until:
                    if checkpoint.exists() and checkpoint.stat().st_mtime_ns != before:
                        break
                    time.sleep(0.005)
                running.send_signal(sent)
                said = running.stderr.read()
            self.assertEqual(running.returncode, 130, said)
            self.assertIn("goes on from c.petzval", said)
            self.assertTrue(picture.exists())
            self.assertEqual(sorted(self.contents()), ["c.petzval", "p.npy", "s.pbrt"])
        self.assert_succeeds(*self.rendering("p.npy"))
        self.assert_succeeds(*self.rendering("whole.npy", threads=1, checkpoint=None, checkpoint_seconds=None))
        self.assertEqual(picture.read_bytes(), (self.folder / "whole.npy").read_bytes())

    def test_adds_samples_to_a_finished_picture(self):
        # 31 bands take four groups: 12 samples end amid a pass of 16, 32 after two of them, 40 amid the third.
        for samples in (12, 32, 40):
            self.assert_succeeds(*self.rendering("added.npy", spp=samples))
            self.assert_succeeds(*self.rendering("whole.npy", spp=samples, checkpoint=None, checkpoint_seconds=None))
            self.assertEqual((self.folder / "added.npy").read_bytes(), (self.folder / "whole.npy").read_bytes(), samples)
        self.assert_refused(*self.rendering("x.npy", spp=16), words=["c.petzval", "32 samples", "--spp"])

    def piece(self, name, **changed):
        """Renders a piece of the picture into NAME.sums."""
        self.assert_succeeds(*self.rendering("none.npy", checkpoint=name + ".sums", spp=48, checkpoint_seconds=None, **changed))

    def test_pieces_of_a_picture_are_the_bytes_of_one_process(self):
        # 23 columns and 31 rows part tiles of 16 pixels; dgauss-50mm parts colours, so that light of one piece lands in another.
        self.piece("a", region="0,0,23,48", threads=1)
        self.piece("b", region="23,0,41,31", sample_range="16:48")
        self.piece("c", region="23,0,41,31", sample_range="0:16")
        self.piece("d", region="23,31,41,17")
        self.assertFalse((self.folder / "none.npy").exists())
        self.assert_succeeds(*self.rendering("whole.npy", spp=48, checkpoint="whole.sums"))
        for order in ("abcd", "dbca"):
            self.assert_succeeds("merge", *[name + ".sums" for name in order], "-o", "merged.sums")
            self.assertEqual((self.folder / "merged.sums").read_bytes(), (self.folder / "whole.sums").read_bytes(), order)
        self.assert_succeeds(*self.rendering("merged.npy", spp=48, checkpoint="merged.sums"))
        self.assertEqual((self.folder / "merged.npy").read_bytes(), (self.folder / "whole.npy").read_bytes())
        # What does not fit together.
        for pieces, words in (("abc", ["no piece has pixel 23,31 in pass 1"]), ("abcda", ["a.sums", "has pixel 0,0 in pass 1"]),
                              ("abd", ["no piece has pixel 23,0 in pass 1"])):
            self.assert_refused("merge", *[name + ".sums" for name in pieces], "-o", "x.sums", words=words)
        self.piece("e", region="23,31,41,17", seed=4)
        self.assert_refused("merge", *[name + ".sums" for name in "abce"], "-o", "x.sums", words=["e.sums", "seed 4", "a.sums has", "seed 3"])
        data = (self.folder / "d.sums").read_bytes()
        (self.folder / "f.sums").write_bytes(data[:-30] + bytes([data[-30] ^ 1]) + data[-29:])
        self.assert_refused("merge", *[name + ".sums" for name in "abcf"], "-o", "x.sums", words=["f.sums", "damaged"])
        # Another version, whose text is as long.
        at = data.index(b"petzval ", 30) + len("petzval ")
        (self.folder / "f.sums").write_bytes(data[:at] + b"9" + data[at + 1:])
        self.assert_refused("merge", *[name + ".sums" for name in "abcf"], "-o", "x.sums", words=["f.sums", '"petzval 9', "a.sums has"])
        self.assertFalse((self.folder / "x.sums").exists())

    def test_denoises_and_says_so(self):
        say = ["render", "s.pbrt", *LENS, "--wavelengths", "450,550,650", "--checkpoint", "sums", "--denoise-light"]
        said = self.json_of(*say, "--spp", "8", "-o", "a.exr", "-o", "a.png", "-o", "a.npy", "--threads", "1")
        self.assertIs(said["denoised"], True)
        for file in ["a.exr", "a.png"]:
            self.assertIn(b"denoised by non-local means", (self.folder / file).read_bytes(), file)
        self.assertIs(self.json_of("render", "s.pbrt", *LENS, "--spp", "8", "--wavelengths", "550", "-o", "raw.npy")["denoised"], False)
        # The checkpoint has the light as it was: more samples make the bytes of all at once.
        self.assert_succeeds(*say, "--spp", "16", "-o", "more.npy")
        (self.folder / "sums").unlink()
        self.assert_succeeds(*say, "--spp", "16", "-o", "at-once.npy")
        self.assertEqual((self.folder / "more.npy").read_bytes(), (self.folder / "at-once.npy").read_bytes())
        plain = [argument for argument in say if argument != "--denoise-light"]
        self.assert_refused(*plain, "--spp", "16", "-o", "b.npy", words=["to be denoised"])
        self.assert_refused(*say, "--spp", "16", "-o", "b.npy", "--light-groups", "l.npy", words=["--denoise-light", "--light-groups"])
        self.assert_refused(*say, "--spp", "16", "-o", "b.npy", "--region", "0,0,8,8", words=["--denoise-light"])

    def test_refuses_pieces_that_are_none(self):
        for changed, words in (({"region": "60,0,5,5"}, ["--region", "0,0 to 63,47"]), ({"region": "0,0,0,5"}, ["--region"]),
                               ({"sample_range": "8:16"}, ["--sample-range 8:16", "multiples of 16 from 0 to 256"]),
                               ({"sample_range": "0:16", "checkpoint": None}, ["--checkpoint"]),
                               ({"region": "0,0,5,5", "spp": 12}, ["--spp 12", "16 or more"]),
                               ({"region": "0,0,5,5", "noise": .1}, ["--noise"]), ({"region": "0,0,5"}, ["--region"])):
            self.assert_refused(*self.rendering("x.npy", **changed), words=words)

    def test_exposes_and_develops_as_sense_and_develop_do(self):
        sensor = ("--sensor", "third-inch-1280x960")
        light = ("render", "s.pbrt", *LENS, *sensor, "--size", "32x24", "--spp", "8", "--quiet")
        self.assert_succeeds(*light, "--illuminant", "D65", "--exposure", "0.01", "-o", "a.dng", "-o", "a.png", "-o", "a.tif")
        self.assert_succeeds(*light, "-o", "b.exr")
        self.assert_succeeds("sense", "b.exr", *sensor, "--illuminant", "D65", "--exposure", "0.01", "--quiet", "-o", "b.dng")
        self.assert_succeeds("develop", "b.dng", "--quiet", "-o", "b.png", "-o", "b.tif")
        for end in ("dng", "png", "tif"):
            self.assertEqual((self.folder / f"a.{end}").read_bytes(), (self.folder / f"b.{end}").read_bytes(), end)
        for options, part in [(["-o", "x.tif"], "--sensor"), (["-o", "x.dng"], "--sensor"), ([*sensor, "--white", "3", "-o", "x.png"], "--white"),
                              ([*sensor, "--exposure", "1", "-o", "x.exr"], "--exposure")]:
            self.assert_refused("render", "s.pbrt", *LENS, "--size", "8x8", *options, words=[part])

    def test_refuses_the_checkpoint_of_anything_else(self):
        (self.folder / "t.pbrt").write_text('Material "diffuse" "texture reflectance" "t"\n')
        (self.folder / "m.ply").write_text(PLY)
        (self.folder / "s.pbrt").write_text(SCENE.replace('Material "diffuse" "texture reflectance" "t"\n', 'Include "t.pbrt"\n')
                                            + 'Shape "plymesh" "string filename" "m.ply"\n')
        self.killed()

        def refused(word, **changed):
            self.assert_refused(*self.rendering("x.npy", **changed), words=["c.petzval", word])
        refused("seed 3", seed=4)
        refused("stop ", f_number=4)
        refused("focus: film 38", film_distance=38.001)
        refused("sampling exit-pupil", sampling="rear-disk")
        refused("wavelengths 400,410", wavelengths="500,600")
        for name, old, new in [("s.pbrt", "[ -2 -2 .4", "[ -2.1 -2 .4"), ("t.pbrt", "diffuse", "coateddiffuse"),
                               ("m.ply", "0 0 9", "0 0 8")]:
            kept = (self.folder / name).read_text()
            self.assertIn(old, kept)
            (self.folder / name).write_text(kept.replace(old, new))
            refused("file " + name)
            (self.folder / name).write_text(kept)
        self.assert_succeeds(*self.rendering("x.npy"))

    def test_focuses_on_zones_of_the_command_line_and_draws_how(self):
        middle = ("--lens", "dgauss-50mm", "--size", "96x72", "--json")
        focused = self.json_of("focus", "s.pbrt", *middle)["film_distance_mm"]
        for auto in (["--autofocus"], ["--focus", "auto"]):
            self.assertEqual(self.json_of("render", "s.pbrt", *middle, "--spp", "4", *auto, "-o", "x.npy")["film_distance_mm"], focused)
        said = self.assert_succeeds("render", "s.pbrt", "--lens", "dgauss-50mm", "--size", "128x96", "--spp", "4", "--zone", "0.1,0.5,0.1,0.9",
                                    "--zone", "0.6,0.9,0.1,0.9", "--focus-plot", "f.svg", "-o", "x.npy")
        self.assertIn("evaluations", said)
        self.assertIn("coarse", said)
        self.assertTrue((self.folder / "f.svg").read_text().startswith("<"))
        self.assert_refused("render", "s.pbrt", "--lens", "dgauss-50mm", "--spp", "4", "--zone", "0.5,0.1,0,1", "-o", "y.npy", words=["left < right"])

    def test_blades_and_clipping_planes(self):
        def light(*options):
            return self.json_of("render", "s.pbrt", *LENS, "--spp", "8", "-o", "x.npy", *options)["mean_irradiance"]
        # A triangle has 41 % of the stop's area; off the axis other rims cut the round pupil, too. The pupil's sines and tangents part by 2 %
        # at f/2, and 8 samples of 768 pixels leave 1 %.
        middle = ("--film-diagonal", "1")
        self.assertAlmostEqual(light(*middle, "--blades", "3") / light(*middle), 0.413, delta=0.02)
        # The wall reflects half of the sky's light and hides it.
        self.assertGreater(light("--near", "1.5"), 1.2 * light())
        for options, part in [(["--blades", "2"], "blades"), (["--near", "2", "--far", "1"], "clipping"), (["--near", "-1"], "--near")]:
            self.assert_refused("render", "s.pbrt", *LENS, *options, "-o", "y.npy", words=[part])


if __name__ == "__main__":
    unittest.main()
