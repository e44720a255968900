# SPDX-License-Identifier: BSD-3-Clause
"""The text checker itself, on texts with one fault each."""

import pathlib
import tempfile
import unittest

import source_rules

LICENCE = f"// {source_rules.SPDX}\n"


class SourceRules(unittest.TestCase):
    def faults(self, name, text):
        return source_rules.text_faults(pathlib.Path(name), text)

    def test_licence_line(self):
        self.assertEqual(self.faults("lens.h", LICENCE + "int a;\n"), [])
        self.assertEqual(len(self.faults("lens.h", "int a;\n")), 1)
        self.assertEqual(len(self.faults("lens.h", "")), 1)
        self.assertEqual(self.faults("README.md", "# Petzval\n"), [])

    def test_scripts_without_suffix_are_source(self):
        self.assertEqual(len(self.faults("tool", "#!/bin/sh\ntrue\n")), 1)
        self.assertEqual(self.faults("tool", f"#!/bin/sh\n# {source_rules.SPDX}\n"), [])

    def test_folders_of_one_machine(self):
        for folder in ("/home/" + "joseph/lens", "/ro" + "ot/petzval", "/wo" + "rk/main", "/Users/" + "j"):
            self.assertEqual(self.faults("a.md", f"see {folder}\n"), [(1, "names a folder of one machine")], folder)
        self.assertEqual(self.faults("a.md", "homework/1 and root/2; net" + "work/3\n"), [])

    def test_temporary_files_of_two_tests(self):
        for folder in ("std::filesystem::temp_directory" + "_path()", "testing::Temp" + "Dir()"):
            self.assertEqual(self.faults("a.cpp", LICENCE + folder + ' / "a.png"\n'),
                             [(2, "names a temporary file that others may name too")], folder)
            self.assertEqual(self.faults("a.h", LICENCE + folder + ' / "petzval-XXXXXX"\n'), [], folder)

    def test_unfinished_work(self):
        for mark in ("TO" + "DO", "FIX" + "ME", "#if " + "0"):
            self.assertEqual(len(self.faults("a.cpp", LICENCE + mark + "\n")), 1, mark)
        self.assertEqual(self.faults("a.cpp", LICENCE + "#if 1\n"), [])

    def test_types_of_one_name(self):
        here, there = ("namespace petzval {\nstruct Outline {\n  int a;\n};\n}\n", "namespace petzval {\nclass Outline final : public Line {\n};\n}\n")
        self.assertEqual(len(source_rules.repeated_types({"a.h": here, "b.h": there})), 1)
        inner = "namespace petzval::render {\nclass Outline {\n};\n}\n"
        uses = "namespace petzval {\nclass Outline;\nstruct Line {\n  struct Outline {};\n};\nclass Outline::Part {\n};\n}\n"
        self.assertEqual(source_rules.repeated_types({"a.h": here, "b.h": inner, "c.h": uses}), [])

    def test_a_tree_without_git(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "src").mkdir()
            (root / "build").mkdir()
            (root / "src" / "a.cpp").write_text("int a;\n")
            (root / "build" / "b.cpp").write_text("int b;\n")
            (root / "picture.png").write_bytes(b"\x89PNG\xff\xfe")
            faults = source_rules.find_faults(root)
        self.assertEqual(len(faults), 1, faults)
        self.assertTrue(faults[0].startswith("src/a.cpp:1:"), faults)


if __name__ == "__main__":
    unittest.main()
