# SPDX-License-Identifier: BSD-3-Clause
"""petzval image by bands: several processes form one image, whose files have the bytes of one process's."""

import unittest

from petzval_cli import ProgramTest

IMAGE = ("image", "studio", "--lens", "edmund-54852", "--wavelengths", "450:40:650", "--tolerance", "0.01", "--sensor", "example-vga",
         "--sensor-set", "columns=48", "--sensor-set", "rows=32", "--quiet")
OUTPUTS = ("light.npy", "light.exr", "shot.dng", "shot.png")


class ImageBands(ProgramTest):
    def image(self, *options, outputs=OUTPUTS, light=IMAGE):
        return self.petzval(*light, *[word for name in outputs for word in ("-o", name)], *options)

    def piece(self, name, bands, **changed):
        done = self.image("--bands", bands, "--checkpoint", f"{name}.bands", **changed)
        self.assertEqual(done.returncode, 0, done.stderr)

    def bytes_of(self, name):
        return (self.folder / name).read_bytes()

    def test_pieces_are_one_image_byte_for_byte(self):
        for name, bands in (("a", "0:1"), ("b", "1:4"), ("c", "4:6")):
            self.piece(name, bands)
        self.assertFalse((self.folder / "light.npy").exists())
        self.assertEqual(self.image().returncode, 0)
        alone = {name: self.bytes_of(name) for name in OUTPUTS}
        self.piece("whole", "0:6")
        for order in ("abc", "cab"):
            self.assertIn("petzval image with --checkpoint merged.bands",
                          self.assert_succeeds("merge", *[f"{name}.bands" for name in order], "-o", "merged.bands"))
            self.assertEqual(self.bytes_of("merged.bands"), self.bytes_of("whole.bands"))
        for name in OUTPUTS:
            (self.folder / name).unlink()
        for threads in (1, 2):
            done = self.image("--checkpoint", "merged.bands", "--threads", threads)
            self.assertEqual(done.returncode, 0, done.stderr)
            for name in OUTPUTS:
                self.assertEqual(self.bytes_of(name), alone[name], name)
        self.refuses()

    def test_pieces_of_a_scene_with_depth_are_one_image(self):
        cards = ("image", "cards", "--lens", "dgauss-50mm", "--sensor", "32x24@400", "--wavelengths", "450:100:650", "--tolerance", "0.01",
                 "--layers", "3", "--quiet")
        outputs = ("light.npy", "light.exr")
        self.assertEqual(self.image(light=cards, outputs=outputs).returncode, 0)
        alone = {name: self.bytes_of(name) for name in outputs}
        self.piece("a", "0:1", light=cards, outputs=outputs)
        self.piece("b", "1:3", light=cards, outputs=outputs)
        self.assert_succeeds("merge", "b.bands", "a.bands", "-o", "merged.bands")
        done = self.image("--checkpoint", "merged.bands", light=cards, outputs=outputs)
        self.assertEqual(done.returncode, 0, done.stderr)
        for name in outputs:
            self.assertEqual(self.bytes_of(name), alone[name], name)
        for light in ((*cards[:-3], "--layers", "4", "--quiet"), (*cards, "--focus", "3m"), (*cards, "--f-number", "8")):
            done = self.image("--checkpoint", "merged.bands", light=light, outputs=outputs)
            self.assert_error(done, 2, "is a piece of another image")

    def refuses(self):
        """What does not fit together."""
        merge = ("-o", "x.bands")
        for pieces, words in (("ab", "no piece has band 4"), ("bc", "no piece has band 0"), ("abbc", "band 1, and so has")):
            self.assert_error(self.petzval("merge", *[f"{name}.bands" for name in pieces], *merge), 2, words)
        self.piece("d", "4:6", light=(*IMAGE, "--f-number", "4"))
        self.assert_error(self.petzval("merge", "a.bands", "b.bands", "d.bands", *merge), 2, "d.bands: is a piece of another image")
        self.assert_error(self.image("--checkpoint", "a.bands"), 2, "a.bands: has bands 0 to 0 of 6")
        data = self.bytes_of("c.bands")
        (self.folder / "e.bands").write_bytes(data[:-30] + bytes([data[-30] ^ 1]) + data[-29:])
        self.assert_error(self.petzval("merge", "a.bands", "b.bands", "e.bands", *merge), 2, "e.bands: is a damaged checkpoint")
        (self.folder / "e.bands").write_bytes(data[:-9])
        self.assert_error(self.petzval("merge", "a.bands", "b.bands", "e.bands", *merge), 2, "e.bands: is a damaged checkpoint")
        (self.folder / "e.bands").write_bytes(data.replace(b"petzval 0", b"petzval 9", 1))
        self.assert_error(self.image("--checkpoint", "e.bands"), 2, "e.bands")
        self.assertFalse((self.folder / "x.bands").exists())

    def test_bad_input_is_one_line(self):
        for bands, words in (("2:2", "--bands 2:2: of 6 bands"), ("4:7", "--bands 4:7"), ("1", "--bands")):
            self.assert_error(self.image("--bands", bands, "--checkpoint", "x.bands"), 2, words)
        self.assert_error(self.image("--bands", "0:2"), 2, "--checkpoint")
        self.assert_error(self.image("--checkpoint", "none.bands"), 2, "none.bands: cannot be read")


if __name__ == "__main__":
    unittest.main()
