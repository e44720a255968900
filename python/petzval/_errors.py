# SPDX-License-Identifier: BSD-3-Clause
"""What goes wrong, and what there is to say."""

import os
import re
import sys


class Error(Exception):
    """Base of every exception that Petzval raises on purpose."""


class InputError(Error, ValueError):
    """What was given is wrong.

    Attributes: `problem` (what is wrong), `remedy` (what would be right; may be empty), `file`, `line`, `column`
    (None where there is none), `parameter` (the keyword argument or attribute at fault, or None).
    """

    def __init__(self, problem, remedy="", file=None, line=None, column=None, parameter=None):
        self.problem, self.remedy = problem, remedy
        self.file, self.line, self.column, self.parameter = file, line, column, parameter
        place = "".join(f"{part}:" for part in (file, line, column) if part is not None)
        super().__init__((place and place + " ") + problem + (remedy and "; " + remedy))

    def __reduce__(self):
        return InputError, (self.problem, self.remedy, self.file, self.line, self.column, self.parameter)


class CallError(InputError, TypeError):
    """A call fits no signature: a keyword is mistyped, an argument is missing or of another type.

    Attributes: those of InputError; `parameter` is the argument at fault.
    """

    def __reduce__(self):
        return CallError, super().__reduce__()[1]


class Failure(Error, OSError):
    """The input was right, but the work could not be done: a full disk, no memory."""


class Cancelled(Error):
    """The progress callback said stop. Files are as they were before the work began."""


class Note(UserWarning):
    """Something that the user should know: what was chosen where nothing was said, light that leaves the frame."""


# Parameters of the library that Python calls otherwise.
_KEYWORDS = {"focus_spp": "samples_per_pixel", "losses": "fresnel, coating or absorption", "matrix": "colours",
             "set": "settings", "substitute": "substitutions", "sun": "suns", "sun_diameter_deg": "diameter_deg",
             "sun_light": "light", "wavelength": "wavelengths_nm"}


def keyword(parameter):
    """The keyword argument for a parameter of the library: `scene.distance_m` is `distance_m` of a SceneRequest."""
    return _KEYWORDS.get(parameter, parameter.rpartition(".")[2])


def with_keywords(text):
    """A text of the library with Python's names for its parameters."""
    return re.sub(r"`([a-z][a-z0-9_.]*)`", lambda match: f"`{keyword(match[1])}`", text)


def _input_error(file, line, column, problem, remedy, parameter):
    """Of the parts of the library's error, where what is not known is empty or 0."""
    return InputError(with_keywords(problem), with_keywords(remedy), file or None, line or None, column or None,
                      keyword(parameter) if parameter else None)


for _each in (Error, InputError, CallError, Failure, Cancelled, Note):
    _each.__module__ = "petzval"  # where users find them


def frames_to_caller():
    """How many frames up the code stands that called this package: the line that a Note names."""
    frame, level = sys._getframe().f_back, 1
    while frame is not None and os.path.dirname(frame.f_code.co_filename) == os.path.dirname(__file__):
        frame, level = frame.f_back, level + 1
    return level
