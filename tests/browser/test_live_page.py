# SPDX-License-Identifier: BSD-3-Clause
"""The page of petzval live as a person meets it, in Chromium.

    test_live_page.py PROGRAM CHROMIUM CHROMEDRIVER [TEST ...]
"""

import base64
import json
import pathlib
import sys
import tempfile
import time
import unittest

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from live_browser import SLIDE, Browser, Server, resident_mb, small_sensor, sweep

PROGRAM, CHROMIUM, DRIVER = sys.argv[1:4]
LENS = "achromat-50mm"
FOLDER = tempfile.TemporaryDirectory()
QUICK = [LENS, "--scene", "slanted-edge", "--sensor", str(small_sensor(FOLDER.name))]

CHOOSE = """const select = document.querySelector(`[data-choice="${arguments[0]}"]`);
select.value = arguments[1]; select.dispatchEvent(new Event("change"));"""
TYPE = """const field = document.querySelector(`[data-path="${arguments[0]}"]`);
field.value = arguments[1]; field.dispatchEvent(new Event("change"));"""


class LivePage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.downloads = tempfile.TemporaryDirectory()
        cls.server = Server(PROGRAM, *QUICK)
        cls.browser = Browser(CHROMIUM, DRIVER, downloads=cls.downloads.name)

    @classmethod
    def tearDownClass(cls):
        cls.browser.__exit__()
        cls.server.kill()
        cls.downloads.cleanup()

    def setUp(self):
        self.fresh()

    def fresh(self):
        """As if the page had never been open."""
        if self.browser.driver.current_url.startswith("http"):
            self.browser.run("sessionStorage.clear(); localStorage.clear()")
        self.browser.driver.get("about:blank")
        self.browser.open(self.server.url)

    def tearDown(self):
        self.assertEqual(self.browser.complaints(), [])

    def problem(self):
        return self.browser.text(".banner")

    def change_shows(self, script, *arguments):
        """After a change something was worked out, and nothing is wrong."""
        before = self.browser.run("return window.petzvalPage.id")
        self.browser.run(script, *arguments)
        self.browser.settle()
        self.assertGreater(self.browser.run("return window.petzvalPage.id"), before, arguments)
        self.assertEqual(self.problem(), "", arguments)

    def test_shows_everything_and_ends_with_the_full_picture(self):
        browser = self.browser
        self.assertEqual(browser.text(".badge"), "finest")
        self.assertEqual(browser.text(".detail"), "31 bands, 160 × 120")
        self.assertEqual(len(browser.driver.find_elements(By.CSS_SELECTOR, ".prescription tr[data-surface]")), 3)
        self.assertGreater(browser.run("return [...document.querySelectorAll('.layout .ray')].reduce((sum, each) => sum + Number(each.dataset.rays), 0)"), 10)
        self.assertIn("f50", browser.text(".facts").replace(" ", "").replace("49.", "50"))
        lit = browser.run("const c = document.querySelector('.picture'); return c.getContext('2d').getImageData(0, 0, c.width, c.height).data.reduce((most, v, i) => i % 4 === 3 ? most : Math.max(most, v), 0)")
        self.assertGreater(lit, 100)
        self.assertNotIn("token", browser.driver.current_url, "the secret does not stay in the address")

    def test_every_slider_and_choice_is_shown(self):
        steps = {"f_number": 500, "defocus_mm": 700, "distance_m": 500, "compensation_ev": 600, "denoise": 500, "sharpen": 500, "roughness_nm": 300}
        there = self.browser.run("return [...document.querySelectorAll('[data-slider]')].map(each => each.dataset.slider)")
        self.assertEqual({name for name in there if not name.startswith("surfaces")}, set(steps), "all of them are tried")
        for name, step in steps.items():
            with self.subTest(name):
                self.change_shows(SLIDE, name, step)
        self.change_shows(SLIDE, "roughness_nm", 0)
        for name, value in [("focus", "auto"), ("focus", "infinity"), ("focus", "paraxial"), ("focus", "best-spot"), ("focus", "distance"), ("illuminant", "A"),
                            ("tone", "soft"), ("scene", "grid"), ("sensor", "third-inch-vga")]:
            with self.subTest(name + " " + value):
                self.change_shows(CHOOSE, name, value)
        self.change_shows(SLIDE, "focus_m", 300)
        self.change_shows("document.querySelector('[data-check=noise]').click()")
        command = self.browser.text(".command")
        for word in ["--f-number", "--defocus", "--scene-distance", "--exposure-compensation", "--denoise", "--sharpen", "--illuminant A", "--tone soft",
                     "petzval image grid", "--sensor third-inch-vga", "--without shot"]:
            self.assertIn(word, command)

    def test_every_lens_of_the_list_can_be_chosen(self):
        for lens in ["tessar", "fisheye-10mm", "plano-convex"]:
            with self.subTest(lens):
                self.change_shows(CHOOSE, "lens", lens)
                self.browser.until("it is there", lambda lens=lens: self.browser.session()["lensName"] == lens)
                self.browser.settle()
                self.assertEqual(self.browser.run("return document.querySelector('[data-choice=lens]').value"), lens)

    def test_every_plot_has_lines(self):
        for tab in self.browser.run("return [...document.querySelectorAll('.tabs button')].map(tab => tab.id)"):
            with self.subTest(tab):
                self.browser.run("document.getElementById(arguments[0]).click()", tab)
                self.browser.settle()
                self.assertGreater(self.browser.run("return document.querySelectorAll('.plot-box .plot g path').length"), 0)

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

    def test_two_lenses_side_by_side(self):
        browser = self.browser
        shown = lambda: browser.run("const c = document.querySelector('.compare canvas.picture'); return [c.width, document.querySelector('.compare .badge').textContent]")
        browser.run("document.getElementById('compare').click()")
        browser.until("the other picture", lambda: shown()[0] > 0 and shown()[1] == "finest")
        browser.until("both plots", lambda: browser.run("return document.querySelectorAll('.half svg.plot').length") == 2)
        browser.run(CHOOSE, "compare", "plano-convex")
        browser.until("its lens", lambda: (browser.session()["compared"] or {}).get("lens") and browser.session()["compared"]["name"] == "plano-convex")
        browser.until("its picture", lambda: shown()[0] > 0 and shown()[1] == "finest")
        expected = browser.session()
        browser.driver.refresh()
        browser.settle()
        self.assertEqual(browser.session(), expected)
        # The camera is that of both.
        browser.run(SLIDE, "defocus_mm", 700)
        browser.until("both follow", lambda: browser.run("return document.querySelector('.compare').dataset.idle === document.body.dataset.idle && document.body.dataset.idle === String(window.petzvalPage.id)"))
        browser.run("document.getElementById('compare').click()")
        browser.settle()
        self.assertTrue(browser.run("return document.querySelector('.compare').hidden"))
        self.assertEqual(browser.run("return document.querySelectorAll('.half').length"), 0)

    def test_table_undo_and_redo(self):
        path = "surfaces[1].thickness_mm"
        self.change_shows(TYPE, path, "4")
        self.assertEqual(self.browser.session()["lens"]["surfaces"][1]["thickness_mm"], 4)
        self.assertIn("--set 'surfaces[1].thickness_mm=4'", self.browser.text(".command"))
        self.browser.driver.find_element(By.ID, "undo").click()
        self.browser.settle()
        self.assertEqual(self.browser.session()["lens"]["surfaces"][1]["thickness_mm"], 2.5)
        ActionChains(self.browser.driver).key_down(Keys.CONTROL).key_down(Keys.SHIFT).send_keys("z").key_up(Keys.SHIFT).key_up(Keys.CONTROL).perform()
        self.browser.settle()
        self.assertEqual(self.browser.session()["lens"]["surfaces"][1]["thickness_mm"], 4)

    def test_typed_nonsense_is_refused_and_forgotten(self):
        self.browser.run(TYPE, "surfaces[0].radius_mm", "forty")
        self.browser.until("it says so", lambda: "is not a number" in self.browser.text(".message"))
        self.assertNotEqual(self.browser.run("return document.querySelector('[data-path=\"surfaces[0].radius_mm\"]').value"), "forty")

    def test_a_number_gets_a_slider(self):
        self.browser.run("document.querySelector('[data-path=\"surfaces[0].radius_mm\"]').parentElement.querySelector('.pin').click()")
        self.browser.settle()
        self.change_shows(SLIDE, "surfaces[0].radius_mm", 600)
        session = self.browser.session()
        self.assertNotEqual(session["lens"]["surfaces"][0]["radius_mm"], session["base"]["surfaces"][0]["radius_mm"])

    def test_glass_is_found_by_a_part_of_its_name(self):
        field = self.browser.driver.find_element(By.CSS_SELECTOR, "[data-glass='0']")
        field.click()
        field.send_keys(Keys.CONTROL, "a")
        field.send_keys("nbak1")
        self.browser.until("a list", lambda: "SCHOTT:N-BAK1" in self.browser.text(".glass-list button"))
        field.send_keys(Keys.ARROW_DOWN)
        self.assertEqual(self.browser.run("return document.activeElement.querySelector('span')?.textContent"), "SCHOTT:N-BAK1")
        time.sleep(0.3)  # a person looks before the choice
        self.browser.driver.switch_to.active_element.send_keys(Keys.ENTER)
        self.browser.settle()
        self.assertEqual(self.browser.session()["lens"]["surfaces"][0]["glass"], "SCHOTT:N-BAK1")
        self.assertEqual(field.get_attribute("value"), "SCHOTT:N-BAK1")
        self.assertEqual(self.browser.text(".glass-list"), "")

    def test_typed_search_is_forgotten_when_none_is_chosen(self):
        before = self.browser.session()["lens"]["surfaces"][0]["glass"]
        field = self.browser.driver.find_element(By.CSS_SELECTOR, "[data-glass='0']")
        shown = field.get_attribute("value")
        field.click()
        field.send_keys(Keys.CONTROL, "a")
        field.send_keys("nbak1")
        self.browser.until("a list", lambda: "SCHOTT:N-BAK1" in self.browser.text(".glass-list button"))
        field.send_keys(Keys.ARROW_DOWN)
        self.browser.driver.find_element(By.CSS_SELECTOR, "[data-path='surfaces[0].radius_mm']").click()
        self.browser.until("no list", lambda: not self.browser.text(".glass-list"))
        self.assertEqual(field.get_attribute("value"), shown)
        self.assertEqual(self.browser.session()["lens"]["surfaces"][0]["glass"], before)
        self.assertEqual(self.problem(), "")

    def test_glass_can_be_dragged_along_the_axis(self):
        handle = self.browser.driver.find_elements(By.CSS_SELECTOR, ".layout .handle:not(.vertical)")[-1]  # the sensor
        before = self.browser.session()["lens"]["surfaces"][2]["thickness_mm"]
        ActionChains(self.browser.driver).click_and_hold(handle).move_by_offset(-4, 0).move_by_offset(-4, 0).release().perform()
        self.browser.settle()
        self.assertLess(self.browser.session()["lens"]["surfaces"][2]["thickness_mm"], before)
        self.browser.driver.find_element(By.ID, "undo").click()
        self.browser.settle()
        self.assertEqual(self.browser.session()["lens"]["surfaces"][2]["thickness_mm"], before, "one drag is one step")

    def test_the_place_of_the_psf_follows_the_pointer(self):
        picture = self.browser.driver.find_element(By.CSS_SELECTOR, ".picture-stage")
        ActionChains(self.browser.driver).move_to_element_with_offset(picture, 80, -50).click().perform()
        self.browser.settle()
        x, y = self.browser.session()["cursor_mm"]
        self.assertGreater(x, 0)
        self.assertGreater(y, 0)
        self.assertNotIn(" 0 mm", self.browser.text(".psf-facts"))

    def test_a_lens_that_no_light_passes_is_told_and_can_be_mended(self):
        # At f/100 the beam is half a millimetre wide, and at 4 degrees more than its radius from the axis at the last surface.
        self.browser.run("window.petzvalPage.change(() => { window.petzvalPage.session.f_number = 100; })")
        self.browser.run(TYPE, "surfaces[2].semi_diameter_mm", "0.001")
        self.browser.until("it is told", lambda: "surface 2" in self.problem())
        self.browser.settle()
        self.assertTrue(self.browser.run("return document.querySelector('tr[data-surface=\"2\"]').classList.contains('blamed')"))
        self.browser.run(TYPE, "surfaces[2].semi_diameter_mm", "12")
        self.browser.settle()
        self.assertEqual(self.problem(), "")
        self.browser.run(TYPE, "surfaces[0].radius_mm", "0.00001")
        self.browser.until("a fault is told", lambda: self.problem() != "")
        self.browser.run("document.getElementById('undo').click()")
        self.browser.settle()
        self.assertEqual(self.problem(), "")

    def test_reload_and_link_bring_the_session_back(self):
        self.change_shows(SLIDE, "defocus_mm", 800)
        expected = self.browser.session()
        self.browser.driver.refresh()
        self.browser.settle()
        self.assertEqual(self.browser.session(), expected)
        packed = self.browser.driver.execute_async_script(
            "const done = arguments[0], bytes = new Blob([JSON.stringify(window.petzvalPage.session)]).stream().pipeThrough(new CompressionStream('deflate-raw'));"
            "new Response(bytes).arrayBuffer().then(b => done(btoa(String.fromCharCode(...new Uint8Array(b))).replace(/\\+/g, '-').replace(/\\//g, '_').replace(/=+$/, '')))")
        self.fresh()
        self.assertNotEqual(self.browser.session(), expected)
        self.browser.driver.get("about:blank")
        self.browser.open(self.server.url.split("#")[0] + "#session=" + packed)
        self.assertEqual(self.browser.session(), expected)

    def test_two_pages_are_two_benches(self):
        driver, first = self.browser.driver, self.browser.driver.current_window_handle
        self.change_shows(SLIDE, "defocus_mm", 900)
        driver.switch_to.new_window("tab")
        self.browser.resize(1280, 720)
        self.browser.open(self.server.url)
        self.assertEqual(self.browser.session()["defocus_mm"], 0)
        self.change_shows(SLIDE, "defocus_mm", 100)
        driver.close()
        driver.switch_to.window(first)
        self.browser.settle()
        self.assertGreater(self.browser.session()["defocus_mm"], 0)

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

    def touch(self, element, dx, dy):
        """A finger put on the middle of an element, moved and lifted."""
        box = self.browser.run("const box = arguments[0].getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]", element)
        def at(kind, points):
            self.browser.driver.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
        steps = 4
        at("touchStart", [{"x": box[0], "y": box[1]}])
        for i in range(1, steps + 1):
            at("touchMove", [{"x": box[0] + dx * i / steps, "y": box[1] + dy * i / steps}])
        at("touchEnd", [])
        self.browser.settle()

    def test_a_finger_moves_glass_stop_slider_and_ring(self):
        find = lambda selector: self.browser.driver.find_elements(By.CSS_SELECTOR, selector)[-1]
        before = self.browser.session()
        self.touch(find(".layout .handle:not(.vertical)"), -8, 0)
        moved = self.browser.session()
        self.assertLess(moved["lens"]["surfaces"][2]["thickness_mm"], before["lens"]["surfaces"][2]["thickness_mm"])
        self.touch(find(".layout .handle.vertical"), 0, -6)
        self.assertIsNotNone(self.browser.session()["f_number"])
        self.touch(find("[data-slider='compensation_ev']"), 20, 0)
        self.assertGreater(self.browser.session()["shot"]["compensation_ev"], 0)
        self.touch(self.browser.driver.find_element(By.CSS_SELECTOR, ".picture"), 30, 0)
        self.assertGreater(self.browser.session()["cursor_mm"][0], before["cursor_mm"][0])

    def test_lens_and_picture_are_saved(self):
        self.change_shows("""const select = document.querySelector('[data-coating="all"]');
            select.value = "mgf2"; select.dispatchEvent(new Event("change"));""")
        for entry, name in [("save-json", LENS + ".json"), ("save-zmx", LENS + ".zmx"), ("save-png", LENS + ".png"), ("save-dng", LENS + ".dng"),
                            ("save-exr", LENS + ".exr"), ("save-report", LENS + "-report.html"), ("save-session", "session.petzval.json")]:
            with self.subTest(entry):
                path = pathlib.Path(self.downloads.name) / name
                path.unlink(missing_ok=True)
                self.browser.run("document.getElementById(arguments[0]).click()", entry)
                self.browser.until(name, lambda path=path: path.exists() and path.stat().st_size > 100)
        saved = json.loads((pathlib.Path(self.downloads.name) / (LENS + ".json")).read_text())
        self.assertEqual([surface.get("coating") for surface in saved["surfaces"]], ["mgf2", None, "mgf2"])
        report = (pathlib.Path(self.downloads.name) / (LENS + "-report.html")).read_text()
        self.assertNotIn("<script", report)
        for word in ["SCHOTT:", "mgf2", "data:image/png", "Field curvature", "petzval image slanted-edge"]:
            self.assertIn(word, report)
        self.assertGreater(report.count('class="plot"'), 10)

    def test_numbers_fit_their_column_and_are_whole_when_they_are_typed_into(self):
        self.change_shows(CHOOSE, "lens", "double-gauss")
        self.browser.until("the lens", lambda: self.browser.session()["lensName"] == "double-gauss")
        whole = self.browser.session()["lens"]["surfaces"][1]["radius_mm"]
        field = self.browser.driver.find_element(By.CSS_SELECTOR, '[data-path="surfaces[1].radius_mm"]')
        text = lambda: field.get_property("value")
        self.assertLessEqual(len(text()), 7)
        self.assertLess(abs(float(text()) / whole - 1), 1e-4)
        self.assertNotEqual(float(text()), whole)
        field.click()
        self.assertEqual(float(text()), whole)
        field.send_keys(Keys.TAB)
        self.assertLessEqual(len(text()), 7)
        self.assertEqual(self.browser.session()["lens"]["surfaces"][1]["radius_mm"], whole, "nothing was typed")

    def test_before_and_after_theme_and_tour(self):
        self.browser.run("document.getElementById('before').click()")
        self.assertTrue(self.browser.run("return !document.querySelector('.divider').hidden"))
        self.change_shows(SLIDE, "defocus_mm", 900)
        self.browser.run("document.getElementById('before').click()")
        self.assertTrue(self.browser.run("return document.querySelector('.divider').hidden"))
        ground = "return getComputedStyle(document.body).backgroundColor"
        light = self.browser.run(ground)
        self.browser.run("document.getElementById('theme').click()")
        self.assertNotEqual(self.browser.run(ground), light)
        self.browser.run("document.getElementById('theme').click()")
        self.browser.run("document.getElementById('tour').click()")
        self.browser.until("the lens of the exercise", lambda: self.browser.session()["lensName"] == "dgauss-50mm")
        strip, views = self.browser.run("return ['.tour', 'main'].map(each => document.querySelector(each).getBoundingClientRect().toJSON())")
        self.assertGreaterEqual(strip["top"], views["bottom"], "the exercise covers nothing that it asks to look at")
        self.assertLess(strip["height"], 0.2 * 720)
        self.browser.run("document.getElementById('tour').click()")

    def test_moves_take_no_memory_for_ever(self):
        # bench/live_latency.py makes a thousand of them.
        self.change_shows(CHOOSE, "lens", "dgauss-50mm")
        self.browser.until("its sliders", lambda: len(self.browser.session()["pins"]) == 2)
        self.browser.settle()
        gaps = [int(pin["path"].split("[")[1].split("]")[0]) for pin in self.browser.session()["pins"]]
        sweep(self.browser, gaps, 60)
        few = resident_mb(self.server.process)
        sweep(self.browser, gaps, 180)
        self.assertLess(resident_mb(self.server.process), 1.1 * few)

    def test_fits_the_screen(self):
        for width, height in [(1280, 720), (1920, 1080)]:
            self.browser.resize(width, height)
            self.browser.settle()
            self.assertLessEqual(self.browser.run("return document.documentElement.scrollWidth"), width)
            self.assertLessEqual(self.browser.run("return document.documentElement.scrollHeight"), height)
            for selector in [".layout-box", ".picture-stage", ".plot-box", ".table-box", ".controls"]:
                box = self.browser.run("const b = document.querySelector(arguments[0]).getBoundingClientRect(); return [b.width, b.height]", selector)
                self.assertGreater(min(box), 100, selector)
        self.browser.resize(1280, 720)


class ServerThatEnds(unittest.TestCase):
    def test_a_page_goes_on_with_a_server_that_was_started_again(self):
        with tempfile.TemporaryDirectory() as folder, Server(PROGRAM, *QUICK) as free:
            port = free.port
            free.kill()
            first = Server(PROGRAM, *QUICK, port=port, folder=folder)
            with Browser(CHROMIUM, DRIVER) as browser:
                browser.open(first.url)
                browser.run(SLIDE, "defocus_mm", 800)
                browser.settle()
                expected = browser.session()
                first.kill()
                browser.until("it says so", lambda: "does not answer" in browser.text(".banner"))
                browser.run(SLIDE, "defocus_mm", 900)
                changed = browser.session()
                self.assertNotEqual(changed, expected)
                with Server(PROGRAM, *QUICK, port=port, folder=folder):
                    browser.until("it is back", lambda: browser.text(".banner") == "")
                    browser.settle()
                    self.assertEqual(browser.session(), changed)

    def test_ends_with_its_last_page(self):
        with Server(PROGRAM, *QUICK, "--end-with-page") as server:
            with Browser(CHROMIUM, DRIVER) as browser:
                browser.open(server.url)
            self.assertEqual(server.process.wait(), 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:], verbosity=2)
