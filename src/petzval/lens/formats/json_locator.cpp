// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/lens/formats/json_document.h>
#include <petzval/lens/formats/json_locator.h>

#include <algorithm>
#include <cctype>
#include <iterator>

namespace petzval {

namespace {

using nlohmann::json;

// No lens comes near these; what does is an accident or an attack.
constexpr std::size_t deepest_nesting = 16;
constexpr std::size_t most_entries = 200'000;
/// Reads the text for the parser and lets others see how far it has come.
class WatchedIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  WatchedIterator(const char* at, const char** furthest) : at_(at), furthest_(furthest) {}
  reference operator*() const { return *at_; }
  WatchedIterator& operator++() {
    *furthest_ = ++at_;
    return *this;
  }
  WatchedIterator operator++(int) {
    WatchedIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const WatchedIterator& other) const { return at_ == other.at_; }
  bool operator!=(const WatchedIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  const char** furthest_;
};

/// The line of the last visible character in front of `end`, counted on from where it was asked before.
class LineCounter {
 public:
  explicit LineCounter(std::string_view text) : text_(text) {}
  int line_before(std::size_t end) {
    while (end > 0 && std::isspace(static_cast<unsigned char>(text_[end - 1]))) --end;
    if (end < counted_) return line_;  // the parser has looked one token ahead; the line cannot be lower
    line_ += static_cast<int>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(counted_),
                                         text_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
    counted_ = end;
    return line_;
  }

 private:
  std::string_view text_;
  std::size_t counted_ = 0;
  int line_ = 1;
};

/// "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error …" without its first two
/// parts.
std::string plain_message(const std::string& what) {
  std::size_t start = what.find("] ");
  start = start == std::string::npos ? 0 : start + 2;
  if (what.compare(start, 11, "parse error") == 0) {
    const std::size_t colon = what.find(": ", start);
    if (colon != std::string::npos) start = colon + 2;
  }
  constexpr std::size_t longest = 200;
  std::string message = what.substr(start, longest);
  std::replace_if(
      message.begin(), message.end(), [](unsigned char c) { return c < ' ' || c > '~'; }, '?');
  return message;
}

/// Receives the parser's events. See nlohmann::json_sax for the interface.
class Locator {
 public:
  Locator(std::string_view text, const std::string& file, const char* const* furthest)
      : text_(text), file_(file), furthest_(furthest), lines_(text) {}
  LocatedJson take() { return std::move(result_); }

  bool null() { return add(nullptr) != nullptr; }
  bool boolean(bool value) { return add(value) != nullptr; }
  bool number_integer(json::number_integer_t value) { return add(value) != nullptr; }
  bool number_unsigned(json::number_unsigned_t value) { return add(value) != nullptr; }
  bool string(std::string& value) { return add(std::move(value)) != nullptr; }
  bool binary(json::binary_t&) { return false; }
  bool number_float(double value, const std::string& digits) {
    add(value);
    if (is_beyond_double(digits)) result_.long_numbers[path_of_last_] = digits;
    return true;
  }
  bool key(std::string& name) {
    Level& level = levels_.back();
    if (level.container->contains(name))
      throw InputError(file_, line(),
                       quotable(member_path(level.path, name)) + " is there twice; give it once");
    level.key = std::move(name);
    return true;
  }
  bool start_object(std::size_t) { return open(json::object()); }
  bool start_array(std::size_t) { return open(json::array()); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) {
    LineCounter counter(text_);
    throw InputError(file_, counter.line_before(std::min(position, text_.size())),
                     "is not JSON: " + plain_message(error.what()));
  }

 private:
  struct Level {
    json* container;
    std::string path, key;
  };

  int line() { return lines_.line_before(static_cast<std::size_t>(*furthest_ - text_.data())); }

  json* add(json value) {
    if (++entries_ > most_entries)
      throw InputError(file_, line(), fmt::format("has more than {} entries; no lens has", most_entries));
    json* place = &result_.root;
    path_of_last_.clear();
    if (!levels_.empty()) {
      Level& level = levels_.back();
      const bool in_array = level.container->is_array();
      path_of_last_ =
          in_array ? item_path(level.path, level.container->size()) : member_path(level.path, level.key);
      if (in_array) level.container->push_back(nullptr);
      place = in_array ? &level.container->back() : &(*level.container)[level.key];
    }
    *place = std::move(value);
    result_.lines[path_of_last_] = line();
    return place;
  }
  bool open(json container) {
    if (levels_.size() >= deepest_nesting)
      throw InputError(file_, line(),
                       fmt::format("is nested more than {} deep; no lens is", deepest_nesting));
    json* place = add(std::move(container));
    levels_.push_back({place, path_of_last_, {}});
    return true;
  }
  bool close() {
    levels_.pop_back();
    return true;
  }

  std::string_view text_;
  const std::string& file_;
  const char* const* furthest_;
  LineCounter lines_;
  LocatedJson result_;
  std::vector<Level> levels_;  // pointers stay good: only the innermost container grows
  std::string path_of_last_;
  std::size_t entries_ = 0;
};

}  // namespace

LocatedJson parse_located_json(std::string_view text, const std::string& file) {
  const char* furthest = text.data();
  Locator locator(text, file, &furthest);
  json::sax_parse(WatchedIterator(text.data(), &furthest),
                  WatchedIterator(text.data() + text.size(), &furthest), &locator);
  return locator.take();
}

}  // namespace petzval
