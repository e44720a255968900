# SPDX-License-Identifier: BSD-3-Clause
"""What notebooks show."""

import os
import tempfile


class Svg(str):
    """A drawing as SVG text, which notebooks show."""

    def _repr_svg_(self):
        return str(self)

    def save(self, path):
        """Writes the text to a file."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self)


def png_bytes(write):
    """The bytes of the PNG file that `write(path)` writes."""
    with tempfile.TemporaryDirectory(prefix="petzval-") as folder:
        path = os.path.join(folder, "picture.png")
        write(path)
        with open(path, "rb") as file:
            return file.read()
