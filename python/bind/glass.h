// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include "bind.h"

namespace petzval::python {

/// A Glass, the name of one, or None for air.
Material material_from(const nb::object& glass);

}  // namespace petzval::python
