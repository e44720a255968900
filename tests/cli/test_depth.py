# SPDX-License-Identifier: BSD-3-Clause
"""Scenes with depth: maps from files, focus, layers, bad maps."""
import array
import json
import math
import struct
import unittest

from petzval_cli import CliTest, run  # noqa: F401


if __name__ == "__main__":
    unittest.main()
