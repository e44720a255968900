# SPDX-License-Identifier: BSD-3-Clause
"""How soon the page of petzval live follows the hand, and what the server's memory does.

    live_latency.py PROGRAM CHROMIUM CHROMEDRIVER [MOVES [LENS]]

Moves the air gaps of a lens in turn. From each input event to the frame that paints what came of it: rays, point spread and plot,
preview; each move waits for the preview of the one before. A frame counts as painted when the browser calls back after the one in
which the page was altered. Then 1,000 quick moves without waiting, and the server's resident memory after 100 of them and after all.
"""

import os
import pathlib
import statistics
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests" / "browser"))
from live_browser import SLIDE, Browser, Server, resident_mb, sweep  # noqa: E402

PAUSE_S = 2  # a server that rests gives memory back
# One move; resolves with the milliseconds from the event to the paint of each stage.
MOVE = """
const [gap, to, done] = arguments, page = window.petzvalPage, times = {};
const painted = stage => requestAnimationFrame(() => { const channel = new MessageChannel();
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
        browser.settle()
        browser.run(SLIDE, f"surfaces[{gaps[i % len(gaps)]}].thickness_mm", 460 + (i * 29) % 80)
        browser.settle()
        browser.run("document.getElementById('tab-mtf').click()")
        browser.settle()
    return browser.run("return window.stageCpu")


def main():
    program, chromium, driver = sys.argv[1:4]
    moves = int(sys.argv[4]) if len(sys.argv) > 4 else 100
    lens = sys.argv[5] if len(sys.argv) > 5 else "dgauss-50mm"
    with Server(program, lens) as server, Browser(chromium, driver) as browser:
        browser.driver.set_script_timeout(600)
        browser.open(server.url)
        gaps = [int(pin["path"].split("[")[1].split("]")[0]) for pin in browser.session()["pins"]]
        times = []
        for i in range(moves):
            times.append(browser.driver.execute_async_script(MOVE, gaps[i % len(gaps)], 460 + (i * 29) % 80))
        print(f"load of the machine {os.getloadavg()[0]:.1f}, {os.cpu_count()} processors")
        print(f"{lens}, air gaps behind surfaces {', '.join(map(str, gaps))}, {moves} moves: from the event to the painted frame")
        for stage in ["rays", "psf", "plot", "preview"]:
            values = sorted(each[stage] for each in times if stage in each)
            if values:
                print(f"  {stage:8} median {statistics.median(values):7.1f} ms, nine of ten within {values[int(0.9 * (len(values) - 1))]:7.1f} ms")
        columns = [int(each["columns"]) for each in times]
        print("  previews of", ", ".join(f"{width} pixels across ({columns.count(width)})" for width in sorted(set(columns))))
        browser.settle()
        print("the full picture, on the server:", browser.run("return window.petzvalPage.times.get('picture')"), "ms")
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
