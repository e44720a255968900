// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "bind.h"
#include "call.h"

namespace petzval::python {

/// "angle_deg", "object_height_mm", … \throws InputError for another word.
Fields::Kind field_kind_of(std::string_view word);

}  // namespace petzval::python
