# SPDX-License-Identifier: BSD-3-Clause
"""The controls of petzval live as a person meets them, in Chromium.

    test_live_page.py PROGRAM CHROMIUM CHROMEDRIVER [TEST ...]
"""

import json
import pathlib
import tempfile
import time
import unittest

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from live_browser import SLIDE, Browser, Server, resident_mb, sweep
from live_page import CHOOSE, CHROMIUM, DRIVER, LENS, PROGRAM, QUICK, TYPE, LivePage, run_tests


class Controls(LivePage):
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

    def test_a_drawing_brought_up_to_date_is_that_drawn_anew(self):
        both = """const layout = window.petzvalPage.layout, updated = layout.element.innerHTML;
            layout.element.replaceChildren();
            layout.draw();
            return [updated, layout.element.innerHTML];"""
        # The same shape with other places, another stop, a field without rays, and a lens of another shape.
        for change in ["session.lens.surfaces[1].thickness_mm += 1", "session.lens.surfaces[0].stop = false; session.lens.surfaces[2].stop = true",
                       "session.lens.fields.values[2] = 60", "session.lens.surfaces.push({...session.lens.surfaces[2], radius_mm: 80, stop: false, thickness_mm: 60})"]:
            with self.subTest(change):
                self.browser.run(f"window.petzvalPage.alterLens(() => {{ const session = window.petzvalPage.session; {change} }}, '')")
                self.browser.wait_for_drawing()
                updated, anew = self.browser.run(both)
                self.assertEqual(updated, anew)
        self.assertIn("no ray", self.browser.text(".layout-box .legend"))
        stop = self.browser.driver.find_element(By.CSS_SELECTOR, ".layout .handle.vertical")
        self.assertIn("surface 2", stop.find_element(By.TAG_NAME, "title").get_attribute("textContent"))
        self.assertEqual(stop.get_attribute("data-stop"), "2")

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
    run_tests()
