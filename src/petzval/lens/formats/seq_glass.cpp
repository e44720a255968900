// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/glass/packed_catalogue.h>
#include <petzval/lens/formats/seq_glass.h>

#include <algorithm>
#include <cctype>

namespace petzval {

namespace {

bool all_digits(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
}

constexpr std::size_t digits_of_a_code = 6, fewest_digits = 3;

}  // namespace

std::optional<Material::Model> fictitious_glass(const std::string& word) {
  if (const std::size_t colon = word.find(':'); colon != word.npos) {
    const auto nd = parse_number(word.substr(0, colon)), vd = parse_number(word.substr(colon + 1));
    if (!nd || !vd) return {};
    return Material::Model{*nd, *vd};
  }
  const std::size_t point = word.find('.');
  std::string nd, vd;
  if (point == word.npos) {
    if (word.size() != digits_of_a_code) return {};
    nd = word.substr(0, fewest_digits), vd = word.substr(fewest_digits);
  } else {
    nd = word.substr(0, point), vd = word.substr(point + 1);
  }
  constexpr std::size_t most_digits = 20;
  if (!all_digits(nd) || !all_digits(vd) || nd.size() < fewest_digits || vd.size() < fewest_digits ||
      nd.size() > most_digits || vd.size() > most_digits)
    return {};
  return Material::Model{*parse_number("1." + nd), *parse_number(vd.substr(0, 2) + "." + vd.substr(2))};
}

std::string fictitious_glass_text(const Material::Model& model) {
  if (!(model.nd < 2))
    throw InputError(fmt::format("the fictitious glass of nd {}; it must be below 2", model.nd));
  if (!(model.vd < 100))
    throw InputError(fmt::format("the fictitious glass of Vd {}; it must be below 100", model.vd));
  if (model.dpgf != 0)
    throw InputError("a fictitious glass off the normal line of partial dispersion; dpgf must be 0");
  // Digits of the shortest decimals that read back as the same doubles, without exponents.
  const auto digits = [](double value, std::size_t before) {
    std::string text = fmt::format("{}", value);
    if (text.find('e') != text.npos)
      throw InputError(fmt::format("a fictitious glass with the number {}", value));
    const std::size_t point = std::min(text.find('.'), text.size());
    std::string all = std::string(before - std::min(before, point), '0') + text.substr(0, point);
    all += point < text.size() ? text.substr(point + 1) : "";
    return all + std::string(all.size() < before + 1 ? before + 1 - all.size() : 0, '0');
  };
  std::string nd = digits(model.nd, 1).substr(1), vd = digits(model.vd, 2);
  nd.resize(std::max(nd.size(), fewest_digits), '0');
  vd.resize(std::max(vd.size(), fewest_digits), '0');
  return nd + "." + vd;
}

Material seq_glass(const std::string& word, const PrivateGlasses& own, GlassLookup& glasses) {
  if (word.empty() || upper_case(word) == "AIR") return Material();
  if (glasses.is_substituted(word)) return glasses.find(word);
  if (const auto found = own.find(upper_case(word)); found != own.end()) return found->second;
  if (const auto model = fictitious_glass(word)) return Material(*model);
  if (parse_number(word))
    throw InputError(
        fmt::format("{} is not a glass; a fictitious one is written like 517.642, for nd 1.517 and Vd 64.2",
                    quotable(word)));
  const std::size_t underscore = word.rfind('_');
  if (underscore == word.npos) return glasses.find_squeezed(word, "");
  return glasses.find_squeezed(word.substr(0, underscore), word.substr(underscore + 1));
}

std::string seq_glass_name(const Glass& glass) {
  std::string name;
  for (const char c : upper_case(glass.name))
    if (std::isalnum(static_cast<unsigned char>(c))) name += c;
  // The bundled catalogue tells which names a reader would confuse; it does not know the user's own.
  std::size_t alike = 0;
  for (const std::string& full : GlassCatalogue::bundled().names_spelled(name))
    alike += full.substr(0, full.find(':')) == glass.catalogue && full != glass.full_name();
  if (name.empty() || alike > 0)
    throw InputError(fmt::format("the glass {}, whose letters and digits alone do not tell it from others",
                                 glass.full_name()));
  return name + "_" + glass.catalogue;
}

}  // namespace petzval
