# SPDX-License-Identifier: BSD-3-Clause
"""petzval handout: exercises whose pages show what their commands make."""

import base64
import html
import html.parser
import re
import shlex
import unittest

from petzval_cli import ProgramTest


class Page(html.parser.HTMLParser):
    """What a page is made of: tags that are open at its end, what it would load, its listing."""

    VOID = {"meta", "img", "br", "input", "link"}

    def __init__(self, text):
        super().__init__()
        self.open, self.loads, self.listing, self.drawings = [], [], "", 0
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        if tag not in self.VOID:
            self.open.append(tag)
        self.drawings += tag == "svg"
        self.loads += [value for name, value in attributes if name in ("src", "href")]

    def handle_startendtag(self, tag, attributes):
        self.loads += [value for name, value in attributes if name in ("src", "href")]

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag

    def handle_data(self, data):
        if self.open and self.open[-1] == "pre":
            self.listing += data


class Handout(ProgramTest):
    def exercises(self):
        return [line.split()[0] for line in self.assert_succeeds("handout").splitlines()]

    def test_every_exercise_is_one_page_that_needs_nothing_else(self):
        names = self.exercises()
        self.assertEqual(len(names), 9)
        for name in names:
            with self.subTest(exercise=name):
                self.assert_succeeds("handout", name, "--quiet")
                page = Page((self.folder / f"{name}.html").read_text())
                self.assertEqual(page.open, [])
                self.assertTrue(all(each.startswith("data:") for each in page.loads), "nothing is loaded")
                pictures = [each for each in page.loads if each.startswith("data:image/png")]
                self.assertGreaterEqual(len(pictures), 2)
                self.assertGreaterEqual(page.drawings, 2, "the layout and a plot")
                for line in page.listing.splitlines():
                    self.assertEqual(shlex.split(line)[0], "petzval")

    def test_a_page_shows_what_its_commands_make(self):
        self.assert_succeeds("handout", "distortion", "-o", "page.html", "--quiet")
        page = Page((self.folder / "page.html").read_text())
        shown = {base64.b64decode(each.split(",", 1)[1]) for each in page.loads if each.startswith("data:image/png")}
        made = 0
        for line in page.listing.splitlines():
            words = shlex.split(line)[1:]
            self.assert_succeeds(*words)
            if words[-1].endswith(".png"):
                made += 1
                self.assertIn((self.folder / words[-1]).read_bytes(), shown, line)
        self.assertEqual(made, 2)

    def test_an_exercise_that_there_is_not(self):
        self.assert_refused("handout", "astigmatism", words=("coma", "field-curvature"))
        self.assert_refused("handout", "coma", "-o", "coma.pdf", words=(".html",))


class Lights(ProgramTest):
    """--white and --display of pictures of the light."""

    def picture(self, name, *more):
        self.assert_succeeds("image", "wall", "--lens", "dgauss-50mm", "--sensor", "24x18@900", "--wavelengths", "588", "--quiet",
                             *more, "-o", name)
        done = self.json_of("compare", name, name)  # it is a picture that can be read
        self.assertEqual(done["relative_l2"], 0)
        return (self.folder / name).read_bytes()

    def test_one_white_makes_stopping_down_dark(self):
        metered = [self.picture("a.png"), self.picture("b.png", "--f-number", "8")]
        fixed = [self.picture("c.png", "--white", "30"), self.picture("d.png", "--white", "30", "--f-number", "8")]
        self.assertNotEqual(fixed[0], fixed[1])
        self.assertIn(b"white is 30 lx, as asked for", fixed[0])
        self.assertIn(b"white is 30 lx, as asked for", fixed[1])
        self.assertNotIn(b"as asked for", metered[0])

    def test_what_is_refused(self):
        for words in (("--white", "0"), ("--display", "logarithm")):
            self.assert_refused("image", "wall", "--lens", "dgauss-50mm", "--sensor", "24x18@900", *words, "-o", "a.png")
        self.assert_refused("image", "wall", "--lens", "dgauss-50mm", "--sensor", "third-inch-1280x960", "--white", "3", "-o", "a.png",
                            words=("--white", "--picture irradiance"))


if __name__ == "__main__":
    unittest.main()
