# SPDX-License-Identifier: BSD-3-Clause
"""What pickle calls: it takes functions of Python modules only."""

from . import _petzval


def lens(*state):
    return _petzval._lens_from_state(*state)


def surface(*state):
    return _petzval._surface_from_state(*state)


def camera(*state):
    return _petzval._camera_from_state(*state)


def raw(*state):
    return _petzval._raw_from_bytes(*state)


def light(*state):
    return _petzval._light_from_state(*state)


def picture(*state):
    return _petzval.Picture(*state)
