# SPDX-License-Identifier: BSD-3-Clause
"""petzval sfr on photographs that are hard in one way each, and in all of them (bench/hard_photographs.py)."""

import os
import pathlib
import sys
import unittest

try:
    import numpy  # noqa: F401
except ImportError:
    numpy = None
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bench"))


@unittest.skipUnless(numpy, "numpy is not there")
class HardPhotographs(unittest.TestCase):
    # [% of the true MTF50], written before anything was measured. `worst` where each edge must be right; where light is lost or
    # noise added, means and medians. Noise at SNR 50 scatters by 1.6 %, docs/ACCURACY.md, over 196 edges of 60 pixels.
    BOUNDS = {
        "nothing, 16 bits": {"worst": 0.1},
        "8 bits": {"mean": 0.5, "rms": 2},
        "perspective": {"worst": 0.5},
        "vignetting": {"worst": 1},
        "uneven light": {"worst": 1.5},
        "sharpening": {"worst": 0.5},
        "moire": {"mean": 1, "rms": 3},
        "dust": {"median_size": 0.5, "beyond_5_percent": 10},
        "noise, SNR 50": {"mean": 0.5, "rms": 2.5},
        "JPEG, quality 85": {"mean": 2, "rms": 4},
        "all of them": {"mean": 3, "median_size": 4},
    }

    def test_errors_by_cause(self):
        import hard_photographs
        found = hard_photographs.run(os.environ["PETZVAL_PROGRAM"])
        self.assertEqual(set(found), set(self.BOUNDS))
        for cause, bounds in self.BOUNDS.items():
            with self.subTest(cause):
                self.assertGreaterEqual(found[cause]["edges"], 80 if cause == "all of them" else 95)
                for name, bound in bounds.items():
                    self.assertLess(abs(found[cause][name]), bound, (name, found[cause]))


if __name__ == "__main__":
    unittest.main()
