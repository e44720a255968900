// SPDX-License-Identifier: BSD-3-Clause
// A CODE V command file as commands, before any of them is understood.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace petzval {

struct SeqCommand {
  int line = 0;
  /// In upper case, of its first three letters, which are all that counts: "TIT". Of a surface "S", "SO",
  /// "SI" or "S12". The name of a private glass stands here as it is.
  std::string name;
  std::vector<std::string> words;  ///< what follows, without quotes

  bool has(std::size_t i) const { return i < words.size(); }
};

/// Comments begin with "!", "&" at the end of a line continues it, ";" parts the commands of one line, and
/// texts stand in single or double quotes.
std::vector<SeqCommand> seq_commands(const std::string& text);

/// What "S3", "SO", "SI" or "S" stands for.
struct SeqSurfaceName {
  enum class Kind { next, object, image, numbered } kind;
  int number = 0;
};
std::optional<SeqSurfaceName> seq_surface_name(const std::string& word);

}  // namespace petzval
