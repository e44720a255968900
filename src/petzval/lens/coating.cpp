// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/base/wavelength.h>
#include <petzval/base/whole_file.h>
#include <petzval/glass/catalogue.h>
#include <petzval/lens/coating.h>
#include <petzval/lens/formats/json_document.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr std::size_t most_layers = 1000;
constexpr double thickest_nm = 1e5;

Material layer_material(const JsonEntry& layer) {
  if (const auto index = layer.find("index"))
    return Material(Material::Constant{index->number("a refractive index")});
  const JsonEntry& name = layer.at("material");
  try {
    return glass_material(name.text("the name of a material"));
  } catch (const InputError& error) {
    name.fail(std::string("cannot be had: ") + error.what());
  }
}

CoatingLayer read_layer(const JsonEntry& entry, double design_nm) {
  entry.allow_only({"index", "material", "thickness_nm", "quarter_waves"});
  CoatingLayer layer;
  layer.material = layer_material(entry);
  if (const auto thickness = entry.find("thickness_nm"))
    layer.thickness_nm = thickness->number("a thickness in nm");
  else
    layer.thickness_nm = entry.at("quarter_waves").number("a number of quarter waves") * design_nm /
                         (4 * layer.material.index(design_nm));
  if (!(layer.thickness_nm > 0 && layer.thickness_nm <= thickest_nm))
    entry.fail(fmt::format("is {:g} nm thick; more than 0 and up to {:g} would be right", layer.thickness_nm,
                           thickest_nm));
  return layer;
}

}  // namespace

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

std::vector<double> numbers_of(const JsonEntry& entry, const char* what) {
  std::vector<double> numbers;
  for (const JsonEntry& each : entry.items(what)) numbers.push_back(each.number("a number"));
  return numbers;
}

Pair between(const Pair& a, const Pair& b, double share) {
  return {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])};
}

/// Numbers from 0 to 1 in rows, one a wavelength, of one an angle.
std::vector<std::vector<double>> read_reflectances(const JsonEntry& entry, std::size_t wavelengths,
                                                   std::size_t angles) {
  const std::vector<JsonEntry> rows = entry.items("a list of reflectances, one a wavelength");
  if (rows.size() != wavelengths)
    entry.fail(fmt::format("has {} rows; {}, one a wavelength, would be right", rows.size(), wavelengths));
  std::vector<std::vector<double>> result;
  for (const JsonEntry& row : rows) {
    std::vector<double> values = numbers_of(row, "reflectances, one an angle");
    if (values.size() != angles)
      row.fail(fmt::format("has {} values; {}, one an angle, would be right", values.size(), angles));
    for (const double value : values)
      if (!(value >= 0 && value <= 1)) row.fail(fmt::format("holds {:g}; 0 to 1 would be right", value));
    result.push_back(std::move(values));
  }
  return result;
}

/// \param largest  the last of them may be.
std::vector<double> read_increasing(const JsonEntry& entry, const char* what, double largest) {
  std::vector<double> values = numbers_of(entry, what);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!(values[i] >= 0 && values[i] <= largest) || (i > 0 && !(values[i] > values[i - 1])))
      entry.fail(fmt::format("holds {:g}; increasing numbers up to {:g} would be right", values[i], largest));
  if (values.empty()) entry.fail("is empty; at least one number would be right");
  return values;
}

void read_measured(const JsonEntry& root, Coating& coating) {
  root.allow_only({"format", "name", "source", "wavelengths_nm", "angles_deg", "reflectance", "reflectance_s",
                   "reflectance_p"});
  constexpr double longest_nm = 1e6, grazing_deg = 90;
  const std::vector<double> wavelengths =
      read_increasing(root.at("wavelengths_nm"), "wavelengths in nm", longest_nm);
  coating.angles_deg = read_increasing(root.at("angles_deg"), "angles of incidence in degrees", grazing_deg);
  const bool apart = root.find("reflectance_s").has_value();
  const auto read = [&](const char* key) {
    return read_reflectances(root.at(key), wavelengths.size(), coating.angles_deg.size());
  };
  if (apart && root.find("reflectance"))
    root.at("reflectance").fail("stands beside those of s and p; one or the other would be right");
  const auto s = read(apart ? "reflectance_s" : "reflectance"), p = apart ? read("reflectance_p") : s;
  for (std::size_t w = 0; w < wavelengths.size(); ++w) {
    coating.table.emplace_back(wavelengths[w], (s[w][0] + p[w][0]) / 2);
    std::vector<Pair>& row = coating.by_angle.emplace_back();
    for (std::size_t k = 0; k < coating.angles_deg.size(); ++k) row.push_back({s[w][k], p[w][k]});
  }
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
  const JsonDocument document(read_whole_file(file), file);
  const JsonEntry root(document);
  if (const std::string format = root.at("format").text("\"petzval-coating/1\"");
      format != "petzval-coating/1")
    root.at("format").fail(fmt::format("is \"{}\"; \"petzval-coating/1\" would be right", format));
  Coating coating;
  coating.name = root.at("name").text("a name");
  if (const auto source = root.find("source")) coating.source = source->text("where the numbers are from");
  if (!root.find("layers")) {
    if (!root.find("angles_deg"))
      root.fail("has neither `layers` nor `angles_deg` with reflectances; one of the two would be right");
    read_measured(root, coating);
    return coating;
  }
  root.allow_only({"format", "name", "source", "design_wavelength_nm", "layers"});
  double design_nm = 550;
  if (const auto design = root.find("design_wavelength_nm")) {
    design_nm = design->number("a wavelength in nm");
    if (const std::string wrong = wavelength_fault(design_nm); !wrong.empty()) design->fail(wrong);
  }
  const std::vector<JsonEntry> layers =
      root.at("layers").items("a list of layers, from the air to the glass");
  if (layers.empty() || layers.size() > most_layers)
    root.at("layers").fail(fmt::format("has {} layers; 1 to {} would be right", layers.size(), most_layers));
  for (const JsonEntry& layer : layers) coating.layers.push_back(read_layer(layer, design_nm));
  return coating;
}

}  // namespace petzval
