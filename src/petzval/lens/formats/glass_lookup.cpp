// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/glass/catalogue.h>
#include <petzval/glass/packed_catalogue.h>
#include <petzval/lens/formats/glass_lookup.h>
#include <petzval/lens/formats/number_text.h>
#include <petzval/lens/formats/text_lines.h>

namespace petzval {

namespace {

/// "1.61025/56.71": nd and Vd of a glass that no catalogue has.
std::optional<Material> model_glass(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return {};
  const auto nd = parse_number(text.substr(0, slash)), vd = parse_number(text.substr(slash + 1));
  if (!nd || !vd) return {};
  return Material(Material::Model{*nd, *vd});
}

Material catalogue_glass(const std::string& name, const std::vector<std::string>& preferred) {
  constexpr std::size_t longest_name = 60;
  if (name.empty() || name.size() > longest_name || quotable(name) != name)
    throw InputError(fmt::format("\"{}\" is not the name of a glass", quotable(name)));
  return Material(GlassCatalogue::bundled().find(name, preferred));
}

std::optional<std::string> substitute(const std::string& name, const LensReadOptions& options) {
  for (const auto& [from, to] : options.substitutions)
    if (upper_case(from) == upper_case(name)) return to;
  return {};
}

}  // namespace

bool is_substituted(const std::string& name, const LensReadOptions& options) {
  return substitute(name, options).has_value();
}

Material find_glass(const std::string& name, const LensReadOptions& options,
                    const std::vector<std::string>& preferred) {
  const std::string wanted = substitute(name, options).value_or(name);
  const auto model = wanted == name ? std::nullopt : model_glass(wanted);
  return model ? *model : catalogue_glass(wanted, preferred);
}

}  // namespace petzval
