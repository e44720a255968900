// SPDX-License-Identifier: BSD-3-Clause
// A YAML text as a tree, by libyaml.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace petzval {

/// A scalar, a list or a mapping, with its line.
struct YamlNode {
  enum class Kind { scalar, list, mapping } kind = Kind::scalar;
  int line = 0;
  std::string text;               ///< of a scalar
  std::vector<std::string> keys;  ///< of a mapping, one an item
  std::vector<YamlNode> items;    ///< of a list or a mapping

  /// The item of that key; null if there is none or this is no mapping.
  const YamlNode* find(std::string_view key) const;
};

/// The one document of a text; an empty one gives an empty scalar. Aliases, keys that are no scalars and
/// nesting beyond what a glass file has are refused. \throws InputError with file and line.
YamlNode parse_yaml(std::string_view text, const std::string& file);

}  // namespace petzval
