# SPDX-License-Identifier: BSD-3-Clause
"""What objects answer to numpy.asarray()."""

import numpy


def array(view, dtype, copy):
    """`view`, as NumPy's protocol __array__ wants it: another type is a copy, which `copy` False forbids."""
    if dtype is not None and numpy.dtype(dtype) != view.dtype:
        if copy is False:
            raise ValueError(f"another type than {view.dtype} takes a copy")
        return view.astype(dtype)
    return view.copy() if copy else view
