# SPDX-License-Identifier: BSD-3-Clause
"""petzval live and a browser without a window that looks at it: for tests, screenshots and measurements."""

import json
import os
import pathlib
import subprocess

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.support.ui import WebDriverWait

PATIENCE_S = 600  # a machine may be busy; nothing is asserted about time

SETTLED = """const page = window.petzvalPage, set = document.body.dataset;
return Boolean(page && set.ready && !page.pending && page.link.isOpen && Number(set.idle) === page.id && !page.stale && !page.lastLayout);"""
DRAWN = """const page = window.petzvalPage, set = document.body.dataset;
return Boolean(page && !page.pending && page.link.isOpen && Number(set.layout) === page.id && !page.stale && !page.lastLayout);"""
# Movements of a pointer reach the page with a frame; and what is shown may change the sizes of other parts, which are drawn anew in the next.
NEXT_FRAME = "const done = arguments[0]; requestAnimationFrame(() => setTimeout(done));"

SLIDE = """const slider = document.querySelector(`[data-slider="${arguments[0]}"]`);
slider.value = arguments[1]; slider.dispatchEvent(new Event("input")); slider.dispatchEvent(new Event("change"));"""
# Moves that do not wait: a frame apart.
SWEEP = """
const [gaps, count, done] = arguments;
let i = 0;
const step = () => {
  if (i === count) return done(count);
  const slider = document.querySelector(`[data-slider="surfaces[${gaps[i % gaps.length]}].thickness_mm"]`);
  slider.value = 450 + (i * 37) % 100;
  slider.dispatchEvent(new Event("input"));
  ++i;
  requestAnimationFrame(step);
};
step();
"""


def sweep(browser, gaps, count):
    """Moves these air gaps of the lens, without waiting for what comes of it, and then waits."""
    browser.driver.execute_async_script(SWEEP, gaps, count)
    browser.settle()


def resident_mb(process):
    for line in pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines():
        if line.startswith("VmRSS"):
            return int(line.split()[1]) / 1024
    return float("nan")


def small_sensor(folder):
    """A sensor file of 160 x 120 large pixels, so that full pictures are quick; its path."""
    bundled = pathlib.Path(__file__).resolve().parents[2] / "data" / "sensors" / "third-inch-1280x960.json"
    sensor = json.loads(bundled.read_text())
    larger = 8
    for key in ["columns", "rows"]:
        sensor[key] //= larger
    sensor["pitch_um"] *= larger
    path = pathlib.Path(folder) / "small.json"
    path.write_text(json.dumps(sensor))
    return path


class Server:
    """petzval live, which is ended with this; `port` 0: one that is free."""

    def __init__(self, program, *words, port=0, folder=None):
        environment = dict(os.environ)
        if folder:
            environment["XDG_RUNTIME_DIR"] = str(folder)
        self.process = subprocess.Popen([program, "live", "--no-open", "--quiet", "--port", str(port), *words], stdout=subprocess.PIPE,
                                        stderr=subprocess.DEVNULL, text=True, env=environment)
        self.url = self.process.stdout.readline().strip()
        if not self.url:
            raise RuntimeError("petzval live did not start")
        self.port = int(self.url.split(":")[2].split("/")[0])

    def kill(self):
        self.process.kill()
        self.process.wait()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.kill()


class Browser:
    """Chromium with one page, in a window of this size; `words`: of its command line, besides."""

    def __init__(self, chromium, driver, width=1280, height=720, downloads=None, words=()):
        options = Options()
        options.binary_location = chromium
        for word in ["--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--disable-dev-shm-usage", f"--window-size={width},{height}", *words]:
            options.add_argument(word)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        if downloads:
            options.add_experimental_option("prefs", {"download.default_directory": str(downloads),
                                                      "profile.default_content_setting_values.automatic_downloads": 1})
        self.driver = webdriver.Chrome(service=Service(driver), options=options)
        self.driver.set_script_timeout(PATIENCE_S)
        self.resize(width, height)

    def resize(self, width, height):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})

    def open(self, url):
        self.driver.get(url)
        self.settle()

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def until(self, what, condition):
        WebDriverWait(self.driver, PATIENCE_S, 0.05).until(lambda _: condition(), what)

    def settle(self):
        """Waits until all that was asked for is shown, the finest picture too."""
        self.wait_for("everything is shown", SETTLED)

    def wait_for_drawing(self):
        """Waits until the drawing and the facts about the lens are those of the last change; pictures may still come."""
        self.wait_for("the drawing is shown", DRAWN)

    def wait_for(self, what, script):
        self.driver.execute_async_script(NEXT_FRAME)
        self.until(what, lambda: self.run(script))
        self.driver.execute_async_script(NEXT_FRAME)

    def session(self):
        return self.run("return JSON.parse(JSON.stringify(window.petzvalPage.session))")

    def text(self, selector):
        return self.run("return document.querySelector(arguments[0])?.textContent ?? ''", selector)

    def complaints(self):
        """What the page told the console as an error."""
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.driver.quit()
