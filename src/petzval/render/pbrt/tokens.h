// SPDX-License-Identifier: BSD-3-Clause
// The words of a pbrt scene file.
#pragma once

#include <petzval/render/pbrt/location.h>

#include <optional>
#include <string>
#include <string_view>

namespace petzval::render {

struct Token {
  enum class Kind { word, quoted, open, close };
  Kind kind = Kind::word;
  std::string_view text;  ///< without the quotes; a view of the file's text
  int line = 0, column = 0;
};

/// Splits the text of one file into words, "quoted strings" and brackets; '#' begins a comment.
class Tokens {
 public:
  /// \param text  must outlive this. \param file  for messages.
  Tokens(std::string_view text, std::shared_ptr<const std::string> file);

  /// Nothing at the end. \throws InputError with line and column for a string that does not end on its line.
  std::optional<Token> next();
  /// The next token without taking it.
  const std::optional<Token>& peek();

  Location location(const Token& token) const { return {file_, token.line, token.column}; }
  /// Where the text ends.
  Location end() const { return {file_, line_, column()}; }

 private:
  std::optional<Token> read();
  void skip_space();
  int column() const { return static_cast<int>(at_ - line_start_) + 1; }

  std::string_view text_;
  std::shared_ptr<const std::string> file_;
  std::size_t at_ = 0, line_start_ = 0;
  int line_ = 1;
  std::size_t tokens_ = 0;  ///< read so far
  std::optional<Token> peeked_;
  bool has_peeked_ = false;
};

}  // namespace petzval::render
