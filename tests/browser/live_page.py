# SPDX-License-Identifier: BSD-3-Clause
"""What tests of the page of petzval live share: a server, a browser, and what a person does there."""

import sys
import tempfile
import unittest

from live_browser import Browser, Server, small_sensor

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
            # A page that has not kept its session yet does it when it is left.
            self.browser.run("""const page = window.petzvalPage;
                if (page) { clearTimeout(page.keeping); page.keeping = undefined; }
                sessionStorage.clear(); localStorage.clear();""")
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


def run_tests():
    """Of a file that is called with PROGRAM CHROMIUM CHROMEDRIVER [TEST ...]."""
    unittest.main(argv=sys.argv[:1] + sys.argv[4:], verbosity=2)
