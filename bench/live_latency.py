# SPDX-License-Identifier: BSD-3-Clause
"""How soon the page of petzval live follows the hand, and what the server's memory does.

    live_latency.py PROGRAM CHROMIUM CHROMEDRIVER [MOVES [LENS]]

Moves the air gaps of a lens in turn, before a sensor that previews of 640 x 480 pixels fit. From each input event to what came of it:
rays, point spread and plot, preview; each move waits for the preview of the one before. Two ends are stated. "drawn": the browser
calls back after the frame in which the page was altered, that is when the page's thread has done its part. "seen": the compositor has
presented that frame, as Chromium's own trace says (AnimationFrame::Presentation); the moves are done again for it, as a trace slows the
page down. First with frames of 60 Hz, then with Chromium's limit of frames off, which shows what the screen's clock adds. Then 1,000
quick moves without waiting, and the server's resident memory after 100 of them and after all.
"""

import json
import math
import os
import pathlib
import statistics
import sys
import tempfile
import time

from chromium_trace import ChromiumTrace

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "browser"))
from live_browser import SLIDE, Browser, Server, resident_mb, sweep  # noqa: E402

PAUSE_S = 2  # a server that rests gives memory back
# One move; resolves with the milliseconds from the event to the paint of each stage.
MOVE = """
const [gap, to, done] = arguments, page = window.petzvalPage, times = {};
const painted = stage => requestAnimationFrame(() => { if (!times[stage]) performance.mark("petzval " + stage); const channel = new MessageChannel();
  channel.port1.onmessage = () => { times[stage] ??= performance.now() - began; if (stage === "preview") { page.take = take; done(times); } };
  channel.port2.postMessage(0); });
const take = page.take.bind(page);
page.take = (message, bytes) => {
  take(message, bytes);
  if (message.id !== page.id) return;
  if (message.kind === "layout") painted("rays");
  if (message.kind === "psf") painted("psf");
  if (message.kind === "plots") painted("plot");
  if (message.kind === "picture" && message.quality === "preview") {
    times.columns = message.columns;
    painted("preview");
  }
};
const slider = document.querySelector(`[data-slider="surfaces[${gap}].thickness_mm"]`);
slider.value = to;
performance.mark("petzval event");
const began = performance.now();
slider.dispatchEvent(new Event("input"));
"""
# What each stage took of the processor.
COUNT_CPU = """
const page = window.petzvalPage, take = page.take.bind(page);
window.stageCpu = {};
page.take = (message, bytes) => {
  if (message.kind === "stage") (window.stageCpu[message.stage] ??= []).push(message.cpu_ms);
  take(message, bytes);
};
"""


def work_of_stages(browser, gaps, moves=10):
    """Milliseconds of one core by stage, each stage without another beside it; whatever else the machine does."""
    browser.run(COUNT_CPU)
    for i in range(moves):
        browser.run("document.getElementById('tab-distortion').click()")
        browser.run(SLIDE, f"surfaces[{gaps[i % len(gaps)]}].thickness_mm", 460 + (i * 29) % 80)
        browser.until("the full picture", lambda: browser.run("return Number(document.body.dataset.full) === window.petzvalPage.id"))
        browser.run("document.getElementById('tab-mtf').click()")
        # Not until all is shown: the finest picture takes many seconds.
        browser.until("MTF", lambda: browser.run("const page = window.petzvalPage; return !page.pending && page.plots.get('mtf')?.id === page.id"))
    return browser.run("return window.stageCpu")


def sensor_of_previews(folder):
    """A sensor file whose pixels are added up to 640 x 480; its path. As far from the middle to the corner as in the 35 mm format."""
    sensor = json.loads((ROOT / "data" / "sensors" / "full-frame-24mp.json").read_text())
    added, half_diagonal_mm = 8, 21.6
    sensor |= {"name": "640 x 480 for previews", "columns": 640 * added, "rows": 480 * added, "pitch_um": round(half_diagonal_mm * 1000 / 400 / added, 3)}
    path = pathlib.Path(folder) / "previews.json"
    path.write_text(json.dumps(sensor))
    return path


def warm_up(browser, gaps, moves=20):
    """The bench finds the size of its previews by how long they take."""
    for i in range(moves):
        browser.driver.execute_async_script(MOVE, gaps[i % len(gaps)], 459 + (i * 31) % 80)  # not where the first moves go


def seen(trace):
    """Milliseconds from each event to the presentation of each stage, move by move."""
    moves = []
    for name, ms in trace.marks("petzval "):
        if name == "event":
            moves.append({"began": ms})
        else:
            moves[-1][name] = trace.presented_ms(ms) - moves[-1]["began"]
    return moves


def print_times(drawn, presented):
    def line(values):
        values = sorted(value for value in values if not math.isnan(value))
        return f"{statistics.median(values):6.1f} ({values[int(0.9 * (len(values) - 1))]:6.1f})"

    print("           drawn, ms: median (nine of ten)   seen")
    for stage in ["rays", "psf", "plot", "preview"]:
        if values := [each[stage] for each in drawn if stage in each]:
            print(f"  {stage:8} {line(values):>24}   {line(each[stage] for each in presented if stage in each):>20}")
    columns = [int(each["columns"]) for each in drawn]
    print("  previews of", ", ".join(f"{width} pixels across ({columns.count(width)})" for width in sorted(set(columns))))


def measure(browser, gaps, moves):
    def move():
        return [browser.driver.execute_async_script(MOVE, gaps[i % len(gaps)], 460 + (i * 29) % 80) for i in range(moves)]

    warm_up(browser, gaps)
    drawn = move()
    with ChromiumTrace(browser.driver) as trace:  # which takes its time, too
        move()
    print_times(drawn, seen(trace))


def gaps_of(browser):
    return [int(pin["path"].split("[")[1].split("]")[0]) for pin in browser.session()["pins"]]


def main():
    program, chromium, driver = sys.argv[1:4]
    moves = int(sys.argv[4]) if len(sys.argv) > 4 else 100
    lens = sys.argv[5] if len(sys.argv) > 5 else "dgauss-50mm"
    with tempfile.TemporaryDirectory() as folder, Server(program, lens, "--sensor", str(sensor_of_previews(folder))) as server:
        for title, words in [("frames of 60 Hz", []), ("as many frames as Chromium can", ["--disable-frame-rate-limit", "--disable-gpu-vsync"])]:
            with Browser(chromium, driver, words=words) as browser:
                browser.driver.set_script_timeout(600)
                browser.open(server.url)
                print(f"{lens}, {moves} moves of air gaps, {title}; load of the machine {os.getloadavg()[0]:.1f}, {os.cpu_count()} processors")
                measure(browser, gaps_of(browser), moves)
                if not words:
                    work_and_memory(browser, server, gaps_of(browser))


def work_and_memory(browser, server, gaps):
    browser.settle()
    print("full and finest picture, on the server:", *browser.run("return ['picture', 'finest'].map(stage => window.petzvalPage.times.get(stage))"), "ms")
    # After 100 moves and after 1,000 the same has been asked for: waiting, quickly, and by stages.
    sweep(browser, gaps, 100)
    for stage, values in work_of_stages(browser, gaps).items():
        print(f"  {stage:12} {statistics.median(values):7.1f} ms of one core")
    time.sleep(PAUSE_S)
    few = resident_mb(server.process)
    sweep(browser, gaps, 900)
    work_of_stages(browser, gaps)
    time.sleep(PAUSE_S)
    print(f"memory of the server: {few:.0f} MB after the first 100 quick moves, {resident_mb(server.process):.0f} MB after 1,000")


if __name__ == "__main__":
    main()
