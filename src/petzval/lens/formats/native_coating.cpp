// SPDX-License-Identifier: BSD-3-Clause
// Coatings in the native lens file and in files of their own (docs/LENS_FORMAT.md).
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/wavelength.h>
#include <petzval/glass/catalogue.h>
#include <petzval/lens/formats/native.h>

#include <algorithm>
#include <variant>

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

std::vector<double> numbers_of(const JsonEntry& entry, const char* what) {
  std::vector<double> numbers;
  for (const JsonEntry& each : entry.items(what)) numbers.push_back(each.number("a number"));
  return numbers;
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
    std::vector<std::array<double, 2>>& row = coating.by_angle.emplace_back();
    for (std::size_t k = 0; k < coating.angles_deg.size(); ++k) row.push_back({s[w][k], p[w][k]});
  }
}

}  // namespace

Coating read_coating_stack(const JsonEntry& entry) {
  Coating coating;
  coating.name = entry.at("name").text("a name");
  if (const auto source = entry.find("source")) coating.source = source->text("where the numbers are from");
  if (entry.find("angles_deg")) {
    read_measured(entry, coating);
    return coating;
  }
  entry.allow_only({"format", "name", "source", "design_wavelength_nm", "layers"});
  double design_nm = 550;
  if (const auto design = entry.find("design_wavelength_nm")) {
    design_nm = design->number("a wavelength in nm");
    if (const std::string wrong = wavelength_fault(design_nm); !wrong.empty()) design->fail(wrong);
  }
  const std::vector<JsonEntry> layers =
      entry.at("layers").items("a list of layers, from the air to the glass");
  if (layers.empty() || layers.size() > most_layers)
    entry.at("layers").fail(fmt::format("has {} layers; 1 to {} would be right", layers.size(), most_layers));
  for (const JsonEntry& layer : layers) coating.layers.push_back(read_layer(layer, design_nm));
  return coating;
}

Coating read_surface_coating(const JsonEntry& entry) {
  if (entry.is_text()) {
    // Never a path: lens files come from anywhere.
    const std::string name = entry.text("a name");
    const std::vector<std::string> known = bundled_names("coatings", ".json");
    if (std::ranges::find(known, name) == known.end())
      entry.fail(fmt::format("is no bundled coating; these are: {}", fmt::join(known, ", ")));
    Coating coating = read_coating(name);
    coating.bundled = name;
    return coating;
  }
  if (entry.is_number()) return Coating::constant(entry.number("a reflectance"));
  if (entry.is_object()) return read_coating_stack(entry);
  Coating coating;
  for (const JsonEntry& row :
       entry.items("the name of a bundled coating, a reflectance, a list of [wavelength in nm, reflectance] "
                   "or an object with layers")) {
    const std::vector<JsonEntry> pair = row.items("[wavelength in nm, reflectance]");
    if (pair.size() != 2) row.fail("must be [wavelength in nm, reflectance]");
    coating.table.emplace_back(pair[0].number("a wavelength in nm"), pair[1].number("a reflectance"));
  }
  return coating;
}

namespace {

std::string list_text(const std::vector<double>& numbers) {
  std::vector<std::string> texts;
  for (const double number : numbers) texts.push_back(number_text(number));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

}  // namespace

std::string coating_text(const Coating& coating) {
  if (!coating.bundled.empty()) return quoted(coating.bundled);
  std::vector<std::string> rows;
  if (!coating.by_angle.empty()) {
    std::vector<double> wavelengths;
    for (const auto& each : coating.table) wavelengths.push_back(each.first);
    const auto of = [&](std::size_t polarisation) {
      std::vector<std::string> lists;
      for (const auto& row : coating.by_angle) {
        std::vector<double> values;
        for (const auto& both : row) values.push_back(both[polarisation]);
        lists.push_back(list_text(values));
      }
      return fmt::format("[{}]", fmt::join(lists, ", "));
    };
    return fmt::format(
        "{{\"name\": {}, \"source\": {}, \"wavelengths_nm\": {}, \"angles_deg\": {}, "
        "\"reflectance_s\": {}, \"reflectance_p\": {}}}",
        quoted(coating.name), quoted(coating.source), list_text(wavelengths), list_text(coating.angles_deg),
        of(0), of(1));
  }
  if (!coating.has_films()) {
    if (coating.table.size() == 1) return number_text(coating.table[0].second);
    for (const auto& [nm, reflectance] : coating.table)
      rows.push_back(fmt::format("[{}, {}]", number_text(nm), number_text(reflectance)));
    return fmt::format("[{}]", fmt::join(rows, ", "));
  }
  for (const CoatingLayer& layer : coating.layers) {
    const auto* const constant = std::get_if<Material::Constant>(&layer.material.kind());
    const std::string of = constant ? "\"index\": " + number_text(constant->index)
                                    : "\"material\": " + quoted(layer.material.description());
    rows.push_back(fmt::format("{{{}, \"thickness_nm\": {}}}", of, number_text(layer.thickness_nm)));
  }
  return fmt::format("{{\"name\": {}, \"source\": {}, \"layers\": [{}]}}", quoted(coating.name),
                     quoted(coating.source), fmt::join(rows, ", "));
}

}  // namespace petzval
