// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/glass/packed_catalogue.h>
#include <petzval/lens/formats/seq_commands.h>

#include <algorithm>

namespace petzval {

namespace {

bool is_quote(char c) {
  return c == '\'' || c == '"';
}

/// Splits one line into commands and words; whether the last of them goes on on the next line.
class LineSplitter {
 public:
  LineSplitter(const TextLine& line, std::vector<SeqCommand>& commands, bool continued)
      : line_(line.number), text_(line.text), commands_(commands), fresh_(!continued) {}

  bool split() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '!') break;
      if (c == ';') {
        fresh_ = true;
        ++at_;
      } else if (is_rest_blank_after_ampersand(at_)) {
        return true;
      } else if (is_quote(c)) {
        add(quoted());
      } else if (c == ' ' || c == '\t' || c == '\0' || c == '\f' || c == '\v') {
        ++at_;
      } else {
        add(plain());
      }
    }
    return false;
  }

 private:
  bool is_rest_blank_after_ampersand(std::size_t at) const {
    if (text_[at] != '&') return false;
    const std::string rest = trimmed(std::string_view(text_).substr(at + 1));
    return rest.empty() || rest.front() == '!';
  }
  std::string quoted() {
    const char quote = text_[at_++];
    const std::size_t end = std::min(text_.find(quote, at_), text_.size());
    const std::string word = text_.substr(at_, end - at_);
    at_ = std::min(end + 1, text_.size());
    return word;
  }
  std::string plain() {
    std::size_t end = std::min(text_.find_first_of(" \t\f\v;!'\"", at_ + 1), text_.size());
    // "650.0&": the line goes on, though no blank says so.
    if (end - at_ > 1 && text_[end - 1] == '&' && is_rest_blank_after_ampersand(end - 1)) --end;
    const std::string word = text_.substr(at_, end - at_);
    at_ = end;
    return word;
  }
  void add(std::string word) {
    if (fresh_ || commands_.empty()) {
      commands_.push_back({line_, std::move(word), {}});
    } else {
      commands_.back().words.push_back(std::move(word));
    }
    fresh_ = false;
  }

  int line_;
  const std::string& text_;
  std::vector<SeqCommand>& commands_;
  bool fresh_;
  std::size_t at_ = 0;
};

}  // namespace

std::optional<SeqSurfaceName> seq_surface_name(const std::string& word) {
  using Kind = SeqSurfaceName::Kind;
  const std::string upper = upper_case(word);
  if (upper.empty() || upper[0] != 'S') return {};
  const std::string rest = upper.substr(1);
  if (rest.empty()) return SeqSurfaceName{Kind::next};
  if (rest == "O" || rest == "0") return SeqSurfaceName{Kind::object};
  if (rest == "I") return SeqSurfaceName{Kind::image};
  if (rest.find_first_not_of("0123456789") != rest.npos) return {};
  const auto number = parse_integer(rest);
  if (!number) return {};
  return SeqSurfaceName{Kind::numbered, *number};
}

std::vector<SeqCommand> seq_commands(const std::string& text) {
  std::vector<SeqCommand> commands;
  bool continued = false, private_glasses = false;
  for (const TextLine& line : text_lines(text)) {
    const std::size_t before = commands.size();
    continued = LineSplitter(line, commands, continued).split();
    for (std::size_t i = before; i < commands.size(); ++i) {
      constexpr std::size_t letters_that_count = 3;
      const std::string name = upper_case(commands[i].name.substr(0, letters_that_count));
      if (name == "PRV") private_glasses = true;
      if (name == "END") private_glasses = false;
      const bool is_glass = private_glasses && name != "PRV" && name != "PWL";
      if (seq_surface_name(commands[i].name)) {
        if (!is_glass) commands[i].name = upper_case(commands[i].name);
      } else if (!is_glass) {
        commands[i].name = name;
      }
    }
  }
  return commands;
}

}  // namespace petzval
