// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/pbrt/location.h>

namespace petzval::render {

std::string Location::text() const {
  return fmt::format("{}:{}:{}", file ? *file : std::string("scene"), line, column);
}

InputError scene_error(const Location& at, const std::string& message) {
  return InputError(fmt::format("{}: {}", at.text(), message));
}

}  // namespace petzval::render
