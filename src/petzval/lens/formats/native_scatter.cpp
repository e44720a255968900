// SPDX-License-Identifier: BSD-3-Clause
// Scatter in the native lens file (docs/FLARE.md).
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/number_text.h>
#include <petzval/lens/formats/native.h>

namespace petzval {

Scatter read_scatter(const JsonEntry& entry) {
  entry.allow_only(
      {"roughness_nm", "b0_per_sr", "l", "s", "wavelength_nm", "table", "dust_percent", "cleanliness_level"});
  Scatter scatter;
  const auto optional = [&](const char* key, const char* meaning) -> std::optional<double> {
    const auto found = entry.find(key);
    return found && !found->is_null() ? std::optional(found->number(meaning)) : std::nullopt;
  };
  scatter.roughness_nm = optional("roughness_nm", "an RMS roughness in nm");
  scatter.b0_per_sr = optional("b0_per_sr", "a BSDF in 1/sr");
  scatter.l = optional("l", "a difference of direction cosines").value_or(scatter.l);
  scatter.s = optional("s", "a slope, such as -1.5").value_or(scatter.s);
  scatter.wavelength_nm = optional("wavelength_nm", "a wavelength in nm").value_or(scatter.wavelength_nm);
  scatter.dust_percent = optional("dust_percent", "a share in per cent").value_or(0);
  scatter.cleanliness_level = optional("cleanliness_level", "a cleanliness level, such as 300");
  if (const auto table = entry.find("table"); table && !table->is_null())
    for (const JsonEntry& row : table->items("a list of [angle in degrees, BSDF in 1/sr]")) {
      const std::vector<JsonEntry> pair = row.items("[angle in degrees, BSDF in 1/sr]");
      if (pair.size() != 2) row.fail("must be [angle in degrees, BSDF in 1/sr]");
      scatter.table.emplace_back(pair[0].number("an angle in degrees"), pair[1].number("a BSDF in 1/sr"));
    }
  return scatter;
}

std::string scatter_text(const Scatter& scatter) {
  std::vector<std::string> entries;
  const auto add = [&](const char* key, double value) {
    entries.push_back(fmt::format("\"{}\": {}", key, number_text(value)));
  };
  const Scatter usual;
  if (scatter.roughness_nm) add("roughness_nm", *scatter.roughness_nm);
  if (scatter.b0_per_sr) add("b0_per_sr", *scatter.b0_per_sr);
  if (scatter.l != usual.l) add("l", scatter.l);
  if (scatter.s != usual.s) add("s", scatter.s);
  if (scatter.wavelength_nm != usual.wavelength_nm) add("wavelength_nm", scatter.wavelength_nm);
  if (!scatter.table.empty()) {
    std::vector<std::string> rows;
    for (const auto& [angle, bsdf] : scatter.table)
      rows.push_back(fmt::format("[{}, {}]", number_text(angle), number_text(bsdf)));
    entries.push_back(fmt::format("\"table\": [{}]", fmt::join(rows, ", ")));
  }
  if (scatter.dust_percent != 0) add("dust_percent", scatter.dust_percent);
  if (scatter.cleanliness_level) add("cleanliness_level", *scatter.cleanliness_level);
  return fmt::format("{{{}}}", fmt::join(entries, ", "));
}

}  // namespace petzval
