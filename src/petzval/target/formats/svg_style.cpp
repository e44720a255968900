// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/target/formats/svg_style.h>

#include <algorithm>
#include <cctype>

namespace petzval {

namespace {

std::string_view without_blanks(std::string_view text) {
  const std::size_t from = text.find_first_not_of(" \t\n\r"), to = text.find_last_not_of(" \t\n\r");
  return from == std::string_view::npos ? std::string_view() : text.substr(from, to - from + 1);
}

/// Calls `use` with each part between the separators.
template <typename Use>
void for_parts(std::string_view text, char separator, const Use& use) {
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(separator, at), text.size());
    if (const std::string_view part = without_blanks(text.substr(at, end - at)); !part.empty()) use(part);
    at = end + 1;
  }
}

std::string without_comments(std::string_view css) {
  std::string text;
  for (std::size_t at = 0; at < css.size();) {
    const std::size_t open = std::min(css.find("/*", at), css.size());
    text += css.substr(at, open - at);
    const std::size_t close = open < css.size() ? css.find("*/", open + 2) : css.size();
    at = close == std::string_view::npos ? css.size() : std::min(css.size(), close + 2);
  }
  return text;
}

bool is_word(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) || c == '-' || c == '_' || c >= 128;
  });
}

}  // namespace

std::string declared(std::string_view declarations, std::string_view name) {
  std::string value;
  for_parts(declarations, ';', [&](std::string_view part) {
    const std::size_t colon = part.find(':');
    if (colon != std::string_view::npos && without_blanks(part.substr(0, colon)) == name)
      value = without_blanks(part.substr(colon + 1));
  });
  return value;
}

void SvgStyleSheet::add(std::string_view css) {
  const std::string text = without_comments(css);
  const std::string_view rest = text;
  for (std::size_t at = 0; !without_blanks(rest.substr(at)).empty();) {
    const std::size_t open = rest.find('{', at), close = rest.find('}', at);
    if (open == std::string_view::npos || close == std::string_view::npos || close < open)
      throw InputError("<style>: a rule `selector {property: value}` is not closed");
    const std::string_view declarations = rest.substr(open + 1, close - open - 1);
    for_parts(rest.substr(at, open - at), ',', [&](std::string_view selector) {
      Rule rule;
      rule.declarations = declarations;
      const std::size_t mark = selector.find_first_of(".#");
      const std::string_view element = selector.substr(0, mark),
                             name = mark == std::string_view::npos ? "" : selector.substr(mark + 1);
      if ((!element.empty() && element != "*" && !is_word(element)) ||
          (mark != std::string_view::npos && !is_word(name)))
        throw InputError(
            fmt::format("<style>: selector '{}': an element's name, .class, #id or both are right",
                        quotable(selector.substr(0, 40))));
      if (element != "*") rule.element = element;
      if (!name.empty()) (selector[mark] == '.' ? rule.group : rule.id) = name;
      rule.weight =
          (rule.id.empty() ? 0 : 100) + (rule.group.empty() ? 0 : 10) + (rule.element.empty() ? 0 : 1);
      rules_.push_back(std::move(rule));
    });
    at = close + 1;
  }
}

std::string SvgStyleSheet::property(std::string_view element, std::string_view id, std::string_view classes,
                                    std::string_view name) const {
  std::string value;
  int weight = -1;
  for (const Rule& rule : rules_) {
    bool fits = (rule.element.empty() || rule.element == element) && (rule.id.empty() || rule.id == id);
    if (fits && !rule.group.empty()) {
      fits = false;
      for_parts(classes, ' ', [&](std::string_view each) { fits = fits || each == rule.group; });
    }
    if (!fits || rule.weight < weight) continue;
    if (std::string said = declared(rule.declarations, name); !said.empty())
      value = std::move(said), weight = rule.weight;
  }
  return value;
}

}  // namespace petzval
