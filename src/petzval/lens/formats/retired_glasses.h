// SPDX-License-Identifier: BSD-3-Clause
// Names of glasses that are made no more, or that files shorten, and what stands in for them.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace petzval {

struct RetiredGlass {
  std::string_view name;       ///< letters and digits alone, upper case
  double nd, vd;               ///< as its maker printed them; Vd 0: not known
  std::string_view successor;  ///< "SCHOTT:N-BK7"; empty: none comes near, nd and Vd stand for it
};

/// All that are known, by name.
std::span<const RetiredGlass> retired_glasses();

/// By letters and digits, whatever stands between them and whatever their case.
std::optional<RetiredGlass> find_retired_glass(std::string_view name);

}  // namespace petzval
