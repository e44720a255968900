# SPDX-License-Identifier: BSD-3-Clause
"""petzval live from the command line; what its page does is tried by tests/live and tests/browser."""

import os
import re
import signal
import socket
import subprocess
import unittest
import urllib.error
import urllib.request

from petzval_cli import PROGRAM, ProgramTest

ADDRESS = re.compile(r"http://127\.0\.0\.1:(\d+)/#token=([0-9a-f]{32})\n")


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Live(ProgramTest):
    def address(self, *words, **options):
        done = self.petzval("live", "--check", *words, **options)
        self.assertEqual(done.returncode, 0, done.stderr)
        found = ADDRESS.fullmatch(done.stdout)
        self.assertIsNotNone(found, done.stdout)
        return int(found[1]), found[2]

    def test_prints_an_address_with_a_new_token(self):
        self.assertNotEqual(self.address()[1], self.address()[1])

    def test_keeps_the_token_of_a_port_for_the_user_alone(self):
        environment = dict(os.environ, XDG_RUNTIME_DIR=str(self.folder))
        port = free_port()
        first = self.address("--port", str(port), env=environment)
        self.assertEqual(first[0], port)
        self.assertEqual(self.address("--port", str(port), env=environment), first)
        file = self.folder / f"petzval-live-{port}.token"
        self.assertEqual(file.stat().st_mode & 0o777, 0o600)
        file.unlink()
        self.assertNotEqual(self.address("--port", str(port), env=environment), first)

    def test_refuses_what_it_cannot_show(self):
        self.assert_refused("live", "no-such-lens", "--check", words=("no-such-lens",))
        self.assert_refused("live", "--scene", "no-such-scene", "--check", words=("no-such-scene",))
        self.assert_refused("live", "--sensor", "no-such-sensor", "--check", words=("no-such-sensor",))
        self.assert_refused("live", "--port", "70000", "--check", words=("--port",))
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            self.assert_refused("live", "--port", str(taken.getsockname()[1]), "--check", words=("--port", "0 for one that is free"))

    def test_serves_until_it_is_interrupted(self):
        with subprocess.Popen([PROGRAM, "live", "tessar", "--no-open"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as server:
            url = server.stdout.readline().split("#")[0]
            with urllib.request.urlopen(url) as page:
                self.assertIn(b"<title>Petzval</title>", page.read())
            with self.assertRaises(urllib.error.HTTPError):
                urllib.request.urlopen(url + "etc/passwd")
            server.send_signal(signal.SIGINT)
            self.assertEqual(server.wait(), 130)
            self.assertIn("the bench is closed", server.stderr.read())


if __name__ == "__main__":
    unittest.main()
