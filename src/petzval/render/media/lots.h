// SPDX-License-Identifier: BSD-3-Clause
// Random numbers for walks of unknown length.
#pragma once

#include <petzval/numeric/sobol.h>

namespace petzval::render {

/// Numbers in [0, 1), as many as a walk takes.
class Lots {
 public:
  /// \param first  in [0, 1): the first of them, which all others depend on.
  explicit Lots(double first) : first_(first) {}
  double next() {
    if (count_++ == 0) return first_;
    return hashed(static_cast<std::uint32_t>(first_ * 0x1p32), count_) * 0x1p-32;
  }

 private:
  double first_;
  std::uint32_t count_ = 0;
};

}  // namespace petzval::render
