// SPDX-License-Identifier: BSD-3-Clause
// Calls of classes that fit no constructor say what would be right.
#pragma once

#include <nanobind/nanobind.h>

namespace petzval::python {

/// For nb::class_ with nb::new_: a misfit is explained by petzval._keywords, as those of functions are.
extern const PyType_Slot explained_constructor[];

}  // namespace petzval::python
