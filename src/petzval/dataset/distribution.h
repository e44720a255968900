// SPDX-License-Identifier: BSD-3-Clause
// How a parameter of a data set is drawn for each of its items.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace petzval {

/// What a parameter is for one item: a number or a name.
using ParameterValue = std::variant<double, std::string>;

/// The distribution of one parameter over the items of a data set. Every value is a function of one uniform
/// number, so that no parameter's draw depends on another's.
struct Distribution {
  enum class Kind {
    choose,       ///< one of `values`, by `weights`; a constant is a choice of one
    uniform,      ///< from `from` to `to`
    log_uniform,  ///< its logarithm is uniform
    normal,       ///< mean `from`, standard deviation `to`; cut off at `least` and `most`, not clamped
    integer       ///< whole numbers from `from` to `to`, both included
  };
  Kind kind = Kind::choose;
  std::vector<ParameterValue> values = {};
  std::vector<double> weights = {};  ///< positive; empty: all alike
  double from = 0, to = 0;
  double least = 0, most = 0;  ///< of Kind::normal

  static Distribution constant(ParameterValue value) { return {.values = {std::move(value)}}; }
  bool is_constant() const { return kind == Kind::choose && values.size() == 1; }

  /// \param uniform  in (0, 1): the value below which that share of all items lies.
  ParameterValue at(double uniform) const;
};

}  // namespace petzval
