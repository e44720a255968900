// SPDX-License-Identifier: BSD-3-Clause
// A small reader of markup, written apart from the writer under test: says what is wrong with a document.
#pragma once

#include <algorithm>
#include <cctype>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace petzval::test {

enum class Markup { xml, html };

/// Walks through a document once; `fault` stays empty while it is well-formed.
class MarkupChecker {
 public:
  MarkupChecker(std::string_view text, Markup kind) : text_(text), kind_(kind) {
    while (fault.empty() && at_ < text_.size()) text_[at_] == '<' ? read_tag() : read_content();
    if (fault.empty() && !open_.empty()) fault = "<" + open_.back() + "> is never closed";
    if (fault.empty() && roots_ != 1) fault = std::to_string(roots_) + " root elements";
  }
  std::string fault;

 private:
  bool is_void(const std::string& tag) const {
    return kind_ == Markup::html &&
           (tag == "meta" || tag == "img" || tag == "input" || tag == "br" || tag == "link");
  }
  void read_content() {
    const bool raw = kind_ == Markup::html && !open_.empty() && open_.back() == "style";
    const std::size_t end = std::min(text_.find('<', at_), text_.size());
    if (!raw) check_text(text_.substr(at_, end - at_));
    if (open_.empty() && text_.substr(at_, end - at_).find_first_not_of(" \n\t\r") != std::string_view::npos)
      fault = "text outside the root element";
    at_ = end;
  }
  /// Every & must begin an entity that XML knows by itself, or a character number.
  void check_text(std::string_view text) {
    for (std::size_t i = text.find('&'); i != std::string_view::npos; i = text.find('&', i + 1)) {
      const std::string_view entity = text.substr(i + 1, text.find(';', i) - i - 1);
      const bool known = entity == "amp" || entity == "lt" || entity == "gt" || entity == "quot" ||
                         (entity.size() > 1 && entity[0] == '#');
      if (!known) fault = "a bare & before '" + std::string(text.substr(i, 12)) + "'";
    }
    for (const char c : text)
      if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' && c != '\r')
        fault = "a control character";
  }
  void read_tag() {
    if (text_.substr(at_, 2) == "<!" || text_.substr(at_, 2) == "<?") {
      at_ = text_.find('>', at_) + 1;
      return;
    }
    const bool closing = text_.substr(at_, 2) == "</";
    at_ += closing ? 2 : 1;
    const std::size_t begin = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0)) ++at_;
    const std::string tag(text_.substr(begin, at_ - begin));
    if (tag.empty()) {
      fault = "a bare <";
      return;
    }
    const bool empty_element = read_attributes();
    if (!fault.empty()) return;
    if (closing) {
      if (open_.empty() || open_.back() != tag)
        fault = "</" + tag + "> closes nothing";
      else
        open_.pop_back();
    } else {
      if (open_.empty()) ++roots_;
      if (!empty_element && !is_void(tag)) open_.push_back(tag);
    }
  }
  /// Up to and with the '>'; whether it was "/>".
  bool read_attributes() {
    std::vector<std::string> names;
    while (at_ < text_.size() && text_[at_] != '>') {
      if (text_.substr(at_, 2) == "/>") {
        at_ += 2;
        return true;
      }
      if (std::isspace(static_cast<unsigned char>(text_[at_])) != 0) {
        ++at_;
        continue;
      }
      const std::size_t equals = text_.find("=\"", at_);
      const std::size_t end = equals == std::string_view::npos ? equals : text_.find('"', equals + 2);
      if (end == std::string_view::npos) {
        fault = "an attribute without a quoted value";
        return false;
      }
      const std::string name(text_.substr(at_, equals - at_));
      if (name.find_first_of(" \n<>/\"") != std::string::npos) fault = "a bad attribute name '" + name + "'";
      if (std::find(names.begin(), names.end(), name) != names.end()) fault = "attribute " + name + " twice";
      names.push_back(name);
      const std::string_view value = text_.substr(equals + 2, end - equals - 2);
      if (value.find('<') != std::string_view::npos) fault = "a < in an attribute";
      check_text(value);
      at_ = end + 1;
      if (!fault.empty()) return false;
    }
    ++at_;
    return false;
  }

  std::string_view text_;
  Markup kind_;
  std::size_t at_ = 0;
  int roots_ = 0;
  std::vector<std::string> open_;
};

/// What is wrong with a document; empty if nothing is.
inline std::string markup_fault(std::string_view text, Markup kind = Markup::xml) {
  return MarkupChecker(text, kind).fault;
}

inline int occurrences(std::string_view text, std::string_view what) {
  int count = 0;
  for (std::size_t i = text.find(what); i != std::string_view::npos; i = text.find(what, i + what.size()))
    ++count;
  return count;
}

/// One start tag with its attributes and the text right behind it.
struct Element {
  std::map<std::string, std::string> attributes;
  std::string text;
  double number(const std::string& name) const { return std::stod(attributes.at(name)); }
};

/// All elements of a well-formed document with this tag ("" for any).
inline std::vector<Element> elements(std::string_view document, std::string_view tag) {
  std::vector<Element> found;
  const std::string start = "<" + std::string(tag);
  for (std::size_t i = document.find(start); i != std::string_view::npos; i = document.find(start, i + 1)) {
    std::size_t at = i + start.size();
    if (!tag.empty() && std::isalnum(static_cast<unsigned char>(document[at])) != 0) continue;
    Element element;
    while (document[at] != '>') {
      const std::size_t begin = document.find_first_not_of(" \n/", at);
      if (document[begin] == '>') break;
      const std::size_t equals = document.find("=\"", begin), close = document.find('>', begin);
      if (equals > close) {
        at = close;
        break;
      }
      const std::size_t end = document.find('"', equals + 2);
      element.attributes[std::string(document.substr(begin, equals - begin))] =
          document.substr(equals + 2, end - equals - 2);
      at = end + 1;
    }
    const std::size_t content = document.find('>', at) + 1;
    element.text = document.substr(content, document.find('<', content) - content);
    found.push_back(std::move(element));
  }
  return found;
}

/// Whether coordinates of a drawing hold something that is not a number.
inline bool has_non_finite_numbers(std::string_view svg) {
  for (const std::string_view word : {"nan", "NaN", "inf\"", "inf ", "-inf", "Infinity"})
    if (svg.find(word) != std::string_view::npos) return true;
  return false;
}

}  // namespace petzval::test
