// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/pbrt/scene_description.h>

#include <filesystem>

namespace petzval::render {

void Unsupported::report(const Location& at, const std::string& what) {
  if (!collect_) throw scene_error(at, what + " is not supported (`list_unsupported` shows all such things)");
  list_.push_back({at, what});
}

void Unsupported::report_unused(const Parameters& parameters, const std::string& owner) {
  for (const Parameter* parameter : parameters.unused())
    report(parameter->at,
           fmt::format("the parameter \"{} {}\" of {}", parameter->type, parameter->name, owner));
}

std::string resolved_path(const Location& at, const std::string& name) {
  const std::filesystem::path path(name);
  if (path.is_absolute() || !at.file) return name;
  return (std::filesystem::path(*at.file).parent_path() / path).string();
}

}  // namespace petzval::render
