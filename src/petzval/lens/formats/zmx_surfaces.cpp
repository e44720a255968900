// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/units.h>
#include <petzval/lens/formats/axis_breaks.h>
#include <petzval/lens/formats/glass_lookup.h>
#include <petzval/lens/formats/zmx_surfaces.h>
#include <petzval/lens/shapes/xy_terms.h>

#include <array>
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
  const char* kind = nullptr;  ///< of AddedShape, with its numbers in PARM or XDAT
};
constexpr SurfaceType surface_types[] = {{"STANDARD", 0, false},
                                         {"EVENASPH", 2, false},
                                         {"ODDASPHE", 1, false},
                                         {"XASPHERE", 2, true},
                                         {"XOSPHERE", 1, true},
                                         {"BICONICX", 0, false, "biconic"},
                                         {"TOROIDAL", 0, false, "toroid"},
                                         {"XPOLYNOM", 0, true, "xy_polynomial"},
                                         {"SZERNSAG", 0, true, "zernike_sag"},
                                         {"TILTSURF", 0, false, "xy_polynomial"},
                                         {"DGRATING", 0, false},
                                         {"PARAXIAL", 0, false}};
/// A surface that only turns and moves the axes of what follows.
constexpr const char* coordinate_break = "COORDBRK";
constexpr int most_parameters = 8, most_extra_data = 300;

/// What stands for the name of a glass that has none.
constexpr const char* unnamed_glass = "___BLANK";

const SurfaceType& surface_type(const ZmxFile& file, const ZmxBlock& block) {
  const ZmxRecord* record = block.find("TYPE");
  if (!record) return surface_types[0];
  const std::string name = record->has(0) ? record->values[0] : "";
  for (const SurfaceType& type : surface_types)
    if (name == type.name) return type;
  std::vector<const char*> names;
  for (const SurfaceType& type : surface_types) names.push_back(type.name);
  file.fail(
      block, record->line,
      fmt::format("TYPE {} is not modelled; {} and COORDBRK are", quotable(name), fmt::join(names, ", ")));
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

constexpr int first_coefficient = 3;

std::map<int, double> extra_data(const ZmxFile& file, const ZmxBlock& block) {
  std::map<int, double> data;
  for (const ZmxRecord& record : block.records) {
    if (record.keyword != "XDAT") continue;
    const double i = file.number(block, record, 0);
    if (i != std::floor(i) || i < 1 || i > most_extra_data)
      file.fail(block, record.line, fmt::format("XDAT {} is not a number of extra data", i));
    data[static_cast<int>(i)] = file.number(block, record, 1);
  }
  return data;
}

/// PARM, by number.
std::map<int, double> surface_parameters(const ZmxFile& file, const ZmxBlock& block) {
  std::map<int, double> parameters;
  for (const ZmxRecord& record : block.records) {
    if (record.keyword != "PARM") continue;
    const double i = file.number(block, record, 0), value = file.number(block, record, 1);
    if (value != 0 && i >= 1 && i < most_extra_data) parameters[static_cast<int>(i)] = value;
  }
  return parameters;
}

/// PARM 1 as a radius, 0 for none, with all its digits.
double curvature_parameter_per_mm(const ZmxContext& context, const ZmxBlock& block) {
  double curvature_per_mm = 0;
  for (const ZmxRecord& record : block.records)
    if (record.keyword == "PARM" && context.file.number(block, record, 0) == 1)
      curvature_per_mm = context.file.number(block, record, 1) == 0
                             ? 0
                             : curvature_from_radius(record.values[1]) / context.mm_per_unit;
  return curvature_per_mm;
}

void read_biconic(const ZmxContext& context, const ZmxBlock& block, Surface& surface) {
  auto parameters = surface_parameters(context.file, block);
  surface.shape->parameters["curvature_x_per_mm"] = {curvature_parameter_per_mm(context, block)};
  surface.shape->parameters["conic_x"] = {parameters[2]};
}

/// PARM 1: the radius of rotation, 0 for a cylinder; from 2 on coefficients of y², y⁴ ….
void read_toroid(const ZmxContext& context, const ZmxBlock& block, Surface& surface) {
  auto parameters = surface_parameters(context.file, block);
  if (extra_data(context.file, block)[1] != 0)
    context.file.fail(block, block.line, "a toroid with Zernike terms (XDAT) is not modelled");
  auto& shape = surface.shape->parameters;
  shape["rotation_curvature_per_mm"] = {curvature_parameter_per_mm(context, block)};
  shape["normalisation_radius_mm"] = {1};
  constexpr int most_coefficients = 7;
  std::vector<double> coefficients;
  for (int i = 1; i <= most_coefficients; ++i)
    coefficients.push_back(parameters[i + 1] * std::pow(context.mm_per_unit, 1 - 2 * i));
  while (!coefficients.empty() && coefficients.back() == 0) coefficients.pop_back();
  if (!coefficients.empty()) shape["coefficients_mm"] = coefficients;
}

/// A plane z = x PARM 1 + y PARM 2.
void read_tilted(const ZmxContext& context, const ZmxBlock& block, Surface& surface) {
  auto parameters = surface_parameters(context.file, block);
  surface.shape->parameters["normalisation_radius_mm"] = {1};
  surface.shape->parameters["coefficients_mm"] = {parameters[1], parameters[2]};
}

/// PARM 1: lines per µm; 2: the order, which counts towards +y.
void read_grating(const ZmxContext& context, const ZmxBlock& block, Surface& surface) {
  constexpr double um_per_mm = 1e3;
  auto parameters = surface_parameters(context.file, block);
  surface.grating = Grating{parameters[1] * um_per_mm, parameters[2], 0};
}

/// PARM 1: the focal length; 2: how paths through it are found, which gives the same paths for the object.
void read_ideal_lens(const ZmxContext& context, const ZmxBlock& block, Surface& surface) {
  auto parameters = surface_parameters(context.file, block);
  if (parameters[1] == 0)
    context.file.fail(block, block.line, "a PARAXIAL surface without a focal length (PARM 1)");
  surface.ideal_lens = IdealLens{parameters[1] * context.mm_per_unit};
}

/// XDAT 1: how many terms; 2: the radius; from 3 on the terms, a length each.
void read_freeform(const ZmxContext& context, const ZmxBlock& block, Surface& surface) {
  const ZmxFile& file = context.file;
  if (!surface_parameters(file, block).empty())
    file.fail(block, block.line,
              fmt::format("powers of r (PARM) beside the terms of {} are not modelled", surface.shape->kind));
  std::map<int, double> data = extra_data(file, block);
  const double terms = data[1], radius_mm = data[2] * context.mm_per_unit;
  if (!(terms >= 0 && terms <= static_cast<double>(most_xy_terms)) || terms != std::floor(terms))
    file.fail(block, block.line,
              fmt::format("{} terms (XDAT 1); 0 to {} would be right", terms, most_xy_terms));
  if (!(radius_mm > 0))
    file.fail(block, block.line, "a freeform without a positive normalisation radius (XDAT 2)");
  std::vector<double> coefficients;
  for (int i = 0; i < static_cast<int>(terms); ++i)
    coefficients.push_back(data[first_coefficient + i] * context.mm_per_unit);
  surface.shape->parameters["normalisation_radius_mm"] = {radius_mm};
  if (!coefficients.empty()) surface.shape->parameters["coefficients_mm"] = coefficients;
}

void read_extended_polynomial(const ZmxContext& context, const ZmxBlock& block, int power_step,
                              Surface& surface) {
  const ZmxFile& file = context.file;
  std::map<int, double> data = extra_data(file, block);
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
  const bool is_model = name == unnamed_glass || file.number_or(block, record, 1, 0) == 1;
  if (is_model && !context.glasses.is_substituted(name)) return read_model_glass(context, block, record);
  try {
    return context.glasses.find(name, context.catalogues);
  } catch (const InputError& error) {
    try {
      file.fail(block, record.line, error.what());
    } catch (const InputError& located) {
      return context.glasses.missing(located, name, fmt::format("SURF {}", block.number));
    }
  }
}

bool is_decentred(const ZmxContext& context, const ZmxBlock& block) {
  const ZmxRecord* by = block.find("OBDC");
  return by &&
         (context.file.number_or(block, *by, 0, 0) != 0 || context.file.number_or(block, *by, 1, 0) != 0);
}

/// The arms of a spider, from the middle outwards, the first along +x.
void read_spider(const ZmxContext& context, const ZmxBlock& block, const ZmxRecord& record,
                 Surface& surface) {
  const double width_mm = context.file.number(block, record, 0) * context.mm_per_unit;
  const double arms = context.file.number(block, record, 1);
  const ZmxRecord* diameter = block.find("DIAM");
  const double reach_mm = diameter ? context.file.number(block, *diameter, 0) * context.mm_per_unit : 0;
  constexpr double most_arms = 64;
  if (!(width_mm > 0 && reach_mm > 0 && arms >= 1 && arms <= most_arms) || arms != std::floor(arms))
    context.file.fail(block, record.line,
                      "SPID must have a width, 1 to 64 arms, and a DIAM for their length");
  for (int i = 0; i < static_cast<int>(arms); ++i) {
    ApertureFigure arm{ApertureFigure::Kind::rectangle, reach_mm / 2, width_mm / 2, reach_mm / 2, 0, 0, true};
    surface.apertures.push_back(arm.turned(2 * pi * i / arms));
  }
}

/// Apertures that are not round, that are closed inside, or off the middle of the surface (OBDC).
void read_figures(const ZmxContext& context, const ZmxBlock& block, Surface& surface) {
  using Kind = ApertureFigure::Kind;
  const ZmxFile& file = context.file;
  double x_mm = 0, y_mm = 0;
  if (const ZmxRecord* by = block.find("OBDC")) {
    x_mm = file.number_or(block, *by, 0, 0) * context.mm_per_unit;
    y_mm = file.number_or(block, *by, 1, 0) * context.mm_per_unit;
  }
  const auto add = [&](Kind kind, double half_x, double half_y, bool obscures) {
    if (!(half_x > 0 && half_y > 0)) return;
    surface.apertures.push_back(
        {kind, half_x * context.mm_per_unit, half_y * context.mm_per_unit, x_mm, y_mm, 0, obscures});
  };
  for (const ZmxRecord& record : block.records) {
    const std::string& word = record.keyword;
    const auto number = [&](std::size_t i) { return file.number(block, record, i); };
    if (word == "CLAP" || word == "FLAP") {
      add(Kind::ellipse, number(0), number(0), true);
      if (is_decentred(context, block)) add(Kind::ellipse, number(1), number(1), false);
    } else if (word == "OBSC") {
      // What lies between the two radii is closed; from 0 on, a disc.
      if (number(0) > 0) file.fail(block, record.line, "OBSC with an inner radius is not modelled");
      add(Kind::ellipse, number(1), number(1), true);
    } else if (word == "SQAP" || word == "SQOB") {
      add(Kind::rectangle, number(0), number(1), word == "SQOB");
    } else if (word == "ELAP" || word == "ELOB") {
      add(Kind::ellipse, number(0), number(1), word == "ELOB");
    } else if (word == "SPID") {
      read_spider(context, block, record, surface);
    }
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
    if (is_decentred(context, block)) return {};  // a figure
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
  read_figures(context, block, surface);
  if (type.kind) {
    surface.shape = AddedShape{type.kind, {}};
    const std::string kind = type.kind;
    if (kind == "biconic")
      read_biconic(context, block, surface);
    else if (kind == "toroid")
      read_toroid(context, block, surface);
    else if (!type.extended)
      read_tilted(context, block, surface);
    else
      read_freeform(context, block, surface);
  } else if (type.name == std::string("DGRATING"))
    read_grating(context, block, surface);
  else if (type.name == std::string("PARAXIAL"))
    read_ideal_lens(context, block, surface);
  else if (type.extended)
    read_extended_polynomial(context, block, type.power_step, surface);
  else if (type.power_step)
    read_polynomial(context, block, type.power_step, surface);
  const ZmxRecord* glass = block.find("GLAS");
  surface.mirror = glass && glass->has(0) && glass->values[0] == "MIRROR";
  if (glass && !surface.mirror) surface.material = read_glass(context, block, *glass);
  return surface;
}

bool is_coordinate_break(const ZmxBlock& block) {
  const ZmxRecord* type = block.find("TYPE");
  return type && type->has(0) && type->values[0] == coordinate_break;
}

/// Decentres in x and y, tilts about x, y and z, right-handed; order: 0, as they are named, or else the
/// other way round (Zemax, OpticStudio User Manual, "Coordinate Break").
Frame read_coordinate_break(const ZmxContext& context, const ZmxBlock& block) {
  const ZmxFile& file = context.file;
  constexpr std::size_t numbers = 6;
  std::array<double, numbers> values{};
  for (const ZmxRecord& record : block.records) {
    if (record.keyword != "PARM") continue;
    const double i = file.number(block, record, 0), value = file.number(block, record, 1);
    if (i >= 1 && i <= numbers && i == std::floor(i))
      values[static_cast<std::size_t>(i) - 1] = value;
    else if (value != 0)
      file.fail(block, record.line,
                fmt::format("PARM {} is not a number of a coordinate break; 1 to 6 are", i));
  }
  for (const char* keyword : {"STOP", "GLAS"})
    if (const ZmxRecord* record = block.find(keyword))
      file.fail(block, record->line,
                fmt::format("{} stands at a coordinate break, which is no surface", keyword));
  const double x_mm = values[0] * context.mm_per_unit, y_mm = values[1] * context.mm_per_unit;
  if (values[5] == 0) return frame_of({x_mm, y_mm, 0, values[2], values[3], values[4]});
  return inverse(frame_of({-x_mm, -y_mm, 0, -values[2], -values[3], -values[4]}));
}

/// Object and image are planes in this model, and neither is the stop.
void check_end(const ZmxContext& context, const ZmxBlock& block, const char* what) {
  if (const ZmxRecord* stop = block.find("STOP"))
    context.file.fail(block, stop->line, fmt::format("the {} surface cannot be the stop", what));
  if (surface_type(context.file, block).power_step || surface_type(context.file, block).kind ||
      number_of(context, block, "CURV") != 0)
    context.file.fail(block, block.line,
                      fmt::format("a curved {} surface is not modelled; it must be flat", what));
  const ZmxRecord* glass = block.find("GLAS");
  if (!glass) return;
  if (&block == &context.file.surfaces.front()) return;
  context.notes.push_back(fmt::format("{}:{}: SURF {}: the glass behind the image surface does not count",
                                      context.file.name, glass->line, block.number));
}

}  // namespace

void put_zmx_surfaces(const ZmxContext& context, Lens& lens) {
  const auto& blocks = context.file.surfaces;
  check_end(context, blocks.front(), "object");
  if (const ZmxRecord* glass = blocks.front().find("GLAS"))
    lens.object_material = read_glass(context, blocks.front(), *glass);
  check_end(context, blocks.back(), "image");
  std::vector<AxisBreak> breaks;
  for (std::size_t i = 1; i + 1 < blocks.size(); ++i) {
    if (!is_coordinate_break(blocks[i])) {
      lens.surfaces.push_back(read_surface(context, blocks[i]));
      continue;
    }
    const double gap_mm = read_thickness(context, blocks[i]);
    // What stands behind a break moves the vertex on, and the earlier ones away from it.
    breaks.push_back({lens.surfaces.size(), read_coordinate_break(context, blocks[i]), 0});
    for (AxisBreak& each : breaks)
      if (each.surface == lens.surfaces.size()) each.pivot_mm -= gap_mm;
    if (!lens.surfaces.empty())
      lens.surfaces.back().thickness_mm += gap_mm;
    else if (lens.object_distance_mm)
      *lens.object_distance_mm += gap_mm;
  }
  put_axis_breaks(breaks, lens);
}

std::size_t zmx_block_of(const ZmxFile& file, std::size_t surface) {
  std::size_t count = 0;
  for (std::size_t i = 1; i + 1 < file.surfaces.size(); ++i)
    if (!is_coordinate_break(file.surfaces[i]) && count++ == surface) return i;
  return file.surfaces.size() - 1;
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
