# SPDX-License-Identifier: BSD-3-Clause
"""The packer: what it takes, what it refuses, and that the committed catalogue is what it makes.

    pack_glass_test.py ROOT        ROOT is the checkout
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv[1]).resolve()
SHARED = pathlib.Path(os.environ.get("PETZVAL_SHARED", ROOT.parent / "shared")) / "data" / "glass"

GLASS = """# a comment
REFERENCES: |
    Somebody: "A paper"
DATA:
  - type: formula 2
    wavelength_range: 0.4 0.7
    coefficients: 0 1.25 0.01
  - type: tabulated k
    data: |
        0.400 3E-8
        0.500 1.0e-8
CONDITIONS:
    temperature: 293
PROPERTIES:
    nd: 1.5
    Vd: 64
    glass_status: preferred
"""
# The same glass by hand after data/glass/README.md. Signed v is 2v, or -2v - 1 below zero; exponent -1 is byte 255.
RECORD = bytes([
    0, 2, 1,               # name 0, formula 2, status preferred
    30, 255, 128, 1, 0,    # nd 15e-1, Vd 64e0
    8, 2, 14, 2,           # 4e2 to 7e2 nm
    3, 0, 0, 250, 1, 254, 2, 254,  # three coefficients: 0, 125e-2, 1e-2
    0,                     # no table of n
    2, 2, 8, 2,            # two rows of k: wavelengths 4e2 and one more
    248, 6, 3,             # 3e-8 and two less
])


class Packer(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.tree = pathlib.Path(self.folder.name) / "tree"
        (self.tree / "maker").mkdir(parents=True)
        self.output = pathlib.Path(self.folder.name) / "out.pgc"

    def tearDown(self):
        self.folder.cleanup()

    def pack(self, *trees):
        return subprocess.run([sys.executable, ROOT / "tools" / "pack_glass.py", *(trees or [self.tree]), "-o", self.output],
                              capture_output=True, text=True)

    def write(self, name, text):
        (self.tree / "maker" / name).write_text(text, encoding="utf-8")

    def test_packs_a_glass_as_described(self):
        self.write("Crown.yml", GLASS)
        result = self.pack()
        self.assertEqual(result.returncode, 0, result.stderr)
        data = self.output.read_bytes()
        self.assertEqual(data[:8], b"PZGLASS1")
        self.assertEqual(data[12:20], bytes([1, 0, 0, 0, 1, 0, 0, 0]))
        self.assertEqual(data[20:], bytes([11]) + b"MAKER:Crown" + bytes([0, len(RECORD)]) + RECORD)

    def refuses(self, text, why):
        self.write("Bad.yml", text)
        result = self.pack()
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("Bad", result.stderr)
        self.assertNotIn("Traceback", result.stderr)
        self.assertIn(why, result.stderr)
        self.assertFalse(self.output.exists())

    def test_refuses_an_unknown_formula(self):
        self.refuses(GLASS.replace("formula 2", "formula 10"), "formula 10")

    def test_refuses_a_file_without_an_index(self):
        self.refuses(GLASS.replace("DATA:", "OTHER:"), "no index")

    def test_refuses_a_table_out_of_order(self):
        self.refuses(GLASS.replace("0.500 1.0e-8", "0.300 1.0e-8"), "do not increase")

    def test_refuses_numbers_that_would_be_rounded(self):
        self.refuses(GLASS.replace("1.25", "1.2500000000000000001"), "does not fit")

    def test_refuses_two_glasses_of_one_name(self):
        self.write("Crown.yml", GLASS)
        self.write("CROWN.yml", GLASS)
        self.assertIn("two glasses are called", self.pack().stderr)
        self.assertFalse(self.output.exists())

    def test_leaves_out_negative_extinction_and_says_so(self):
        self.write("Crown.yml", GLASS.replace("1.0e-8", "-1.0e-8"))
        result = self.pack()
        self.assertEqual(result.returncode, 0)
        self.assertIn("MAKER:Crown: extinction below zero", result.stderr)

    @unittest.skipUnless(SHARED.is_dir(), "the refractiveindex.info files are not beside the checkout")
    def test_committed_catalogue_is_what_it_makes(self):
        result = self.pack(SHARED, ROOT / "data" / "glass" / "own")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.output.read_bytes(), (ROOT / "data" / "glass" / "catalogue.pgc").read_bytes())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
