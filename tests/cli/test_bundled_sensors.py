# SPDX-License-Identifier: BSD-3-Clause
"""Sensors with colours of cameras: the importer of spectral sensitivities, and raw files of all bundled ones."""

import csv
import json
import pathlib
import subprocess
import sys
import unittest

import numpy as np

from petzval_cli import ProgramTest

TOP = pathlib.Path(__file__).parents[2]
IMPORTER = TOP / "tools" / "import_sensitivities.py"


class BundledSensors(ProgramTest):
    def test_all_make_a_raw_file(self):
        sensors = {path.stem for path in (TOP / "data" / "sensors").glob("*.json")}
        self.assertGreaterEqual(len(sensors), 14)
        np.save(self.folder / "light.npy", np.full((16, 16, 3), 1e-3, np.float32))
        for sensor in sorted(sensors):
            with self.subTest(sensor=sensor):
                self.assert_succeeds("sense", "light.npy", "--wavelengths", "450,550,650", "--sensor", sensor,
                                     "--exit-pupil", "50", "--quiet", "-o", f"{sensor}.dng")
                self.assertGreater((self.folder / f"{sensor}.dng").stat().st_size, 512)

    def import_of(self, main, index=("R", "G", "B")):
        document = {"header": {"manufacturer": "Some", "model": "Camera", "license": "CC0-1.0", "laboratory": None,
                               "document_creator": "somebody"},
                    "spectral_data": {"units": "relative", "index": {"main": list(index)}, "data": {"main": main}}}
        (self.folder / "camera.json").write_text(json.dumps(document), encoding="utf-8")
        return subprocess.run([sys.executable, IMPORTER, "camera.json", "camera.csv"], cwd=self.folder,
                              capture_output=True, text=True)

    def test_quanta_are_counted(self):
        # A green that goes as the wavelength frees as many electrons of each photon; a flat blue fewer of each at
        # longer ones, for there are more of them to a watt.
        said = self.import_of({"600": [0.3, 0.6, 0.2], "400": [-0.01, 0.4, 0.2], "500": [0.0, 0.5, 0.2]})
        self.assertEqual(said.returncode, 0, said.stderr)
        lines = (self.folder / "camera.csv").read_text(encoding="utf-8").splitlines()
        self.assertEqual(lines[0], "# name: Some Camera, red, green and blue response")
        rows = [[float(cell) for cell in row] for row in csv.reader(lines[4:])]
        self.assertEqual([row[0] for row in rows], [400, 500, 600])
        self.assertEqual([row[2] for row in rows], [1, 1, 1])
        self.assertEqual([row[1] for row in rows], [0, 0, 0.5])
        for row in rows:
            self.assertAlmostEqual(row[3], 200 / row[0], delta=1e-5)
        channels = [{"name": name, "quantum_efficiency": [{"set": "camera.csv", "spectrum": name, "scale": 0.5}]}
                    for name in ("red", "green", "blue")]
        sensor = json.loads((TOP / "data" / "sensors" / "aps-c-24mp.json").read_text(encoding="utf-8"))
        sensor["channels"] = channels
        (self.folder / "sensor.json").write_text(json.dumps(sensor), encoding="utf-8")
        self.assert_succeeds("sensor", "info", "sensor.json")

    def test_other_channels_are_refused(self):
        said = self.import_of({"400": [1, 2], "500": [1, 2]}, ("X", "Y"))
        self.assertNotEqual(said.returncode, 0)
        self.assertIn("R, G and B would be right", said.stderr)


if __name__ == "__main__":
    unittest.main()
