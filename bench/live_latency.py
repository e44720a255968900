# SPDX-License-Identifier: BSD-3-Clause
"""How soon the page of petzval live follows the hand, and what the server's memory does.

    live_latency.py PROGRAM CHROMIUM CHROMEDRIVER [MOVES [LENS]]

Moves the air gaps of a lens in turn. From each input event to the frame that paints what came of it: rays, point spread and plot,
preview; each move waits for the preview of the one before. A frame counts as painted when the browser calls back after the one in
which the page was altered. Then 900 quick moves without waiting, and the server's resident memory after 100 and after 1,000.
"""

import pathlib
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests" / "browser"))
from live_browser import Browser, Server  # noqa: E402

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
  if (message.kind === "picture" && message.quality === "preview") painted("preview");
};
const slider = document.querySelector(`[data-slider="surfaces[${gap}].thickness_mm"]`);
slider.value = to;
const began = performance.now();
slider.dispatchEvent(new Event("input"));
"""
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


def resident_mb(process):
    for line in pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines():
        if line.startswith("VmRSS"):
            return int(line.split()[1]) / 1024
    return float("nan")


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
        print(f"{lens}, air gaps behind surfaces {', '.join(map(str, gaps))}, {moves} moves: from the event to the painted frame")
        for stage in ["rays", "psf", "plot", "preview"]:
            values = sorted(each[stage] for each in times if stage in each)
            if values:
                print(f"  {stage:8} median {statistics.median(values):7.1f} ms, nine of ten within {values[int(0.9 * (len(values) - 1))]:7.1f} ms")
        browser.settle()
        print("the full picture, on the server:", browser.run("return window.petzvalPage.times.get('picture')"), "ms")
        few = resident_mb(server.process)
        browser.driver.execute_async_script(SWEEP, gaps, 1000 - moves)
        browser.settle()
        print(f"memory of the server: {few:.0f} MB after {moves} moves, {resident_mb(server.process):.0f} MB after 1,000")


if __name__ == "__main__":
    main()
