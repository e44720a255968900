# SPDX-License-Identifier: BSD-3-Clause
"""MATLAB files of version 7.3: what they hold is to the last bit what the same data in version 5 are."""

import unittest

import h5py
import numpy as np

import iset_files
from mat_hdf5_files import Cell, StructArray, write_mat_hdf5
from petzval_cli import ProgramTest

ROWS, COLUMNS = 9, 14
WAVES = np.arange(450.0, 651, 50)


def photons():
    """Different at every place, so that no axes can be exchanged unseen."""
    row, column, band = np.meshgrid(np.arange(ROWS), np.arange(COLUMNS), np.arange(len(WAVES)), indexing="ij")
    return 1e15 * (1 + band + 0.1 * column + 0.003 * row ** 2)


def depth():
    return 1.5 + 0.1 * np.arange(ROWS)[:, None] + 0.01 * np.arange(COLUMNS)[None, :]


def scene(cube):
    return {"type": "scene", "name": "many axes", "wAngular": 11.0, "distance": 2.5, "data": {"photons": cube},
            "spectrum": {"wave": WAVES[:, None]}, "depthMap": depth(),
            "illuminant": {"data": {"photons": np.linspace(3e15, 4e15, len(WAVES))[:, None]},
                           "spectrum": {"wave": WAVES[:, None]}}}


def write_mat5(path, variables):
    """Several variables in one file of version 5."""
    body = b"".join(iset_files.matlab(value, name) for name, value in variables.items())
    path.write_bytes(b"MATLAB 5.0 MAT-file".ljust(124) + b"\0\1IM" + body)


class Scenes(ProgramTest):
    def converted(self, name):
        """The scene as spectral OpenEXR: bytes that hold all of it."""
        self.assert_succeeds("scene", "convert", name, "out.exr")
        return (self.folder / "out.exr").read_bytes()

    def test_a_scene_is_that_of_version_5(self):
        write_mat5(self.folder / "old.mat", {"scene": scene(photons())})
        write_mat_hdf5(self.folder / "new.mat", {"scene": scene(photons())})
        self.assertEqual(self.converted("new.mat"), self.converted("old.mat"))

    def test_single_precision_and_whole_numbers(self):
        write_mat_hdf5(self.folder / "single.mat", {"scene": scene(photons().astype("f4"))})
        write_mat5(self.folder / "old.mat", {"scene": scene(photons().astype("f4").astype("f8"))})
        self.assertEqual(self.converted("single.mat"), self.converted("old.mat"))

        stored = np.round(photons() / photons().max() * 65535)
        whole = scene(stored.astype("u2"))
        whole["data"].update(dmin=2e14, dmax=7e15, bitDepth=16.0)
        write_mat_hdf5(self.folder / "whole.mat", {"scene": whole})
        write_mat5(self.folder / "old.mat", {"scene": scene(2e14 + (7e15 - 2e14) / 65535 * stored)})
        self.assertEqual(self.converted("whole.mat"), self.converted("old.mat"))

    def test_the_compressed_form(self):
        functions = np.stack([np.ones(len(WAVES)), np.linspace(-1, 1, len(WAVES))], axis=1)
        coefficients = photons()[:, :, :2]
        variables = {"mcCOEF": coefficients, "basis": {"basis": functions, "wave": WAVES[:, None]},
                     "imgMean": np.linspace(1e14, 2e14, len(WAVES))[:, None], "fov": 9.0, "dist": 1.2,
                     "name": "coefficients", "comment": "not read",
                     "illuminant": {"wavelength": WAVES[:, None], "data": np.linspace(0.2, 0.3, len(WAVES))[:, None]}}
        write_mat5(self.folder / "old.mat", variables)
        write_mat_hdf5(self.folder / "new.mat", variables)
        self.assertEqual(self.converted("new.mat"), self.converted("old.mat"))

    def test_what_lies_beside_the_scene_is_no_matter(self):
        full = scene(photons())
        full.update(history=Cell(["made", np.eye(2)]), chart=StructArray([{"x": 1.0}, {"x": 2.0}]), mask=np.zeros((0, 0)),
                    metadata={}, name=full["name"])
        write_mat_hdf5(self.folder / "full.mat", {"other": np.eye(3), "scene": full})
        with h5py.File(self.folder / "full.mat", "r+") as file:
            group = file["scene"].create_group("function")
            group.attrs["MATLAB_class"] = np.bytes_("function_handle")
        write_mat5(self.folder / "old.mat", {"scene": scene(photons())})
        self.assertEqual(self.converted("full.mat"), self.converted("old.mat"))

    def test_a_struct_array_of_one_is_a_struct(self):
        one = scene(photons())
        one["spectrum"] = StructArray([one["spectrum"]])
        write_mat_hdf5(self.folder / "one.mat", {"scene": one})
        write_mat5(self.folder / "old.mat", {"scene": scene(photons())})
        self.assertEqual(self.converted("one.mat"), self.converted("old.mat"))


class Tables(ProgramTest):
    def test_a_ray_trace_structure_is_that_of_version_5(self):
        optics = {"name": "lens", "model": "raytrace", "rayTrace": iset_files.ray_trace()}
        iset_files.write_mat(self.folder / "old.mat", "optics", optics)
        write_mat_hdf5(self.folder / "new.mat", {"optics": optics})
        write_mat_hdf5(self.folder / "oi.mat", {"oi": {"type": "opticalimage", "data": {"photons": photons()},
                                                       "optics": optics}})
        for name in ("old", "new", "oi"):
            self.assert_succeeds("optics", "import", f"{name}.mat", "-o", f"{name}.h5")
        expected = self.datasets("old.h5")
        for name in ("new.h5", "oi.h5"):
            found = self.datasets(name)
            self.assertEqual(found.keys(), expected.keys())
            for key, values in expected.items():
                np.testing.assert_array_equal(found[key], values)

    def datasets(self, name):
        with h5py.File(self.folder / name) as file:
            return {key: file[key][...] for key in file if key != "first_order"}


class Bad(ProgramTest):
    def refuse(self, *words, options=()):
        self.assert_refused("scene", "info", "bad.mat", *options, words=("bad.mat", *words))

    def altered(self, alter):
        write_mat_hdf5(self.folder / "bad.mat", {"scene": scene(photons())})
        with h5py.File(self.folder / "bad.mat", "r+") as file:
            alter(file["scene"])

    def replaced(self, field, value, matlab_class):
        def alter(group):
            del group[field]
            group[field] = value
            group[field].attrs["MATLAB_class"] = np.bytes_(matlab_class)
        self.altered(alter)

    def test_fields_that_are_missing_or_of_another_kind(self):
        self.altered(lambda group: group.__delitem__("spectrum"))
        self.refuse("scene.spectrum")
        self.replaced("distance", np.array([[1.0 + 2.0j]]), "double")
        self.refuse("scene.distance", "real numbers")
        self.replaced("wAngular", np.array([[65], [66]], "u2"), "char")
        self.refuse("scene.wAngular", "real numbers")
        self.replaced("data", np.ones((3, 3)), "double")
        self.refuse("scene.data", "struct")

    def test_numbers_that_are_none(self):
        for bad in (np.nan, np.inf, -1e15):
            cube = photons()
            cube[4, 5, 2] = bad
            write_mat_hdf5(self.folder / "bad.mat", {"scene": scene(cube)})
            self.refuse("550 nm", "row 4", "column 5")

    def test_claims_beyond_reason(self):
        def alter(group):
            del group["data/photons"]
            cube = group.create_dataset("data/photons", (5, 200000, 200000), "f8", chunks=(1, 100, 100), compression="gzip")
            cube.attrs["MATLAB_class"] = np.bytes_("double")
        self.altered(alter)
        self.refuse("scene.data.photons", "1490.1 GiB")

    def test_cut_off_anywhere(self):
        write_mat_hdf5(self.folder / "whole.mat", {"scene": scene(photons())})
        whole = (self.folder / "whole.mat").read_bytes()
        for length in (*range(0, 600, 37), *range(600, len(whole), len(whole) // 50), len(whole) - 1):
            (self.folder / "bad.mat").write_bytes(whole[:length])
            self.refuse()


if __name__ == "__main__":
    unittest.main()
