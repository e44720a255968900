// SPDX-License-Identifier: BSD-3-Clause
// Text files as numbered lines of words, whatever they are encoded in.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace petzval {

struct TextLine {
  int number = 0;  ///< from 1
  std::string text;
  std::vector<std::string> words;  ///< separated by blanks; "a quoted text" is one word, without its quotes
};

/// UTF-16 (either order, with or without a byte order mark), UTF-8 and, failing that, Latin-1, as UTF-8.
std::string decoded_text(std::string_view bytes);

/// Lines end with \n, \r\n or \r; the last one needs no end.
std::vector<TextLine> text_lines(std::string_view text);

std::vector<std::string> split_words(std::string_view text);
/// The parts between marks, empty ones too; one for a text without a mark.
std::vector<std::string> split_at(std::string_view text, char mark);
/// Without blanks at either end.
std::string trimmed(std::string_view text);
/// A text from a file, fit to stand in an error message: at most 60 characters, none of them for control.
std::string quotable(std::string_view text);

}  // namespace petzval
