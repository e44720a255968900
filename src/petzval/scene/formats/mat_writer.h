// SPDX-License-Identifier: BSD-3-Clause
// MATLAB files of one variable.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace petzval {

/// Double-precision numbers in MATLAB's order (the first index runs fastest).
struct MatDoubles {
  std::vector<std::size_t> dimensions;
  std::vector<double> values;
};

/// A value to be written: text, numbers, or a 1 × 1 struct of named values.
struct MatItem {
  using Fields = std::vector<std::pair<std::string, MatItem>>;
  std::variant<std::string, MatDoubles, Fields> value;

  static MatItem number(double value) { return {MatDoubles{{1, 1}, {value}}}; }
  /// n × 1.
  static MatItem column(std::vector<double> values) {
    const std::size_t size = values.size();
    return {MatDoubles{{size, 1}, std::move(values)}};
  }
};

/// A MAT file of version 5, packed, without a date: the same values give the same bytes. Whole or not at all.
/// \throws InputError if the path is no good, or the variable larger than the 2 GiB that the format holds;
/// Failure.
void write_mat(const std::string& path, const std::string& name, const MatItem& item);

}  // namespace petzval
