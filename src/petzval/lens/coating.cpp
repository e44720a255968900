// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/base/whole_file.h>
#include <petzval/lens/coating.h>
#include <petzval/lens/formats/native.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Where a number lies in an increasing list: the entry below it and the share of the next.
std::pair<std::size_t, double> place_in(const std::vector<double>& list, double value) {
  const auto above = std::upper_bound(list.begin(), list.end(), value);
  if (above == list.begin()) return {0, 0};
  const auto below = static_cast<std::size_t>(above - list.begin()) - 1;
  if (above == list.end()) return {below, 0};
  return {below, (value - list[below]) / (list[below + 1] - list[below])};
}

using Pair = std::array<double, 2>;

Pair between(const Pair& a, const Pair& b, double share) {
  return {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])};
}

}  // namespace

std::array<double, 2> AngleReflectance::at(double cosine) const {
  if (angles_deg.empty()) return values.front();
  const auto [below, share] = place_in(angles_deg, degrees(std::acos(std::clamp(cosine, 0.0, 1.0))));
  return share == 0 ? values[below] : between(values[below], values[below + 1], share);
}

bool AngleReflectance::any() const {
  return std::any_of(values.begin(), values.end(), [](const Pair& each) { return each[0] + each[1] > 0; });
}

double Coating::at(double wavelength_nm) const {
  const Pair both = by_angle_at(wavelength_nm).at(1);
  return (both[0] + both[1]) / 2;
}

AngleReflectance Coating::by_angle_at(double wavelength_nm) const {
  if (has_films()) throw InputError("the reflectance of films depends on what they lie between");
  std::vector<double> wavelengths;
  for (const auto& entry : table) wavelengths.push_back(entry.first);
  const auto [below, share] = place_in(wavelengths, wavelength_nm);
  const auto row = [&](std::size_t i) {
    return by_angle.empty() ? std::vector<Pair>{{table[i].second, table[i].second}} : by_angle[i];
  };
  AngleReflectance result{by_angle.empty() ? std::vector<double>() : angles_deg, row(below)};
  if (share == 0) return result;
  const std::vector<Pair> next = row(below + 1);
  for (std::size_t k = 0; k < next.size(); ++k) result.values[k] = between(result.values[k], next[k], share);
  return result;
}

std::vector<ThinFilm> Coating::films(double wavelength_nm, double index_before) const {
  std::vector<ThinFilm> result;
  for (const CoatingLayer& layer : layers)
    result.push_back(
        {{layer.material.index(wavelength_nm), -layer.material.extinction(wavelength_nm).value_or(0)},
         layer.thickness_nm});
  if (index_before != 1) std::reverse(result.begin(), result.end());
  return result;
}

double Coating::reflectance(double wavelength_nm, double index_before, double index_after) const {
  if (!has_films()) return at(wavelength_nm);
  return film_power(index_before, films(wavelength_nm, index_before), index_after, 1, wavelength_nm,
                    Polarisation::s)
      .reflectance;
}

void Coating::validate() const {
  if (table.empty() && layers.empty())
    throw InputError("a coating has no reflectance; give at least one value");
  if (!table.empty() && !layers.empty())
    throw InputError("a coating has reflectances and layers; one of the two would be right");
  for (const CoatingLayer& layer : layers)
    if (!(layer.thickness_nm > 0) || !std::isfinite(layer.thickness_nm))
      throw InputError(fmt::format("a layer of a coating is {:g} nm thick; more than 0 would be right",
                                   layer.thickness_nm));
  if (!by_angle.empty() && by_angle.size() != table.size())
    throw InputError(
        fmt::format("a coating has {} rows of reflectances by angle for {} wavelengths; one a "
                    "wavelength would be right",
                    by_angle.size(), table.size()));
  for (const auto& row : by_angle)
    if (row.size() != angles_deg.size() || angles_deg.empty())
      throw InputError(
          "a coating has reflectances by angle that do not fit its angles; one an angle would be right");
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto [wavelength, share] = table[i];
    if (!(share >= 0) || !(share <= 1))
      throw InputError(fmt::format("a coating reflects {:g} of the light; 0 to 1 would be right", share));
    if (!std::isfinite(wavelength) || (i > 0 && !(wavelength > table[i - 1].first)))
      throw InputError("the wavelengths of a coating must increase");
  }
}

Coating read_coating(const std::string& path_or_name) {
  const std::string file = find_data_file("coatings", ".json", path_or_name, "coating");
  const JsonDocument document(read_whole_file(file, largest_text), file);
  const JsonEntry root(document);
  if (const std::string format = root.at("format").text("\"petzval-coating/1\"");
      format != "petzval-coating/1")
    root.at("format").fail(fmt::format("is \"{}\"; \"petzval-coating/1\" would be right", format));
  return read_coating_stack(root);
}

}  // namespace petzval
