// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/lens/surface_kind.h>

#include <petzval/lens/shapes/added_kinds-inl.h>

#include <array>

namespace petzval {

namespace {

template <class... Kind>
std::array<SurfaceKind, sizeof...(Kind)> table_of(HWY_NAMESPACE::KindList<Kind...>) {
  return {SurfaceKind{Kind::name, Kind::is_round, Kind::parameters, &Kind::prepare}...};
}

}  // namespace

std::span<const SurfaceKind> surface_kinds() {
  static const auto table = table_of(HWY_NAMESPACE::AddedKinds());
  return table;
}

const SurfaceKind* find_surface_kind(std::string_view name) {
  for (const SurfaceKind& kind : surface_kinds())
    if (kind.name == name) return &kind;
  return nullptr;
}

std::string surface_kind_names() {
  std::vector<std::string_view> names;
  for (const SurfaceKind& kind : surface_kinds()) names.push_back(kind.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

const SurfaceKind& surface_kind(std::string_view name) {
  if (const SurfaceKind* found = find_surface_kind(name)) return *found;
  throw InputError(
      fmt::format("\"{}\" is not a kind of surface; these are: {}", quotable(name), surface_kind_names()));
}

std::vector<double> shape_numbers(const Surface& surface, const char* parameter) {
  if (!surface.shape) return {};
  const auto found = surface.shape->parameters.find(parameter);
  return found == surface.shape->parameters.end() ? std::vector<double>() : found->second;
}

}  // namespace petzval
