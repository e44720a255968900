# SPDX-License-Identifier: BSD-3-Clause
"""A scene that ISET made, with its depth map, from the file to pictures. Runs where the folder `shared` stands beside the
checkout; the same claims are proven by files of our own in test_depth.py and test_mat_hdf5.py.
"""

import os
import pathlib
import struct
import unittest
import zlib

import numpy as np

import iset_files
from mat_hdf5_files import write_mat_hdf5
from petzval_cli import ProgramTest

PIANO = pathlib.Path(os.environ["PETZVAL_DATA"]).resolve().parent.parent / "shared/data/scenes/piano3d.mat"


def read_scene():
    data = PIANO.read_bytes()
    kind, size = struct.unpack_from("<II", data, 128)
    assert kind == 15
    return iset_files._read_matrix(zlib.decompress(data[136:136 + size])[8:])[1]


@unittest.skipUnless(PIANO.exists(), f"{PIANO} is not here: ISET's file is not part of Petzval")
class Piano(ProgramTest):
    def test_the_depth_map_is_that_of_the_file(self):
        self.assert_succeeds("scene", "convert", PIANO, "--depth", "map.npy")
        depth = read_scene()["depthMap"]
        np.testing.assert_array_equal(np.load(self.folder / "map.npy").reshape(depth.shape), depth.astype("f4"))
        facts = self.json_of("scene", "info", PIANO)
        self.assertAlmostEqual(facts["depth_min_m"], depth.min(), places=6)
        self.assertAlmostEqual(facts["depth_max_m"], depth.max(), places=6)

    def test_the_same_data_in_version_7_3_are_the_same_scene(self):
        scene = read_scene()
        # The classes that the file gives them, which say how they are scaled.
        scene["data"]["photons"] = scene["data"]["photons"].astype("u2")
        scene["illuminant"]["data"]["photons"] = scene["illuminant"]["data"]["photons"].astype("u4")
        write_mat_hdf5(self.folder / "piano.mat", {"scene": scene})
        for name, source in (("old.exr", PIANO), ("new.exr", "piano.mat")):
            self.assert_succeeds("scene", "convert", source, name)
        self.assertEqual((self.folder / "new.exr").read_bytes(), (self.folder / "old.exr").read_bytes())

    def test_what_is_focused_on_is_sharp(self):
        depth = read_scene()["depthMap"]
        side, near, far = 100, np.quantile(depth, 0.02), np.quantile(depth, 0.98)
        pictures = {}
        for name, metres in (("near", near), ("far", far)):
            out = self.json_of("image", PIANO, "--lens", "dgauss-50mm", "--sensor", f"{side}x{side}@80", "--wavelengths", "550",
                               "--layers", 6, "--surround", "extend", "--focus", f"{metres}m", "-o", f"{name}.npy")
            self.assertEqual(len(out["layers"]), 6)
            pictures[name] = np.load(self.folder / f"{name}.npy")[:, :, 0].astype("f8")
        # Each pixel has the depth of the sample that it looks at: the frame and the scene are centred, 10 degrees wide.
        self.assertAlmostEqual(pictures["near"].mean() / pictures["far"].mean(), 1, delta=0.2)
        reach = np.tan(np.radians(5)) * 2 / 200
        for name, other, mask in (("near", "far", depth < np.quantile(depth, 0.2)), ("far", "near", depth > np.quantile(depth, 0.8))):
            sharp = [self.detail(pictures[which], mask, reach) for which in (name, other)]
            self.assertGreater(sharp[0], 1.3 * sharp[1], name)

    def detail(self, picture, mask, reach):
        """Squared differences of neighbours over squared values, where the mask of samples says."""
        side = picture.shape[0]
        # The picture of a 50 mm lens focused near: pixels of 80 um are about 1.55e-3 of the tangent apart.
        index = np.round((np.arange(side) + 0.5 - side / 2) * 1.5e-3 / reach + 99.5).astype(int).clip(0, 199)
        seen = mask[np.ix_(index, index)][1:, 1:]
        steps = (picture[1:, 1:] - picture[:-1, 1:]) ** 2 + (picture[1:, 1:] - picture[1:, :-1]) ** 2
        return steps[seen].sum() / (picture[1:, 1:][seen] ** 2).sum()


if __name__ == "__main__":
    unittest.main()
