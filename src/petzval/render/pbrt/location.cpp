// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/pbrt/location.h>

namespace petzval::render {

std::string Location::text() const {
  return fmt::format("{}:{}:{}", file ? *file : std::string("scene"), line, column);
}

namespace {

/// Names from a scene may hold anything, also line ends and a megabyte of text.
std::string one_line(std::string text) {
  constexpr std::size_t longest = 600;
  if (text.size() > longest) text = text.substr(0, longest) + " …";
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
  return text;
}

}  // namespace

InputError scene_error(const Location& at, const std::string& message) {
  return InputError(fmt::format("{}: {}", at.text(), one_line(message)));
}

}  // namespace petzval::render
