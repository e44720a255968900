# SPDX-License-Identifier: BSD-3-Clause
"""One function at many points."""

import itertools


def sweep(function, /, *, progress=None, **values):
    """Calls `function` with every combination of keyword values, the last keyword fastest:

        pz.sweep(lambda gap_mm: ..., gap_mm=[0.4, 0.5, 0.6])

    Gives a list of dicts: the keywords of the point and its `result`. `progress(fraction, what)` may return False to
    stop, which raises Cancelled. What `function` raises ends the sweep.
    """
    from ._errors import Cancelled
    names = list(values)
    points = list(itertools.product(*(list(values[name]) for name in names)))
    done = []
    for number, point in enumerate(points):
        if progress is not None and progress(number / len(points), "sweep") is False:
            raise Cancelled("the work was stopped")
        keywords = dict(zip(names, point))
        done.append({**keywords, "result": function(**keywords)})
    return done
