// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/lens/formats/glass_lookup.h>
#include <petzval/lens/formats/zmx_surfaces.h>

#include <cmath>
#include <map>

namespace petzval {

namespace {

/// The programs that write these files take a distance from 10^10 on for infinite.
constexpr double zmx_infinite_distance = 1e10;

bool is_infinite(const ZmxRecord& thickness) {
  if (!thickness.has(0)) return false;
  if (thickness.values[0] == "INFINITY" || thickness.values[0] == "-INFINITY") return true;
  return std::abs(parse_number(thickness.values[0]).value_or(0)) >= zmx_infinite_distance;
}

/// Coefficient i (from 1) of PARM is that of r^(step·i). Extended aspheres have them in XDAT instead, after
/// their number and a radius R that r is divided by.
struct SurfaceType {
  const char* name;
  int power_step;  ///< 0: no polynomial
  bool extended;
};
constexpr SurfaceType surface_types[] = {{"STANDARD", 0, false},
                                         {"EVENASPH", 2, false},
                                         {"ODDASPHE", 1, false},
                                         {"XASPHERE", 2, true},
                                         {"XOSPHERE", 1, true}};
constexpr int most_parameters = 8, most_extra_data = 300;

/// What stands for the name of a glass that has none.
constexpr const char* unnamed_glass = "___BLANK";

const SurfaceType& surface_type(const ZmxFile& file, const ZmxBlock& block) {
  const ZmxRecord* record = block.find("TYPE");
  if (!record) return surface_types[0];
  const std::string name = record->has(0) ? record->values[0] : "";
  for (const SurfaceType& type : surface_types)
    if (name == type.name) return type;
  file.fail(block, record->line,
            fmt::format("TYPE {} is not modelled; STANDARD, EVENASPH, ODDASPHE, XASPHERE and XOSPHERE are",
                        quotable(name)));
}

void read_polynomial(const ZmxContext& context, const ZmxBlock& block, int power_step, Surface& surface) {
  for (const ZmxRecord& record : block.records) {
    if (record.keyword != "PARM") continue;
    const double i = context.file.number(block, record, 0), value = context.file.number(block, record, 1);
    if (value == 0) continue;
    if (i != std::floor(i) || i < 1 || i > most_parameters)
      context.file.fail(
          block, record.line,
          fmt::format("PARM {} is not a coefficient of this surface; 1 to {} are", i, most_parameters));
    const int power = power_step * static_cast<int>(i);
    if (const double scaled = value * std::pow(context.mm_per_unit, 1 - power); scaled != 0)
      surface.asphere[power] = scaled;
  }
}

void read_extended_polynomial(const ZmxContext& context, const ZmxBlock& block, int power_step,
                              Surface& surface) {
  const ZmxFile& file = context.file;
  std::map<int, double> data;
  for (const ZmxRecord& record : block.records) {
    if (record.keyword != "XDAT") continue;
    const double i = file.number(block, record, 0);
    if (i != std::floor(i) || i < 1 || i > most_extra_data)
      file.fail(block, record.line, fmt::format("XDAT {} is not a number of extra data", i));
    data[static_cast<int>(i)] = file.number(block, record, 1);
  }
  constexpr int first_coefficient = 3;
  const double terms = data[1], radius_mm = data[2] * context.mm_per_unit;
  for (const auto& [i, value] : data) {
    const int term = i - first_coefficient + 1;
    if (term < 1 || term > terms || value == 0) continue;
    if (!(radius_mm > 0))
      file.fail(block, block.line, "an extended asphere without a positive normalisation radius (XDAT 2)");
    const int power = power_step * term;
    // One too small for a number in mm is no term.
    if (const double scaled = value * context.mm_per_unit * std::pow(radius_mm, -power); scaled != 0)
      surface.asphere[power] = scaled;
  }
}

/// nd, Vd and the deviation ΔP_gF from the normal line, of a glass that is given by these and not by its
/// name.
Material read_model_glass(const ZmxContext& context, const ZmxBlock& block, const ZmxRecord& record) {
  const ZmxFile& file = context.file;
  const std::string name = quotable(record.values[0]);
  const double nd = file.number(block, record, 3), vd = file.number_or(block, record, 4, 0);
  const double dpgf = file.number_or(block, record, 5, 0);
  if (record.values[0] != unnamed_glass)
    context.notes.push_back(fmt::format("{}:{}: SURF {}: a model glass, nd {} Vd {}; its name {} is not used",
                                        file.name, record.line, block.number, nd, vd, name));
  // Without an Abbe number a model glass has no dispersion.
  try {
    return vd == 0 ? Material(Material::Constant{nd}) : Material(Material::Model{nd, vd, dpgf});
  } catch (const InputError& error) {
    file.fail(block, record.line, error.what());
  }
}

/// GLAS name, how the name is meant (1: a model glass), a pickup, nd, Vd, ΔP_gF.
Material read_glass(const ZmxContext& context, const ZmxBlock& block, const ZmxRecord& record) {
  const ZmxFile& file = context.file;
  if (!record.has(0)) file.fail(block, record.line, "GLAS must have a glass name");
  const std::string& name = record.values[0];
  if (name == "MIRROR") file.fail(block, record.line, "GLAS MIRROR: mirrors are not modelled");
  const bool is_model = name == unnamed_glass || file.number_or(block, record, 1, 0) == 1;
  if (is_model && !context.glasses.is_substituted(name)) return read_model_glass(context, block, record);
  try {
    return context.glasses.find(name, context.catalogues);
  } catch (const InputError& error) {
    file.fail(block, record.line, error.what());
  }
}

/// A CLAP or FLAP, else a DIAM that the designer has fixed; a DIAM that follows the rays is no aperture.
std::optional<double> read_semi_diameter(const ZmxContext& context, const ZmxBlock& block) {
  const auto in_mm = [&](double value) {
    return value > 0 ? std::optional(value * context.mm_per_unit) : std::nullopt;
  };
  for (const char* keyword : {"CLAP", "FLAP"}) {
    const ZmxRecord* record = block.find(keyword);
    if (!record) continue;
    if (context.file.number(block, *record, 0) > 0)
      context.file.fail(block, record->line,
                        fmt::format("{} with an inner radius (a ring) is not modelled", keyword));
    return in_mm(context.file.number(block, *record, 1));
  }
  const ZmxRecord* diameter = block.find("DIAM");
  if (!diameter || context.file.number_or(block, *diameter, 1, 0) == 0) return {};
  return in_mm(context.file.number(block, *diameter, 0));
}

double read_thickness(const ZmxContext& context, const ZmxBlock& block) {
  const ZmxRecord* record = block.find("DISZ");
  if (!record) return 0;
  if (is_infinite(*record))
    context.file.fail(block, record->line, "only the object may be infinitely far away");
  return context.file.number(block, *record, 0) * context.mm_per_unit;
}

double number_of(const ZmxContext& context, const ZmxBlock& block, const char* keyword) {
  const ZmxRecord* record = block.find(keyword);
  return record ? context.file.number(block, *record, 0) : 0;
}

Surface read_surface(const ZmxContext& context, const ZmxBlock& block) {
  Surface surface;
  const SurfaceType& type = surface_type(context.file, block);
  surface.curvature_per_mm = number_of(context, block, "CURV") / context.mm_per_unit;
  surface.conic = number_of(context, block, "CONI");
  surface.thickness_mm = read_thickness(context, block);
  surface.stop = block.find("STOP") != nullptr;
  surface.semi_diameter_mm = read_semi_diameter(context, block);
  if (type.extended)
    read_extended_polynomial(context, block, type.power_step, surface);
  else if (type.power_step)
    read_polynomial(context, block, type.power_step, surface);
  if (const ZmxRecord* glass = block.find("GLAS")) surface.material = read_glass(context, block, *glass);
  return surface;
}

/// Object and image are planes in this model, and neither is the stop.
void check_end(const ZmxContext& context, const ZmxBlock& block, const char* what) {
  if (const ZmxRecord* stop = block.find("STOP"))
    context.file.fail(block, stop->line, fmt::format("the {} surface cannot be the stop", what));
  if (surface_type(context.file, block).power_step || number_of(context, block, "CURV") != 0)
    context.file.fail(block, block.line,
                      fmt::format("a curved {} surface is not modelled; it must be flat", what));
  if (const ZmxRecord* glass = block.find("GLAS"))
    context.file.fail(block, glass->line, fmt::format("glass behind the {} surface is not modelled", what));
}

}  // namespace

std::vector<Surface> zmx_lens_surfaces(const ZmxContext& context) {
  const auto& blocks = context.file.surfaces;
  check_end(context, blocks.front(), "object");
  check_end(context, blocks.back(), "image");
  std::vector<Surface> surfaces;
  for (std::size_t i = 1; i + 1 < blocks.size(); ++i) surfaces.push_back(read_surface(context, blocks[i]));
  return surfaces;
}

std::optional<double> zmx_object_distance_mm(const ZmxContext& context) {
  const ZmxBlock& object = context.file.surfaces.front();
  const ZmxRecord* thickness = object.find("DISZ");
  if (!thickness) context.file.fail(object, object.line, "has no DISZ, the distance of the object");
  if (is_infinite(*thickness)) return {};
  return context.file.number(object, *thickness, 0) * context.mm_per_unit;
}

double zmx_stop_semi_diameter_mm(const ZmxContext& context) {
  for (const ZmxBlock& block : context.file.surfaces) {
    if (!block.find("STOP")) continue;
    const ZmxRecord* diameter = block.find("DIAM");
    if (!diameter)
      context.file.fail(block, block.line, "the aperture is that of the stop (FLOA), and it has no DIAM");
    return context.file.number(block, *diameter, 0) * context.mm_per_unit;
  }
  throw InputError(context.file.name, "has no STOP surface");
}

}  // namespace petzval
