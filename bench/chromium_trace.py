# SPDX-License-Identifier: BSD-3-Clause
"""When Chromium presents its frames, as it reports that itself in its trace."""

import json
import threading
import urllib.request

import trio
import trio_websocket  # which Selenium brings

CATEGORIES = ["blink.user_timing", "devtools.timeline"]


class ChromiumTrace:
    """Traces a browser that Selenium drives while this is entered; `events` are there afterwards."""

    def __init__(self, driver):
        self.address = driver.capabilities["goog:chromeOptions"]["debuggerAddress"]
        self.begun, self.ended, self.events = threading.Event(), threading.Event(), []
        self.thread = threading.Thread(target=lambda: trio.run(self.collect))

    async def collect(self):
        with urllib.request.urlopen(f"http://{self.address}/json/version") as answer:
            url = json.load(answer)["webSocketDebuggerUrl"]
        async with trio_websocket.open_websocket_url(url, max_message_size=1 << 28) as socket:
            await socket.send_message(json.dumps({"id": 1, "method": "Tracing.start", "params": {
                "transferMode": "ReportEvents", "traceConfig": {"includedCategories": CATEGORIES, "excludedCategories": ["*"]}}}))
            while json.loads(await socket.get_message()).get("id") != 1:
                pass
            self.begun.set()
            await trio.to_thread.run_sync(self.ended.wait)
            await socket.send_message(json.dumps({"id": 2, "method": "Tracing.end"}))
            while True:
                message = json.loads(await socket.get_message())
                if message.get("method") == "Tracing.dataCollected":
                    self.events += message["params"]["value"]
                if message.get("method") == "Tracing.tracingComplete":
                    return

    def __enter__(self):
        self.thread.start()
        self.begun.wait()
        return self

    def __exit__(self, *_):
        self.ended.set()
        self.thread.join()

    def marks(self, prefix):
        """[name, time in ms] of the page's performance.mark() whose names begin with this, in order."""
        found = [(each["ts"] / 1000, each["name"]) for each in self.events if each.get("name", "").startswith(prefix)]
        return [(name.removeprefix(prefix), ms) for ms, name in sorted(found)]

    def presented_ms(self, ms):
        """When the frame that the page's main thread was making at this time came to be seen."""
        frames = [each for each in self.events if each.get("name") == "AnimationFrame" and each.get("ph") == "b"]
        frame = max((each for each in frames if each["ts"] / 1000 <= ms), key=lambda each: each["ts"])
        seen = [each["ts"] / 1000 for each in self.events
                if each.get("name") == "AnimationFrame::Presentation" and each["args"]["id"] == frame["args"]["id"]]
        return seen[0] if seen else float("nan")
