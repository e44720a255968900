# SPDX-License-Identifier: BSD-3-Clause
"""Zoom and focus positions through the program."""

import json
import unittest

from petzval_cli import ProgramTest

ZOOM = "zoom-14-24mm"


class States(ProgramTest):
    def info(self, *arguments):
        return json.loads(self.assert_succeeds("lens", "info", *arguments, "--json", "--quiet"))

    def test_chosen_by_name_by_number_and_between(self):
        by_name = self.info(ZOOM, "--state", "tele")
        self.assertEqual(by_name["efl_mm"], self.info(ZOOM, "--state", "3")["efl_mm"])
        self.assertEqual(by_name["efl_mm"], by_name["states"][3]["efl_mm"])
        self.assertLess(abs(by_name["efl_mm"] / 23.29 - 1), 1e-3)  # the patent's
        between = self.info(ZOOM, "--state", "2.5")["efl_mm"]
        self.assertTrue(20 < between < by_name["efl_mm"])
        # What is set comes after the state.
        self.assertEqual(self.info(ZOOM, "--state", "tele", "--set", "object_distance_mm=500")["object_distance_mm"], 500)

    def test_breathing(self):
        """Focused near, the group that moves makes the focal length shorter: 21.65 mm, by a trace of y and u."""
        self.assert_succeeds("sweep", "lens", "info", ZOOM, "--vary", "state=3:0.5:4", "--quiet", "-o", "breathing")
        points = [json.loads((self.folder / "breathing" / name).read_text())
                  for name in sorted(p.name for p in (self.folder / "breathing").glob("*.json"))
                  if name[:1].isdigit() or name.startswith("point")]
        lengths = [self.info(ZOOM, "--state", state)["efl_mm"] for state in ("3", "3.5", "4")]
        self.assertTrue(lengths[0] > lengths[1] > lengths[2])
        self.assertAlmostEqual(lengths[2], 21.653, places=3)
        self.assertTrue(points)

    def test_files_of_other_programs(self):
        self.assert_succeeds("lens", "convert", ZOOM, "zoom.zmx", "--quiet")
        there = self.info("zoom.zmx")["states"]
        here = self.info(ZOOM)["states"]
        self.assertEqual(len(there), 8)
        for a, b in zip(there, here):
            self.assertAlmostEqual(a["efl_mm"], b["efl_mm"], places=9)
        self.assertAlmostEqual(self.info("zoom.zmx", "--state", "config-4")["efl_mm"], here[3]["efl_mm"], places=9)

    def test_drawing(self):
        self.assert_succeeds("lens", "draw", ZOOM, "--states", "--fields", "0,14", "-o", "zoom.svg")
        text = (self.folder / "zoom.svg").read_text()
        for state in self.info(ZOOM)["states"]:
            self.assertIn(state["name"] + " — ", text)
        self.assert_refused("lens", "draw", "tessar", "--states", words=["--states", "no states"])
        self.assert_refused("lens", "draw", ZOOM, "--states", "--state", "tele", words=["--state"])

    def test_refusals_in_one_line(self):
        self.assert_refused("lens", "info", ZOOM, "--state", "middle", words=["middle", "wide", "0 to 7"])
        self.assert_refused("lens", "info", "tessar", "--state", "1", words=["no states"])
        self.assert_refused("lens", "info", ZOOM, "--state", "", words=["--state"])
        lens = json.loads(self.assert_succeeds("lens", "convert", ZOOM, "zoom.json", "--quiet") or "{}")
        del lens
        data = json.loads((self.folder / "zoom.json").read_text())
        data["states"]["values"]["surfaces[7].thickness_mm"].pop()
        (self.folder / "short.json").write_text(json.dumps(data))
        self.assert_refused("lens", "info", "short.json", words=["surfaces[7].thickness_mm", "wide-near", "misses"])


if __name__ == "__main__":
    unittest.main()
