# SPDX-License-Identifier: BSD-3-Clause
"""The program as a whole: version, help, wrong usage."""

import re
import subprocess
import unittest

from petzval_cli import PROGRAM, ProgramTest, leaf_commands, main_commands


class Program(ProgramTest):
    def test_version(self):
        self.assertRegex(self.assert_succeeds("--version"), r"^petzval \d+\.\d+\.\d+\n$")

    def test_help_names_the_commands(self):
        commands = main_commands()
        self.assertIn("lens", commands)
        for command in commands:
            self.assertIn(command, self.assert_succeeds("--help"))

    def test_wrong_usage(self):
        self.assert_refused("lens", words=["subcommand"])
        self.assert_refused("lenz", words=["lenz"])
        self.assert_refused("--frobnicate")
        self.assert_refused("lens")
        self.assert_refused("lens", "info")
        self.assert_refused("lens", "info", "edmund-54852", "--frobnicate", words=["--frobnicate"])
        self.assert_refused("lens", "info", "edmund-54852", "surplus", words=["surplus"])

    def test_wrong_values_of_the_options_of_all_commands(self):
        for option, value in (("--threads", "-1"), ("--threads", "two"), ("--seed", "1.5"), ("--seed", "-1")):
            self.assert_refused("lens", "info", "edmund-54852", option, value, words=[option])

    def test_wrong_usage_points_to_the_help_of_its_command(self):
        image = ["image", "wall", "--lens", "edmund-54852", "-o", "x.npy"]
        for words, command in [([*image, "--bogus"], "image"), ([*image, "--bits", "7"], "image"), (["image"], "image"),
                               (["lens", "mtf"], "lens mtf"), (["lens", "nonsense"], "lens"), (["optics", "build", "x"], "optics build")]:
            self.assert_refused(*words, words=[f"(see petzval {command} --help)"])
        self.assert_refused("nonsense", words=["(see petzval --help)"])

    def test_words_that_are_no_numbers(self):
        image = ["image", "wall", "--lens", "edmund-54852", "-o", "x.npy"]
        self.assert_refused(*image, "--tolerance", "abc", words=["--tolerance abc: a number would be right"])
        self.assert_refused(*image, "--nodes", "1.5", words=["--nodes 1.5: a whole number would be right"])
        self.assert_refused(*image, "--tolerance", "", words=["--tolerance", "empty", "a number would be right"])
        self.assert_refused(*image, "--f-number", "", words=["--f-number", "empty", "a number above 0 would be right"])
        self.assert_refused(*image, "--nodes", "", words=["--nodes", "empty", "a whole number would be right"])
        for option in ("--tolerance", "--gain", "--exposure-compensation"):
            for word in ("nan", "inf", "-inf", "1e400"):
                self.assert_refused(*image, f"{option}={word}", words=[f"{option}: {word} is not a number"])
        self.assert_refused(*image, "--sharpen=nan", words=["--sharpen: nan is not a number"])
        for word in ("-1", "18446744073709551616"):
            self.assert_refused(*image, f"--build={word}", words=[f"--build: {word} is not a whole number from 0 on"])
        self.assert_refused(*image[:-1], "x" * 4000 + ".npy", words=["too long a name"])

    def test_lists_with_an_empty_word(self):
        lens, light = "edmund-54852", ["light.npy", "--sensor", "icx625-mono"]
        lists = [
            (["lens", "mtf", lens], ("--frequencies", "--weights", "--fields", "--wavelengths")),
            (["lens", "encircled-energy", lens], ("--radii",)),
            (["lens", "report", lens, "-o", "x.html"], ("--frequencies",)),
            (["lens", "transfer", lens], ("--bands",)),
            (["lens", "draw", lens, "-o", "x.svg"], ("--film-heights",)),
            (["lens", "steps", lens], ("--stop", "--wavelengths")),
            (["lens", "ghosts", lens, "-o", "x.svg"], ("--draw",)),
            (["image", "wall", "--lens", lens, "-o", "x.npy"], ("--bracket", "--wavelengths")),
            (["sense", *light, "-o", "x.npy"], ("--bracket", "--wavelengths")),
            (["target", "--rectangle", "9x9", "-o", "x.npy"], ("--wavelength", "--weights", "--at")),
            (["render", "spheres", "-o", "x.exr"], ("--region", "--camera-at", "--look-at")),
            (["measure", "colour", "x.png"], ("--corners",)),
        ]
        for command, options in lists:
            for option in options:
                for word in (",1", "1,,2", "1,2,"):
                    self.assert_refused(*command, f"{option}={word}", words=[option, word, "right"])
        for command, option, word, right in [
            (["lens", "mtf", lens], "--weights", "1,,2", "a number would be right"),
            (["lens", "mtf", lens], "--weights", ",", "a number would be right"),
            (["image", "wall"], "--bracket", "-2,,2", "a number would be right"),
            (["image", "wall"], "--without", "dark,,read", "a value would be right"),
            (["measure", "matrix", "full-frame-24mp"], "--lights", "D65,", "a value would be right"),
            (["sweep", "image", "wall"], "--keep", "exr,", "a value would be right"),
            (["sweep", "image", "wall", "--vary", "f-number=4,8", "-o", "x"], "--bracket", "-2,,2", "a number would be right"),
            (["sweep", "lens", "mtf", lens, "--vary", "f-number=4,8", "-o", "x"], "--weights", "1,", "a number would be right"),
        ]:
            self.assert_refused(*command, option, word, words=[f"{option} {word}: an empty word; {right}"])
        self.assert_refused("target", "--rectangle", "9x9", "--photosite", "polygon:0,0,1,0,1,1,", "-o", "x.npy",
                            words=["--photosite polygon:0,0,1,0,1,1,: polygon:x,y,... would be right"])
        # What --output holds is no list.
        self.assert_succeeds("lens", "mtf", lens, "--frequencies", "10", "--plot", "a,,b.svg")

    def test_help_is_a_command_too(self):
        for words in ([], ["image"], ["lens", "mtf"]):
            self.assertEqual(self.assert_succeeds("help", *words), self.assert_succeeds(*words, "--help"))
        self.assert_refused("help", "nonsense", words=["nonsense"])

    def test_a_full_disk_behind_stdout(self):
        with open("/dev/full", "w") as full:
            for arguments in (("lens", "info", "edmund-54852"), ("lens", "info", "edmund-54852", "--json")):
                done = self.petzval(*arguments, stdout=full)
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertRegex(done.stderr, r"^petzval: error: [^\n]*\n$")

    def test_a_reader_that_goes_away(self):
        """`petzval lens list | head -1` must not end in a backtrace or a report of an error."""
        done = subprocess.run(["bash", "-c", '"$0" lens list | true; exit ${PIPESTATUS[0]}', PROGRAM],
                              capture_output=True, text=True)
        self.assertNotIn("terminate", done.stderr)
        self.assertIn(done.returncode, (0, 1, 141), done.stderr)


class Help(ProgramTest):
    def test_every_command_explains_itself_and_shows_an_example(self):
        for command in leaf_commands():
            with self.subTest(command=" ".join(command)):
                text = self.assert_succeeds(*command, "--help")
                self.assertIn("Example:\n  petzval " + " ".join(command), text)

    def test_options_are_in_kebab_case(self):
        for command in leaf_commands():
            text = self.assert_succeeds(*command, "--help-all")
            with self.subTest(command=" ".join(command)):
                self.assertNotRegex(text, r"\s--\w*[A-Z_]\w*")

    def test_options_of_every_day_come_first(self):
        short, whole = (self.assert_succeeds("image", option) for option in ("--help", "--help-all"))
        for option in ("--lens", "--sensor", "--focus", "--f-number", "--output"):
            self.assertIn(option, short)
        for option in ("--scene-negative-zero", "--sharpen-radius"):
            self.assertNotIn(option, short)
            self.assertIn(option, whole)
        self.assertLess(len(short.splitlines()), 50)
        headings = re.findall(r"^([A-Z][a-z].*):$", whole, re.MULTILINE)
        for heading in ("Scene", "Lens", "Focus", "Sensor", "Exposure of the sensor", "Output"):
            self.assertIn(heading, headings)

    def test_a_mistyped_option_names_the_nearest(self):
        self.assert_refused("image", "studio", "--lense", "dgauss-50mm", words=["no option --lense", "--lens,"])
        self.assert_refused("lens", "mtf", "dgauss-50mm", "--frequencie=3", words=["--frequencies"])

    def test_completion_offers_commands_options_and_names(self):
        script = self.write("completion", self.assert_succeeds("completion"))

        def offered(*words):
            listing = ("source \"$0\"; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _petzval; "
                       "printf '%s\\n' \"${COMPREPLY[@]}\"")
            done = subprocess.run(["bash", "-c", listing, script, "petzval", *words], capture_output=True, text=True,
                                  check=True)
            return done.stdout.split()

        self.assertEqual(offered("ren"), ["render"])
        self.assertEqual(offered("lens", "mt"), ["mtf"])
        self.assertIn("--frequencies", offered("lens", "mtf", "--fre"))
        self.assertIn("dgauss-50mm", offered("image", "studio", "--lens", "dg"))
        self.assertEqual(offered("image", "--method", "ex"), ["exact"])
        self.assertIn("dgauss-50mm", offered("lens", "info", "dg"))

    def test_the_man_page_has_every_command_and_option(self):
        page = self.assert_succeeds("manual").replace("\\-", "-")
        for command in leaf_commands():
            self.assertIn(".SS petzval " + " ".join(command) + "\n", page)
        for option in re.findall(r"--[a-z][a-z-]+", self.assert_succeeds("image", "--help-all").split("Example")[0]):
            self.assertIn(option, page + "--help-all")


if __name__ == "__main__":
    unittest.main()
