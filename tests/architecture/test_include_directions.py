# SPDX-License-Identifier: BSD-3-Clause
"""The include checker itself: a small tree of modules in which one thing at a time is wrong."""

import pathlib
import tempfile
import unittest

import include_directions

FLOORS = "base 1\nlens 4  # a comment\nimage 4\ntrace 5\n"
CMAKE = """petzval_module(base LIBRARIES fmt::fmt)
petzval_module(lens USES base LIBRARIES json::json)
petzval_module(trace USES base
  lens)
"""


class IncludeDirections(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name)
        self.write("floors.txt", FLOORS)
        self.write("CMakeLists.txt", CMAKE)
        self.write("base/error.h", "#include <string>\n")
        self.write("lens/lens.h", "#include <petzval/base/error.h>\n")
        self.write("lens/formats/json.cpp", '#include <petzval/lens/lens.h>\n#include "json.h"\n')
        self.write("trace/tracer.h", "#include <petzval/base/error.h>\n#include <petzval/lens/lens.h>\n")

    def write(self, name, text, folder="modules"):
        path = self.root / folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def faults(self):
        return include_directions.find_faults(self.root / "modules", self.root / "tests")

    def assert_only_fault(self, *words):
        faults = self.faults()
        self.assertEqual(len(faults), 1, faults)
        for word in words:
            self.assertIn(word, faults[0])

    def test_a_tree_without_fault(self):
        self.assertEqual(self.faults(), [])

    def test_upward_include(self):
        self.write("lens/lens.cpp", "#include <petzval/trace/tracer.h>\n")
        self.write("CMakeLists.txt", CMAKE.replace("lens USES base", "lens USES base trace"))
        faults = self.faults()
        self.assertEqual(len(faults), 2, faults)
        self.assertIn("lens (floor 4) may not use trace (floor 5)", faults[0])
        self.assertIn("lens/lens.cpp:1", faults[1])

    def test_include_on_the_same_floor(self):
        self.write("image/image.h", "\n#include <petzval/lens/lens.h>\n")
        self.write("CMakeLists.txt", CMAKE + "petzval_module(image USES lens)\n")
        faults = self.faults()
        self.assertEqual(len(faults), 2, faults)
        self.assertIn("image/image.h:2", faults[1])

    def test_odd_spacing_hides_nothing(self):
        self.write("base/error.h", '  #  include "petzval/lens/lens.h"\n')
        faults = self.faults()
        self.assertIn("base/error.h:1: base (floor 1) may not use lens (floor 4)", faults)

    def test_include_by_relative_path(self):
        self.write("base/error.h", '#include "../lens/lens.h"\n')
        self.assert_only_fault("base/error.h:1", "<petzval/module/header.h>")

    def test_used_but_not_named(self):
        self.write("CMakeLists.txt", CMAKE.replace("lens USES base", "lens"))
        self.assert_only_fault("lens includes headers of base")

    def test_named_but_not_used(self):
        self.write("lens/lens.h", "")
        self.assert_only_fault("lens USES base")

    def test_named_for_the_tests_alone(self):
        self.write("lens/lens.h", "")
        self.write("lens/lens_test.cpp", "#include <petzval/base/error.h>\n", folder="tests")
        self.assertEqual(self.faults(), [])

    def test_a_test_that_reaches_upwards(self):
        self.write("base/error_test.cpp", "#include <petzval/lens/lens.h>\n", folder="tests")
        faults = self.faults()
        self.assertIn("base/error_test.cpp:1: base (floor 1) may not use lens (floor 4)", faults)

    def test_module_without_floor(self):
        self.write("render/scene.h", "")
        self.assert_only_fault("render")

    def test_floor_given_twice(self):
        self.write("floors.txt", FLOORS + "base 2\n")
        with self.assertRaisesRegex(ValueError, "floors.txt:5"):
            self.faults()


if __name__ == "__main__":
    unittest.main()
