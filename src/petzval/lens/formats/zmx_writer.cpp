// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/glass/catalogue.h>
#include <petzval/lens/formats/axis_breaks.h>
#include <petzval/lens/formats/zmx.h>
#include <petzval/lens/lens_states.h>
#include <petzval/lens/pose.h>
#include <petzval/lens/surface_kind.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

namespace petzval {

namespace {

constexpr int um_per_nm_power = -3;

/// Names and sources as one line.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return trimmed(text);
}

/// The first catalogue glass of a lens that a reader who searches `catalogue` before its own would mistake.
const Glass* mistaken_glass(const Lens& lens, const std::string& catalogue,
                            const std::set<std::string>& later) {
  for (const Surface& surface : lens.surfaces) {
    const auto* glass = std::get_if<std::shared_ptr<const Glass>>(&surface.material.kind());
    if (glass && (*glass)->catalogue != catalogue && later.count((*glass)->catalogue) &&
        GlassCatalogue::bundled().contains(catalogue + ":" + (*glass)->name))
      return glass->get();
  }
  return nullptr;
}

/// The catalogues of a lens's glasses, in an order in which each name finds its own glass first: a .zmx file
/// names glasses without their catalogue.
std::vector<std::string> catalogue_order(const Lens& lens) {
  std::set<std::string> left;
  for (const Surface& surface : lens.surfaces)
    if (const auto* glass = std::get_if<std::shared_ptr<const Glass>>(&surface.material.kind()))
      left.insert((*glass)->catalogue);
  std::vector<std::string> order;
  while (!left.empty()) {
    const auto next = std::find_if(left.begin(), left.end(), [&](const auto& catalogue) {
      return !mistaken_glass(lens, catalogue, left);
    });
    if (next == left.end())
      throw InputError(fmt::format("surfaces: a .zmx file cannot tell {} from the glass {} of {}",
                                   mistaken_glass(lens, *left.begin(), left)->full_name(),
                                   mistaken_glass(lens, *left.begin(), left)->name, *left.begin()));
    order.push_back(*next);
    left.erase(next);
  }
  return order;
}

struct ZmxGlassText {
  std::size_t surface;

  std::string operator()(const Material::Air&) const { return ""; }
  std::string operator()(const std::shared_ptr<const Glass>& glass) const {
    if (glass->name.find_first_of(" \t\"") != std::string::npos)
      throw InputError(fmt::format("surfaces[{}].glass: a .zmx file cannot hold a name with blanks: {}",
                                   surface, glass->full_name()));
    return fmt::format("  GLAS {} 0 0 1.5 40 0 0 0 0 0 0\n", glass->name);
  }
  std::string operator()(const Material::Model& model) const {
    return model_glass(model.nd, model.vd, model.dpgf);
  }
  std::string operator()(const Material::Constant& constant) const {
    return model_glass(constant.index, 0, 0);
  }
  std::string operator()(const Material::Table&) const {
    throw InputError(fmt::format(
        "surfaces[{}].glass: a .zmx file cannot hold a table of indices; name a glass first", surface));
  }
  static std::string model_glass(double nd, double vd, double dpgf) {
    return fmt::format("  GLAS ___BLANK 1 0 {} {} {} 0 0 0 0 0\n", number_text(nd), number_text(vd),
                       number_text(dpgf));
  }
};

/// Powers of any height that are multiples of `step`, r measured in mm.
std::string extended_shape_text(const Surface& surface, int step) {
  const auto datum = [](int i, const std::string& value) {
    return fmt::format("  XDAT {} {} 0 0 1 0 0 \"\"\n", i, value);
  };
  std::string text = fmt::format("  TYPE {}\n", step == 2 ? "XASPHERE" : "XOSPHERE");
  text += datum(1, fmt::format("{}", surface.asphere.rbegin()->first / step)) + datum(2, "1.0");
  for (const auto& [power, coefficient] : surface.asphere)
    text += datum(power / step + 2, number_text(coefficient));
  return text;
}

bool zmx_holds_kind(const std::string& kind) {
  return kind == "biconic" || kind == "toroid" || kind == "xy_polynomial" || kind == "zernike_sag";
}

std::string zmx_added_shape_text(const Surface& surface) {
  const std::string& kind = surface.shape->kind;
  const auto number = [&](const char* key) {
    const std::vector<double> given = shape_numbers(surface, key);
    return given.empty() ? 0.0 : given[0];
  };
  const auto radius = [](double curvature) { return curvature == 0 ? "0" : radius_text(curvature); };
  const std::vector<double> coefficients = shape_numbers(surface, "coefficients_mm");
  const double unit_mm = number("normalisation_radius_mm");
  std::string text;
  if (kind == "biconic") {
    text = fmt::format("  TYPE BICONICX\n  PARM 1 {}\n", radius(number("curvature_x_per_mm")));
    return text + fmt::format("  PARM 2 {}\n", number_text(number("conic_x")));
  }
  if (kind == "toroid") {
    constexpr std::size_t most = 7;
    if (coefficients.size() > most)
      throw InputError(
          fmt::format("a toroid with {} coefficients; a .zmx file holds {}", coefficients.size(), most));
    text = fmt::format("  TYPE TOROIDAL\n  PARM 1 {}\n", radius(number("rotation_curvature_per_mm")));
    for (std::size_t i = 0; i < coefficients.size(); ++i)
      text += fmt::format("  PARM {} {}\n", i + 2,
                          number_text(coefficients[i] * std::pow(unit_mm, -2 * static_cast<double>(i + 1))));
    return text;
  }
  const auto datum = [&](std::size_t i, const std::string& value) {
    text += fmt::format("  XDAT {} {} 0 0 1 0 0 \"\"\n", i, value);
  };
  text = fmt::format("  TYPE {}\n", kind == "xy_polynomial" ? "XPOLYNOM" : "SZERNSAG");
  datum(1, fmt::format("{}", coefficients.size()));
  datum(2, number_text(unit_mm));
  for (std::size_t i = 0; i < coefficients.size(); ++i) datum(i + 3, number_text(coefficients[i]));
  return text;
}

/// Lines along x, which half a turn leaves where they are.
std::string grating_text(const Surface& surface) {
  constexpr double um_per_mm = 1e3, half_turn_deg = 180;
  const double turn = surface.grating->rotation_deg;
  if (turn != 0 && std::abs(turn) != half_turn_deg)
    throw InputError("grating.rotation_deg: a .zmx file holds lines along x; turn the surface (tilt_z_deg)");
  return fmt::format("  TYPE DGRATING\n  PARM 1 {}\n  PARM 2 {}\n",
                     number_text(surface.grating->lines_per_mm / um_per_mm),
                     number_text(turn == 0 ? surface.grating->order : -surface.grating->order));
}

/// Even powers up to 16 make an EVENASPH, higher ones an XASPHERE, any powers up to 8 an ODDASPHE, higher
/// ones an XOSPHERE.
std::string shape_text(const Surface& surface) {
  if (surface.shape) return zmx_added_shape_text(surface);
  if (surface.grating) return grating_text(surface);
  if (surface.ideal_lens)
    return fmt::format("  TYPE PARAXIAL\n  PARM 1 {}\n  PARM 2 1\n",
                       number_text(surface.ideal_lens->focal_length_mm));
  if (surface.asphere.empty()) return "  TYPE STANDARD\n";
  constexpr int parameters = 8;
  const bool even = std::all_of(surface.asphere.begin(), surface.asphere.end(),
                                [](const auto& term) { return term.first % 2 == 0; });
  const int step = even ? 2 : 1, highest = surface.asphere.rbegin()->first;
  if (highest > parameters * step) return extended_shape_text(surface, step);
  std::string text = even ? "  TYPE EVENASPH\n" : "  TYPE ODDASPHE\n";
  for (const auto& [power, coefficient] : surface.asphere)
    text += fmt::format("  PARM {} {}\n", power / step, number_text(coefficient));
  return text;
}

/// One aperture a surface: round, a ring, or a figure.
std::string zmx_apertures_text(const Surface& surface, std::size_t i) {
  const auto& figures = surface.apertures;
  const bool ring = figures.size() == 1 && figures[0].obscures && figures[0].is_round();
  if (surface.semi_diameter_mm && (figures.empty() || ring))
    return fmt::format("  CLAP {} {} 0\n", ring ? number_text(figures[0].half_width_x_mm) : "0",
                       number_text(*surface.semi_diameter_mm));
  if (figures.empty()) return "";
  if (figures.size() > 1 || surface.semi_diameter_mm || figures[0].rotation_deg != 0)
    throw InputError(fmt::format(
        "surfaces[{}].apertures: a .zmx file holds one aperture a surface, not turned, or a ring", i));
  const ApertureFigure& figure = figures[0];
  std::string text;
  if (ring)
    text = fmt::format("  OBSC 0 {} 0\n", number_text(figure.half_width_x_mm));
  else
    text = fmt::format("  {} {} {} 0\n",
                       figure.kind == ApertureFigure::Kind::rectangle ? (figure.obscures ? "SQOB" : "SQAP")
                                                                      : (figure.obscures ? "ELOB" : "ELAP"),
                       number_text(figure.half_width_x_mm), number_text(figure.half_width_y_mm));
  if (figure.decentre_x_mm != 0 || figure.decentre_y_mm != 0)
    text +=
        fmt::format("  OBDC {} {}\n", number_text(figure.decentre_x_mm), number_text(figure.decentre_y_mm));
  return text;
}

/// Coordinate breaks in front of a surface, and their numbers.
std::string zmx_break_text(const Frame& frame, double gap_mm, int& number) {
  const Pose pose = pose_of(frame);
  std::string text = fmt::format("SURF {}\n  TYPE COORDBRK\n", number++);
  int parameter = 0;
  for (const double value :
       {pose.decentre_x_mm, pose.decentre_y_mm, pose.tilt_x_deg, pose.tilt_y_deg, pose.tilt_z_deg, 0.0})
    text += fmt::format("  PARM {} {}\n", ++parameter, number_text(value));
  return text + fmt::format("  DISZ {}\n", number_text(gap_mm));
}

/// \param gap_mm  to the next surface, or to the break in front of it.
std::string surface_text(const Lens& lens, std::size_t i, double gap_mm, int& number) {
  const Surface& surface = lens.surfaces[i];
  if (surface.blades.count != 0)
    throw InputError(fmt::format(
        "surfaces[{0}]: Petzval writes no blades into a .zmx file; set surfaces[{0}].blades=null first", i));
  if (surface.shape && !zmx_holds_kind(surface.shape->kind))
    throw InputError(
        fmt::format("surfaces[{}].shape: a .zmx file cannot hold the kind \"{}\"", i, surface.shape->kind));
  std::string text =
      fmt::format("SURF {}\n{}{}", number++, surface.stop ? "  STOP\n" : "", shape_text(surface));
  text += fmt::format("  CURV {} 0 0 0 0 \"\"\n", number_text(surface.curvature_per_mm));
  if (surface.conic != 0) text += fmt::format("  CONI {}\n", number_text(surface.conic));
  text += fmt::format("  DISZ {}\n", number_text(gap_mm));
  text += surface.mirror ? "  GLAS MIRROR 0 0 1.5 40 0 0 0 0 0 0\n"
                         : std::visit(ZmxGlassText{i}, surface.material.kind());
  // The size of the stop, where the aperture is given by it, is an automatic DIAM beside the clear aperture.
  const bool sets_aperture = surface.stop && lens.aperture.kind == Aperture::Kind::stop_semi_diameter_mm;
  const double semi = sets_aperture ? lens.aperture.value : surface.semi_diameter_mm.value_or(0);
  text += fmt::format("  DIAM {} {} 0 0 1 \"\"\n", number_text(semi), surface.semi_diameter_mm ? 1 : 0);
  return text + zmx_apertures_text(surface, i);
}

std::string aperture_text(const Aperture& aperture) {
  const std::string value = number_text(aperture.value);
  switch (aperture.kind) {
    case Aperture::Kind::f_number:
      return "FNUM " + value + " 0\n";
    case Aperture::Kind::working_f_number:
      return "FNUM " + value + " 1\n";
    case Aperture::Kind::image_na:
      return "FNUM " + number_text(0.5 / aperture.value) + " 1\n";
    case Aperture::Kind::object_na:
      return "OBNA " + value + " 0\n";
    case Aperture::Kind::entrance_pupil_diameter_mm:
      return "ENPD " + value + "\n";
    case Aperture::Kind::stop_semi_diameter_mm:
      break;
  }
  return "FLOA\n";
}

std::string fields_text(const Lens& lens) {
  const std::vector<double>& values = lens.fields.values;
  std::string x = "XFLN", y = "YFLN", weights = "FWGN";
  for (const double value : values) {
    x += " 0";
    y += fmt::format(" {}", number_text(value));
    weights += " 1";
  }
  return fmt::format("FTYP {} 0 {} {} 0 0 0\n{}\n{}\n{}\n", static_cast<int>(lens.fields.kind), values.size(),
                     lens.wavelengths_nm.size(), x, y, weights);
}

std::string zmx_wavelengths_text(const Lens& lens) {
  const auto& wavelengths = lens.wavelengths_nm;
  const auto reference = std::find(wavelengths.begin(), wavelengths.end(), lens.reference_wavelength_nm);
  if (reference == wavelengths.end())
    throw InputError("reference_wavelength_nm: in a .zmx file it must be one of wavelengths_nm");
  std::string text;
  for (std::size_t i = 0; i < wavelengths.size(); ++i)
    text += fmt::format("WAVM {} {} 1\n", i + 1, scaled_number_text(wavelengths[i], um_per_nm_power));
  return text + fmt::format("PWAV {}\n", reference - wavelengths.begin() + 1);
}

[[noreturn]] void refuse_state(const std::string& path) {
  throw InputError(
      fmt::format("states: Petzval writes no states of {} into a .zmx file; distances, radii, conics, clear "
                  "apertures, glasses "
                  "of catalogues, the stop, the aperture and fields are held",
                  path));
}

/// A glass by its name, "" for air.
std::string state_glass(const Surface& surface, const std::string& path) {
  if (surface.material.is_air() && !surface.mirror) return "\"\"";
  const auto* glass = std::get_if<std::shared_ptr<const Glass>>(&surface.material.kind());
  if (!glass || (*glass)->name.find_first_of(" \t\"") != std::string::npos) refuse_state(path);
  return (*glass)->name;
}

/// One operand of the configurations, and its value in each.
struct ZmxOperand {
  std::string keyword;
  std::size_t place;  ///< the surface or field
  std::vector<std::string> values;
};

/// What an entry of a surface is. \throws InputError for one that no operand holds.
ZmxOperand zmx_surface_operand(const std::vector<Lens>& states, const std::string& path) {
  const std::size_t close = path.find("].");
  if (!path.starts_with("surfaces[") || close == path.npos) refuse_state(path);
  const auto i = static_cast<std::size_t>(std::atoi(path.c_str() + std::string("surfaces[").size()));
  const std::string key = path.substr(close + 2);
  ZmxOperand operand{"", i + 1, {}};
  for (const Lens& state : states) {
    const Surface& surface = state.surfaces[i];
    if (key == "thickness_mm")
      operand.keyword = "THIC", operand.values.push_back(number_text(surface.thickness_mm));
    else if (key == "radius_mm")
      operand.keyword = "CRVT", operand.values.push_back(number_text(surface.curvature_per_mm));
    else if (key == "conic")
      operand.keyword = "CONN", operand.values.push_back(number_text(surface.conic));
    else if (key == "semi_diameter_mm" && surface.semi_diameter_mm)
      operand.keyword = "APMX", operand.values.push_back(number_text(*surface.semi_diameter_mm));
    else if (key == "glass")
      operand.keyword = "GLSS", operand.values.push_back(state_glass(surface, path));
    else if (key == "stop")
      operand = {"STPS", 0, std::move(operand.values)},
      operand.values.push_back(fmt::format("{}", state.stop_index() + 1));
    else
      refuse_state(path);
  }
  return operand;
}

std::vector<ZmxOperand> zmx_operands(const std::vector<Lens>& states, const std::string& path) {
  std::vector<std::string> values;
  if (path == "object_distance_mm") {
    for (const Lens& state : states)
      values.push_back(state.object_distance_mm ? number_text(*state.object_distance_mm)
                                                : std::string("1e10"));
    return {{"THIC", 0, values}};
  }
  if (path.starts_with("aperture.") &&
      states.front().aperture.kind != Aperture::Kind::stop_semi_diameter_mm) {
    for (const Lens& state : states) {
      const bool na = state.aperture.kind == Aperture::Kind::image_na;
      values.push_back(number_text(na ? 0.5 / state.aperture.value : state.aperture.value));
    }
    return {{"APER", 0, values}};
  }
  if (path == "fields.values") {
    std::vector<ZmxOperand> operands;
    for (std::size_t k = 0; k < states.front().fields.values.size(); ++k) {
      operands.push_back({"YFIE", k + 1, {}});
      for (const Lens& state : states) {
        if (state.fields.values.size() != states.front().fields.values.size()) refuse_state(path);
        operands.back().values.push_back(number_text(state.fields.values[k]));
      }
    }
    return operands;
  }
  return {zmx_surface_operand(states, path)};
}

std::vector<Lens> all_states(const Lens& lens) {
  std::vector<Lens> states;
  for (std::size_t i = 0; i < lens.states.size(); ++i)
    states.push_back(in_state(lens, static_cast<double>(i)));
  return states;
}

/// The lens with the glasses of all its states.
Lens with_all_glasses(Lens lens) {
  if (!lens.object_material.is_air()) lens.surfaces.push_back({.material = lens.object_material});
  for (const Lens& state : all_states(lens))
    lens.surfaces.insert(lens.surfaces.end(), state.surfaces.begin(), state.surfaces.end());
  return lens;
}

/// MNUM and its operands, all configurations of one before the next.
std::string zmx_configurations_text(const Lens& lens) {
  if (lens.states.empty()) return "";
  require_centred(lens, "Petzval writes states into .zmx files for centred lenses");
  const std::vector<Lens> states = all_states(lens);
  std::string text = fmt::format("MNUM {} {}\n", states.size(), present_state(lens).value_or(0) + 1);
  std::set<std::string> written;
  for (const StateRow& row : lens.states.rows)
    for (const ZmxOperand& operand : zmx_operands(states, row.path)) {
      if (!written.insert(fmt::format("{} {}", operand.keyword, operand.place)).second) continue;
      for (std::size_t i = 0; i < states.size(); ++i)
        text += fmt::format("{} {} {} {} 0 0 0 1 1 1 0 0 \"\" 0\n", operand.keyword, operand.place, i + 1,
                            operand.values[i]);
    }
  return text;
}

}  // namespace

std::string zmx_text(const Lens& lens) {
  lens.validate();
  const std::vector<std::string> catalogues = catalogue_order(with_all_glasses(lens));
  std::string text = fmt::format("MODE SEQ\nNAME {}\nNOTE 0 {}\nUNIT MM X W X CM MR CPMM\n",
                                 one_line(lens.name), one_line(lens.source));
  text += aperture_text(lens.aperture);
  text += "ENVD 20 1 0\n";
  if (!catalogues.empty()) text += fmt::format("GCAT {}\n", fmt::join(catalogues, " "));
  text += fields_text(lens) + zmx_wavelengths_text(lens);
  text += fmt::format("SURF 0\n  TYPE STANDARD\n  CURV 0.0 0 0 0 0 \"\"\n  DISZ {}\n",
                      lens.object_distance_mm ? number_text(*lens.object_distance_mm) : "INFINITY");
  text += std::visit(ZmxGlassText{0}, lens.object_material.kind());
  const AxisBreaks axis = axis_breaks_of(lens);
  auto next = axis.breaks.begin();
  int number = 1;
  // The first vertex has no gap in front of it: a break of its own holds a shift along the axis.
  if (axis.gap_shift_mm[0] != 0) text += zmx_break_text(Frame(), axis.gap_shift_mm[0], number);
  for (std::size_t i = 0; i <= lens.surfaces.size(); ++i) {
    if (next != axis.breaks.end() && next->surface == i) text += zmx_break_text((next++)->frame, 0, number);
    if (i < lens.surfaces.size())
      text += surface_text(lens, i, lens.surfaces[i].thickness_mm + axis.gap_shift_mm[i + 1], number);
  }
  text += fmt::format("SURF {}\n  TYPE STANDARD\n  CURV 0.0 0 0 0 0 \"\"\n  DISZ 0\n", number);
  return text + zmx_configurations_text(lens);
}

}  // namespace petzval
