# SPDX-License-Identifier: BSD-3-Clause
"""petzval dataset: processes that share a folder, are killed, or find the disk full; archives that others read."""

import json
import pathlib
import random
import re
import resource
import signal
import subprocess
import tarfile
import time
import unittest

from petzval_cli import PROGRAM, ProgramTest

DOCS = pathlib.Path(__file__).parents[2] / "docs"
RECIPE = {
    "format": "petzval-dataset/1", "items": 12, "items_per_part": 2, "seed": 9,
    "parameters": {"lens": {"choose": ["edmund-54852", "dgauss-50mm"]}, "stop_down_ev": {"uniform": [0, 2]},
                   "scene": "grid", "sensor": "example-vga"},
    "sensor_set": ["columns=48", "rows=32"], "wavelengths_nm": "500,600", "tolerance": 0.02, "truth": ["raw", "rays"]}


class Dataset(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "recipe.json").write_text(json.dumps(RECIPE))

    def files(self, name):
        return {path.name: path.read_bytes() for path in (self.folder / name).iterdir()}

    def test_a_worker_killed_among_others_costs_nothing(self):
        self.assert_succeeds("dataset", "make", "recipe.json", "-o", "alone")
        command = [PROGRAM, "dataset", "make", "recipe.json", "-o", "shared", "--quiet"]
        workers = [subprocess.Popen(command, cwd=self.folder) for _ in range(3)]
        time.sleep(random.uniform(0.2, 2))
        workers[1].send_signal(signal.SIGKILL)
        self.assertEqual([workers[0].wait(), workers[2].wait()], [0, 0])
        workers[1].wait()
        # What the killed one was at may be left over: the next process makes it.
        self.assert_succeeds("dataset", "make", "recipe.json", "-o", "shared", "--threads", 1)
        self.assertEqual(self.files("shared"), self.files("alone"))
        self.assertIn("6 of 6 parts are there and whole: 12 items",
                      self.assert_succeeds("dataset", "verify", "shared"))

    def test_what_a_killed_worker_was_writing_is_cleared_away(self):
        self.assert_succeeds("dataset", "make", "recipe.json", "-o", "alone")
        self.assert_succeeds("dataset", "make", "recipe.json", "-o", "shared")
        (self.folder / "shared" / "part-00001.json").rename(self.folder / "shared" / ".part-00001.19788-5.json")
        self.assert_succeeds("dataset", "make", "recipe.json", "-o", "shared")
        self.assertEqual(self.files("shared"), self.files("alone"))

    def test_an_interrupted_run_keeps_whole_parts(self):
        self.assert_succeeds("dataset", "make", "recipe.json", "-o", "alone")
        worker = subprocess.Popen([PROGRAM, "dataset", "make", "recipe.json", "-o", "set"], cwd=self.folder,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        while not (self.folder / "set" / "dataset.json").exists() and worker.poll() is None:
            time.sleep(0.01)
        time.sleep(random.uniform(0, 1))
        worker.send_signal(signal.SIGINT)
        _, told = worker.communicate()
        if worker.returncode != 0:  # it may have been done
            self.assertEqual(worker.returncode, 130, told)
            self.assertIn("goes on with the rest", told)
        self.assertFalse([name for name in self.files("set") if name.startswith(".")])
        self.assert_succeeds("dataset", "make", "recipe.json", "-o", "set")
        self.assertEqual(self.files("set"), self.files("alone"))

    def test_a_disk_of_four_megabytes_is_filled_and_made_larger(self):
        disk = self.folder / "disk"
        disk.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=4m", "tmpfs", str(disk)], capture_output=True).returncode != 0:
            self.skipTest("only root mounts a disk")
        self.addCleanup(subprocess.run, ["umount", "-l", str(disk)], check=True)
        # Each part takes 1.2 MB.
        large = {**RECIPE, "truth": ["rays"], "sensor_set": ["columns=320", "rows=240"]}
        (self.folder / "recipe.json").write_text(json.dumps({**large, "items": 8}))
        done = self.petzval("dataset", "make", "recipe.json", "-o", "disk/set", "--quiet")
        self.assert_error(done, 1, "is the disk full?")
        left = self.files("disk/set")
        self.assertIn("part-00001.json", left)
        self.assertNotIn("part-00003.json", left)
        self.assertFalse([name for name in left if name.startswith(".")])
        self.assertIn("parts are there and whole", self.assert_succeeds("dataset", "verify", "disk/set"))
        subprocess.run(["mount", "-o", "remount,size=16m", str(disk)], check=True)
        self.assert_succeeds("dataset", "make", "recipe.json", "-o", "disk/set")
        self.assert_succeeds("dataset", "make", "recipe.json", "-o", "alone")
        self.assertEqual(self.files("disk/set"), self.files("alone"))

    def test_a_full_disk_leaves_nothing_half_written(self):
        # Where nobody may mount one: files that may not grow, here the archive, larger than any file in it.
        def narrow():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))

        done = self.petzval("dataset", "make", "recipe.json", "-o", "set", preexec_fn=narrow)
        self.assert_error(done, 1, "is the disk full?")
        self.assertEqual(list(self.files("set")), ["dataset.json"])
        self.assert_succeeds("dataset", "make", "recipe.json", "-o", "set")

    def test_others_read_the_archives(self):
        self.assert_succeeds("dataset", "make", "recipe.json", "-o", "set")
        lines = [json.loads(line) for line in (self.folder / "set" / "part-00003.jsonl").read_text().splitlines()]
        with tarfile.open(self.folder / "set" / "part-00003.tar") as archive:
            names = archive.getnames()
            for line in lines:
                for extension, file in line["files"].items():
                    self.assertEqual(archive.getmember(f"{line['key']}.{extension}").size, file["bytes"])
            facts = json.load(archive.extractfile(f"{lines[0]['key']}.json"))
        # WebDataset takes neighbours with one key for one sample.
        keys = [name.partition(".")[0] for name in names]
        self.assertEqual(keys, sorted(keys))
        self.assertEqual(facts["parameters"], lines[0]["parameters"])

    def test_the_published_schema_has_every_parameter_and_truth(self):
        schema = json.loads((DOCS / "dataset-recipe.schema.json").read_text())
        parameters = schema["properties"]["parameters"]
        of_lights = re.compile(next(iter(parameters["patternProperties"])))
        rows = self.json_of("dataset", "parameters")["rows"]
        for row in rows:
            if not of_lights.match(row["parameter"]):
                self.assertEqual(parameters["properties"][row["parameter"]], {"$ref": f"#/$defs/{row['is']}"})
        self.assertEqual(len(rows), len(parameters["properties"]) + 3)
        # What the program says that it would take is what the schema has.
        for key, entry in (("truth", "truth"), ("nonsense", None)):
            (self.folder / "bad.json").write_text(json.dumps({**RECIPE, key: ["x"]}))
            told = self.petzval("dataset", "make", "bad.json", "-o", "set").stderr
            for name in schema["properties"][entry]["items"]["enum"] if entry else schema["properties"]:
                self.assertIn(name, told)

    def test_bad_input_is_one_line(self):
        for words, message in ((["make", "recipe.json", "-o", "set", "--shard", "5/4"], "1/16 to 16/16"),
                               (["make", "recipe.json", "-o", "set", "--shard", "x"], "1/16 to 16/16"),
                               (["make", "none.json", "-o", "set"], "none.json"),
                               (["info", "."], "dataset.json"), (["verify", "none"], "dataset.json")):
            self.assert_error(self.petzval("dataset", *words), 2, message)


if __name__ == "__main__":
    unittest.main()
