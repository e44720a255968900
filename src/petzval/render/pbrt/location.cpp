// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/pbrt/location.h>

namespace petzval::render {

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

std::string Location::text() const {
  const std::string name = file ? *file : std::string("scene");
  if (!path) return fmt::format("{}:{}:{}", name, line, column);
  return path->empty() ? name : fmt::format("{}: {}", name, one_line(*path));
}

InputError scene_error(const Location& at, const std::string& message) {
  if (at.path) return InputError(at.text(), one_line(message));
  return InputError(at.file ? *at.file : "scene", at.line, at.column, one_line(message));
}

}  // namespace petzval::render
