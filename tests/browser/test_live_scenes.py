# SPDX-License-Identifier: BSD-3-Clause
"""What lies before the lens in petzval live: scenes, dropped files, suns and their ghosts, in Chromium.

    test_live_scenes.py PROGRAM CHROMIUM CHROMEDRIVER [TEST ...]
"""

import base64
import json
import pathlib
import tempfile

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from live_browser import SLIDE
from live_page import CHOOSE, LENS, LivePage, run_tests


class Scenes(LivePage):
    def test_suns_can_be_dragged_and_their_ghosts_followed(self):
        browser = self.browser
        marks = lambda: browser.driver.find_elements(By.CSS_SELECTOR, ".sun-mark")
        suns = lambda: browser.session()["stray"]["suns"]
        add = "document.getElementById('add-sun').click()"
        self.assertEqual(marks(), [])
        self.change_shows(add)
        self.assertTrue(marks()[0].is_displayed())
        first = suns()[0]["deg"]
        self.assertIn(f"--sun {first[0]:g},{first[1]:g} --ghosts", browser.text(".command"))
        ActionChains(browser.driver).click_and_hold(marks()[0]).move_by_offset(-30, 10).move_by_offset(-30, 10).release().perform()
        browser.settle()
        dragged = suns()[0]["deg"]
        self.assertLess(dragged[0], first[0])
        self.assertLess(dragged[1], first[1])
        # A second one, which is a lamp.
        self.change_shows(add)
        self.change_shows(SLIDE, "sun_lx", 500)
        self.change_shows(SLIDE, "sun_deg[0]", 0)
        self.change_shows(SLIDE, "sun_deg[1]", 400)
        lamp = suns()[1]
        self.assertEqual(lamp["deg"], [-60, -12])
        self.assertIn(f"--sun {dragged[0]:g},{dragged[1]:g} --sun -60,-12:{lamp['lx']:g} --ghosts", browser.text(".command"))
        self.assertEqual([mark.is_displayed() for mark in marks()], [True, True], "at the edge, though one is far outside")
        before = marks()[0].location
        marks()[0].send_keys(Keys.ARROW_LEFT)
        browser.settle()
        self.assertEqual(browser.session()["stray"]["sun"], 0, "the one that is moved is chosen")
        self.assertLess(suns()[0]["deg"][0], dragged[0])
        self.assertLess(marks()[0].location["x"], before["x"], "the sun stands where it was put")
        self.change_shows("document.querySelector('[data-sun-row=\"1\"]').click()")
        self.assertEqual(browser.session()["stray"]["sun"], 1)
        self.change_shows("document.querySelector('[data-sun-less=\"0\"]').click()")
        self.assertEqual(suns(), [lamp])
        self.change_shows("document.querySelector('[data-check=starburst]').click()")
        self.assertIn("--starburst", browser.text(".command"))
        self.change_shows("document.querySelector('[data-check=ghosts]').click()")
        self.assertNotIn("--ghosts", browser.text(".command"))
        self.change_shows(SLIDE, "roughness_nm", 300)
        self.assertIn("--scatter roughness=3 ", browser.text(".command"))
        self.change_shows("document.querySelector('[data-sun-less=\"0\"]').click()")
        self.assertEqual(marks(), [])
        self.assertNotIn("--sun ", browser.text(".command"))
        self.change_shows("document.getElementById('tab-ghosts').click()")
        pairs = browser.run("return [...document.querySelectorAll('tr[data-ghost]')].map(row => row.dataset.ghost)")
        self.assertEqual(sorted(pairs), ["1,0", "2,0", "2,1"], "pairs of three surfaces")
        self.change_shows("document.querySelector('tr[data-ghost] button').click()")
        self.assertEqual(browser.session()["stray"]["ghost"], [int(n) for n in pairs[0].split(",")])
        self.assertEqual(len(browser.driver.find_elements(By.CSS_SELECTOR, "tr.selected[data-ghost]")), 1)
        self.assertGreater(len(browser.driver.find_elements(By.CSS_SELECTOR, ".ghost-way .ray")), 0)
        browser.run("document.querySelector('tr[data-ghost] button').click()")
        browser.settle()
        self.assertEqual(len(browser.driver.find_elements(By.CSS_SELECTOR, ".ghost-way .ray")), 0)

    def test_a_scene_of_three_dimensions_is_refined_and_focused_by_a_click(self):
        browser = self.browser
        browser.run("""const page = window.petzvalPage, take = page.take.bind(page);
            window.seen = [];
            page.take = (message, bytes) => { if (message.kind === "picture") window.seen.push([message.quality, message.samples]); take(message, bytes); };""")
        browser.run(CHOOSE, "scene", "spheres")
        browser.until("it is focused on what is below its middle", lambda: browser.session()["focus"] == "distance")
        browser.settle()
        ball = browser.session()["focus_m"]
        self.assertLess(abs(ball - 0.87), 0.07, "a ball of 9 cm radius whose middle is 0.93 m from the camera")
        self.assertIn("petzval render spheres", browser.text(".command"))
        self.assertIn("--spp 128", browser.text(".command"))
        seen = browser.run("return window.seen")
        self.assertIn(["preview", 4], seen)
        self.assertIn(["full", 128], seen)
        self.assertEqual(seen[-1], ["finest", 128])
        last = seen[len(seen) - 1 - [quality for quality, _ in reversed(seen)].index("preview"):]
        self.assertEqual([count for _, count in last], sorted(count for _, count in last), "ever more")
        self.change_shows(CHOOSE, "blades", "5")
        self.assertIn("--blades 5", browser.text(".command"))
        picture = browser.driver.find_element(By.CSS_SELECTOR, ".picture-stage")
        ActionChains(browser.driver).move_to_element_with_offset(picture, 0, -int(picture.size["height"] * 0.42)).double_click().perform()
        # The floor behind the ball: the ray falls by 0.2 - 0.84 * 1.8 mm / 50 mm a metre from a height of 0.34 m.
        browser.until("what is behind it is sharp", lambda: browser.session()["focus_m"] > ball)
        self.assertLess(abs(browser.session()["focus_m"] - 0.34 / (0.2 - 0.84 * 1.8 / 50)), 0.15)
        browser.settle()

    def test_surfaces_are_coated(self):
        browser = self.browser
        choose = """const select = document.querySelector(`[data-coating="${arguments[0]}"]`);
            select.value = arguments[1]; select.dispatchEvent(new Event("change"));"""
        coatings = lambda: [surface.get("coating") for surface in browser.session()["lens"]["surfaces"]]
        light = lambda: browser.run("return Number(document.querySelector('tr[data-ghost=\"2,0\"] td:last-child').textContent.replace('−', '-'))")
        self.change_shows("document.getElementById('tab-ghosts').click()")
        bare = light()
        self.change_shows(choose, "all", "mgf2")
        self.assertEqual(coatings(), ["mgf2", None, "mgf2"], "not between the cemented glasses")
        self.assertIn(f"--lens {LENS} --coating mgf2 ", browser.text(".command"))
        self.assertLess(light(), bare / 3)
        self.change_shows(choose, "0", "quarter-half-quarter")
        self.assertEqual(coatings(), ["quarter-half-quarter", None, "mgf2"])
        self.assertIn("--coating 'surfaces[0]=quarter-half-quarter,surfaces[2]=mgf2' ", browser.text(".command"))
        expected = browser.session()
        browser.driver.refresh()
        browser.settle()
        self.assertEqual(browser.session(), expected)
        self.change_shows(choose, "0", "")
        self.assertEqual(coatings(), [None, None, "mgf2"])
        self.change_shows("document.getElementById('undo').click()")
        self.assertEqual(coatings(), ["quarter-half-quarter", None, "mgf2"])
        browser.run("const field = document.querySelector('[data-glass=\"1\"]'); field.value = ''; field.dispatchEvent(new Event('change'));")
        browser.settle()
        self.assertEqual(coatings(), ["quarter-half-quarter", None, None], "there is no glass any more")

    def test_sources_of_the_scene_make_ghosts_and_stars(self):
        browser = self.browser
        rings = lambda: len(browser.driver.find_elements(By.CSS_SELECTOR, ".source-mark"))
        self.change_shows(CHOOSE, "scene", "points")
        self.assertEqual(rings(), 0)
        self.change_shows("document.querySelector('[data-check=ghosts]').click()")
        self.assertEqual(rings(), 16)
        self.assertIn("16 sources", browser.text(".source-count"))
        self.assertIn("--ghosts --ghost-neglect 0.001", browser.text(".command"))
        self.change_shows("document.querySelector('[data-check=starburst]').click()")
        self.change_shows("document.querySelector('[data-check=ghosts]').click()")
        self.change_shows(SLIDE, "threshold", 1000)
        self.assertIn("--starburst --ghost-threshold 10000 ", browser.text(".command"))
        self.change_shows(CHOOSE, "scene", "slanted-edge")
        self.assertEqual(rings(), 0)
        self.assertIn("no sources", browser.text(".source-count"))

    def test_focuses_where_the_picture_is_clicked(self):
        browser = self.browser
        self.change_shows(SLIDE, "defocus_mm", 900)
        blurred = browser.session()["defocus_mm"]
        picture = browser.driver.find_element(By.CSS_SELECTOR, ".picture-stage")
        ActionChains(browser.driver).move_to_element_with_offset(picture, 40, -30).double_click().perform()
        browser.until("it is focused", lambda: browser.session()["defocus_mm"] != blurred)
        browser.settle()
        sharp = browser.session()["defocus_mm"]
        self.assertLess(abs(sharp), 0.2, "the achromat is focused as it was designed, but for its curved field")
        self.assertIn(f"--defocus {sharp:g} ", browser.text(".command"))
        browser.run("document.getElementById('undo').click()")
        browser.settle()
        browser.run("document.getElementById('focus-here').click()")
        browser.until("it is focused again", lambda: abs(browser.session()["defocus_mm"] - sharp) < 2e-4)

    def test_damaged_files_are_refused_and_good_ones_taken(self):
        with tempfile.TemporaryDirectory() as folder:
            field = self.browser.driver.find_element(By.ID, "file")
            for name, content in [("bad.zmx", b"SURF 0\n CURV x\n"), ("bad.json", b"{\"format\":"), ("bad.png", b"\x89PNG\r\n\x1a\n"), ("what.exe", b"MZ"),
                                  ("bad.seq", b"LEN NEW\nRDM Q\n"), ("bad.jpg", b"\xff\xd8\xff\xe0\0\x10JF"), ("bad.tif", b"II*\0\xff\xff\xff\xff"), ("empty.dat", b"")]:
                path = pathlib.Path(folder) / name
                path.write_bytes(content)
                count = self.browser.run("return document.querySelectorAll('.note.bad').length")
                field.send_keys(str(path))
                self.browser.until(name, lambda count=count: self.browser.run("return document.querySelectorAll('.note.bad').length") > count)
            lens = self.browser.session()["lens"]
            lens["surfaces"][1]["thickness_mm"] = 3.25
            good = pathlib.Path(folder) / "mine.json"
            good.write_text(json.dumps(lens))
            field.send_keys(str(good))
            self.browser.until("the lens is there", lambda: self.browser.session()["lensName"] == "mine")
            self.browser.settle()
            self.assertEqual(self.browser.session()["lens"]["surfaces"][1]["thickness_mm"], 3.25)

    def drop(self, *files):
        """Files dropped onto the page, by name and content."""
        self.browser.run("""const files = new DataTransfer();
            for (const [name, text] of arguments[0]) files.items.add(new File([Uint8Array.from(atob(text), c => c.charCodeAt(0))], name));
            document.dispatchEvent(new DragEvent("drop", {dataTransfer: files, cancelable: true}));""",
                         [[name, base64.b64encode(content).decode()] for name, content in files])

    def told(self):
        return self.browser.run("return [...document.querySelectorAll('.note.bad')].map(each => each.textContent)")

    def test_a_spectral_file_that_is_dropped_becomes_the_scene(self):
        browser = self.browser
        header = b"ENVI\nsamples = 12\nlines = 9\nbands = 3\ndata type = 1\ninterleave = bsq\nwavelength = {420, 550, 660}\nreflectance scale factor = 255\n"
        numbers = bytes(60 + 40 * ((x // 3 + y // 3) % 2) + 30 * band for band in range(3) for y in range(9) for x in range(12))
        self.drop(("cube.hdr", header), ("cube.raw", numbers))
        browser.until("the scene is there", lambda: browser.session()["scene"] == "dropped spectra")
        browser.settle()
        self.assertEqual(self.problem(), "")
        self.assertEqual(browser.text(".badge"), "finest")
        self.assertEqual(browser.text(".detail"), "25 bands, 160 × 120")
        self.assertIn("--illuminant D65 --wavelengths 420:10:660", browser.text(".command"))
        # The other lens has a bench of its own, which is given the scene too.
        browser.run("document.getElementById('compare').click()")
        browser.until("the other picture", lambda: browser.run("return document.querySelector('.compare .badge').textContent") == "finest")
        self.assertEqual(browser.text(".compare-problem"), "")
        browser.run("document.getElementById('compare').click()")

    def test_damaged_and_too_large_spectral_files_are_refused(self):
        browser = self.browser
        header = b"ENVI\nsamples = 12\nlines = 9\nbands = 3\ndata type = 1\ninterleave = bsq\nwavelength = {420, 550, 660}\nreflectance scale factor = 255\n"
        for files, told in [([("cube.hdr", header), ("cube.raw", b"few")], "cube.raw: holds 3 bytes"), ([("cube.hdr", header)], "cube.hdr: has no data beside it"),
                            ([("cube.raw", b"few")], "cube.raw: the bench reads"), ([("cube.mat", b"MATLAB")], "cube.mat: "), ([("cube.exr", b"v/1\x01")], "cube.exr: "),
                            ([("cube.npy", b"\x93NUMPY\1\0")], "cube.npy: "), ([("a.npy", b""), ("b.npy", b""), ("c.npy", b"")], "one file at a time")]:
            with self.subTest(told):
                self.drop(*files)
                browser.until(told, lambda told=told: any(text.startswith(told) for text in self.told()))
        browser.run("""const files = new DataTransfer();
            files.items.add(new File([new Uint8Array(65 * 1024 * 1024)], "large.npy"));
            document.dispatchEvent(new DragEvent("drop", {dataTransfer: files, cancelable: true}));""")
        browser.until("it says so", lambda: "large.npy: is too large; 64 MiB are the most" in self.told())
        self.change_shows(SLIDE, "defocus_mm", 600)


if __name__ == "__main__":
    run_tests()
