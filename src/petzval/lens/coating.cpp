// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
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

double Coating::at(double wavelength_nm) const {
  if (has_films()) throw InputError("the reflectance of films depends on what they lie between");
  const auto above = std::find_if(table.begin(), table.end(),
                                  [&](const auto& entry) { return entry.first >= wavelength_nm; });
  if (above == table.begin()) return table.front().second;
  if (above == table.end()) return table.back().second;
  const auto below = above - 1;
  const double share = (wavelength_nm - below->first) / (above->first - below->first);
  return below->second + share * (above->second - below->second);
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
  root.allow_only({"format", "name", "source", "design_wavelength_nm", "layers"});
  if (const std::string format = root.at("format").text("\"petzval-coating/1\"");
      format != "petzval-coating/1")
    root.at("format").fail(fmt::format("is \"{}\"; \"petzval-coating/1\" would be right", format));
  Coating coating;
  coating.name = root.at("name").text("a name");
  if (const auto source = root.find("source")) coating.source = source->text("where the numbers are from");
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
