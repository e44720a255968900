// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/units.h>
#include <petzval/base/wavelength.h>
#include <petzval/glass/packed_catalogue.h>
#include <petzval/lens/formats/axis_breaks.h>
#include <petzval/lens/formats/seq.h>
#include <petzval/lens/formats/seq_surfaces.h>
#include <petzval/lens/lens_fault.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr std::array<std::string_view, 6> seq_grating_words{"GRT", "GRO", "GRS", "GRX", "GRY", "GRZ"};

constexpr std::array<std::string_view, 8> seq_aperture_words{"CIR", "REX", "REY", "ELX",
                                                             "ELY", "ADX", "ADY", "ARO"};

/// CODE V writes an infinite distance as 10^13 and takes any from 10^10 on for one.
constexpr double seq_infinite_distance = 1e10;

/// A private glass of one index everywhere has no dispersion.
Material private_material(const Material::Table& table) {
  const bool constant = std::all_of(table.begin(), table.end(),
                                    [&](const auto& entry) { return entry.second == table.front().second; });
  return constant ? Material(Material::Constant{table.front().second}) : Material(table);
}

/// Power of r whose coefficient a letter is, 0 for none.
int asphere_power(const std::string& name) {
  if (name.size() != 1) return 0;
  const std::size_t letter = seq_asphere_letters.find(name[0]);
  return letter == seq_asphere_letters.npos ? 0 : seq_lowest_asphere_power + 2 * static_cast<int>(letter);
}

/// Number of a term of SPS ODD by its name: K, AR3, C4, NRADIUS; 0 for none.
int odd_term(const std::string& name) {
  if (name == "K") return 1;
  if (name == "NRADIUS") return seq_odd_radius_term;
  const bool by_power = name.substr(0, 2) == "AR", by_number = !by_power && name.substr(0, 1) == "C";
  const auto number = parse_integer(name.substr(std::min<std::size_t>(name.size(), by_power ? 2 : 1)));
  if ((!by_power && !by_number) || !number || *number > seq_odd_radius_term) return 0;
  const int term = *number + (by_power ? 1 : 0);
  const bool known = (term >= (by_power ? 2 : 1) && term <= seq_highest_odd_power + 1) ||
                     (by_number && term == seq_odd_radius_term);
  return known ? term : 0;
}

/// A value of the present system that a solve or a pickup gives: CODE V writes the number on the surface's
/// line.
bool is_solve(const SeqCommand& command, std::size_t first) {
  return command.has(first) && !parse_number(command.words[first]) && command.words[first].size() >= 3;
}

}  // namespace

std::string SeqSurfaces::where() const {
  if (surfaces_.empty()) return "";
  if (current_ == 0) return "SO: ";
  return ended_ && current_ + 1 == surfaces_.size() ? "SI: " : fmt::format("S{}: ", current_);
}

int SeqSurfaces::line_of(std::size_t i) const {
  return surfaces_[std::min(i + 1, surfaces_.size() - 1)].command.line;
}

bool SeqSurfaces::wants_image_distance() const {
  if (surfaces_.size() < 2) return false;
  const SeqSurface& last = surfaces_[surfaces_.size() - 2];
  return last.solves_image_distance && last.thickness == 0;
}

double SeqSurfaces::curvature(const SeqCommand& command, std::size_t i, bool is_radius,
                              const SeqContext& context) const {
  const double value = context.number(command, i, where());
  if (!is_radius || value == 0) return value;
  return curvature_from_radius(command.words[i]);
}

/// PRV, PWL and 'NAME' n1 n2 …, END.
bool SeqSurfaces::apply_private(const SeqCommand& command, const SeqContext& context) {
  if (command.name == "PRV") {
    in_private_ = true;
    return true;
  }
  if (!in_private_) return false;
  if (command.name == "END") {
    in_private_ = false;
  } else if (command.name == "PWL") {
    private_wavelengths_nm_ = context.numbers(command);
    for (const double nm : private_wavelengths_nm_)
      if (const std::string wrong = wavelength_fault(nm); !wrong.empty()) context.fail(command, wrong);
  } else {
    std::vector<double> indices;
    for (const std::string& word : command.words) {
      if (!parse_number(word))
        throw InputError(
            context.file, command.line,
            fmt::format("private glass '{}': only indices at the wavelengths of PWL are read, not "
                        "\"{}\"",
                        quotable(command.name), quotable(word)));
      indices.push_back(*parse_number(word));
    }
    Material::Table table;
    if (indices.empty() || indices.size() != private_wavelengths_nm_.size())
      throw InputError(context.file, command.line,
                       fmt::format("private glass '{}': {} indices for the {} wavelengths of PWL",
                                   quotable(command.name), indices.size(), private_wavelengths_nm_.size()));
    for (std::size_t i = 0; i < indices.size(); ++i)
      table.emplace_back(private_wavelengths_nm_[i], indices[i]);
    std::sort(table.begin(), table.end());
    try {
      private_[upper_case(command.name)] = private_material(table);
    } catch (const InputError& error) {
      throw InputError(context.file, command.line, error.what());
    }
  }
  return true;
}

bool SeqSurfaces::enter_surface(const SeqCommand& command, const SeqContext& context) {
  using Kind = SeqSurfaceName::Kind;
  const auto name = seq_surface_name(command.name);
  if (!name) return false;
  const auto count = static_cast<int>(surfaces_.size());
  if (name->kind == Kind::object) {
    if (count > 0) context.fail(command, "stands a second time; the object comes once, and first");
  } else if (count == 0) {
    context.fail(command, "comes before the object surface; SO must be the first");
  }
  if (surfaces_.size() > most_surfaces) context.fail(command, "is one surface too many");
  const bool numbered = name->kind == Kind::numbered;
  if (numbered && (name->number > count || (ended_ && name->number >= count)))
    context.fail(command, fmt::format("is not the next surface, which is S{}", count));
  if (!numbered && ended_) context.fail(command, "comes after the image surface SI");
  current_ = numbered ? static_cast<std::size_t>(name->number) : surfaces_.size();
  if (current_ == surfaces_.size()) surfaces_.emplace_back();
  if (name->kind == Kind::image) ended_ = true;
  SeqSurface& surface = surfaces_[current_] = SeqSurface();
  surface.command = command;
  if (command.has(0)) surface.curvature = curvature(command, 0, radius_mode_, context);
  if (command.has(1)) surface.thickness = context.number(command, 1, where());
  for (std::size_t i = 2; i < command.words.size(); ++i) {
    const std::string word = upper_case(command.words[i]);
    if (word == "REFL") surface.mirror = true;
    if (word == "REFL" || word == "REFR") continue;
    if (i > 2) context.fail(command, fmt::format("has a \"{}\" that is not read", quotable(word)), where());
    surface.glass = SeqCommand{command.line, command.name, {command.words[i]}};
  }
  return true;
}

std::size_t SeqSurfaces::target(const SeqCommand& command, std::size_t& first_word,
                                const SeqContext& context) const {
  using Kind = SeqSurfaceName::Kind;
  if (surfaces_.empty()) context.fail(command, "comes before the first surface");
  const auto name = command.has(0) ? seq_surface_name(command.words[0]) : std::nullopt;
  if (!name || name->kind == Kind::next) return current_;
  first_word = 1;
  if (name->kind == Kind::object) return 0;
  if (name->kind == Kind::image) return surfaces_.size() - 1;
  if (name->number >= static_cast<int>(surfaces_.size()))
    context.fail(command, fmt::format("is for S{}, which is not there", name->number));
  return static_cast<std::size_t>(name->number);
}

/// CIR, REX, REY, ELX, ELY, ADX, ADY or ARO [EDG | OBS | HOL] number: an edge is where the glass ends, and
/// not clear aperture.
void SeqSurfaces::apply_aperture(SeqSurface& surface, const SeqCommand& command, std::size_t first,
                                 const SeqContext& context) {
  bool is_edge = false, obscures = false;
  for (std::size_t i = first; i < command.words.size(); ++i) {
    const std::string word = upper_case(command.words[i]);
    if (word == "EDG") is_edge = true;
    if (word == "OBS") obscures = true;
    if (word == "HOL") surface.has_hole = obscures = true;
    if (!parse_number(word)) continue;
    if (is_edge) return;
    const double value = *parse_number(word);
    const std::string& name = command.name;
    SeqSurface::Figure& figure = obscures ? surface.obscuring : surface.clear;
    if (name == "ADX") return void(figure.x = value);
    if (name == "ADY") return void(figure.y = value);
    if (name == "ARO") return void(figure.turn_deg = value);
    if (!(value >= 0)) context.fail(command, "must be a radius or half a width, not negative", where());
    if (value == 0) return;
    if (name == "CIR" && !obscures) surface.semi_diameter = value;
    if (name == "CIR" && obscures) figure.ellipse_x = figure.ellipse_y = value;
    if (name == "REX") figure.rectangle_x = value;
    if (name == "REY") figure.rectangle_y = value;
    if (name == "ELX") figure.ellipse_x = value;
    if (name == "ELY") figure.ellipse_y = value;
    return;
  }
  context.fail(command, "must have a radius or another number", where());
}

void SeqSurfaces::put_apertures(const SeqSurface& from, double mm_per_unit, const SeqContext& context,
                                Surface& surface) const {
  if (from.semi_diameter) surface.semi_diameter_mm = *from.semi_diameter * mm_per_unit;
  for (const bool obscures : {false, true}) {
    const SeqSurface::Figure& figure = obscures ? from.obscuring : from.clear;
    const auto add = [&](ApertureFigure::Kind kind, const std::optional<double>& x,
                         const std::optional<double>& y, const char* names) {
      if (!x && !y) return;
      if (!x || !y) context.fail(from.command, fmt::format("needs both of {} for its aperture", names));
      surface.apertures.push_back({kind, *x * mm_per_unit, *y * mm_per_unit, figure.x * mm_per_unit,
                                   figure.y * mm_per_unit, figure.turn_deg, obscures});
    };
    add(ApertureFigure::Kind::rectangle, figure.rectangle_x, figure.rectangle_y, "REX and REY");
    add(ApertureFigure::Kind::ellipse, figure.ellipse_x, figure.ellipse_y, "ELX and ELY");
  }
  if (from.has_hole && !from.mirror)
    context.fail(from.command, "has a hole (HOL) and is no mirror, which is not modelled");
  // A round aperture off its middle is a figure.
  if (!surface.semi_diameter_mm || (from.clear.x == 0 && from.clear.y == 0)) return;
  const double radius_mm = *surface.semi_diameter_mm;
  surface.semi_diameter_mm.reset();
  surface.apertures.push_back({ApertureFigure::Kind::ellipse, radius_mm, radius_mm,
                               from.clear.x * mm_per_unit, from.clear.y * mm_per_unit, 0, false});
}

bool SeqSurfaces::apply_grating(SeqSurface& surface, const SeqCommand& command, std::size_t first,
                                const SeqContext& context) {
  const auto word = std::find(seq_grating_words.begin(), seq_grating_words.end(), command.name);
  if (word == seq_grating_words.end()) return false;
  if (command.name == "GRT") {
    surface.ruled = true;
    return true;
  }
  const double value = context.number(command, first, where());
  if (command.name == "GRO")
    surface.order = value;
  else if (command.name == "GRS")
    surface.spacing = value;
  else
    surface.ruling_normal[static_cast<std::size_t>(word - seq_grating_words.begin()) - 3] = value;
  return true;
}

/// Lines that planes cut which stand upright on the surface.
void SeqSurfaces::put_grating(const SeqSurface& from, double mm_per_unit, const SeqContext& context,
                              Surface& surface) const {
  if (!from.ruled) return;
  const auto& [x, y, z] = from.ruling_normal;
  if (!(from.spacing > 0)) context.fail(from.command, "is a grating (GRT) without a positive spacing (GRS)");
  if (z != 0 || (x == 0 && y == 0))
    context.fail(from.command,
                 "is a grating whose lines lie oblique to the surface (GRZ), which is not modelled");
  surface.grating = Grating{1 / (from.spacing * mm_per_unit), from.order, degrees(std::atan2(-x, y))};
  if (x == 0) surface.grating->rotation_deg = y > 0 ? 0 : 180;
}

void SeqSurfaces::apply_special(SeqSurface& surface, const SeqCommand& command, std::size_t first,
                                const SeqContext& context) {
  const std::string kind = command.has(first) ? upper_case(command.words[first]).substr(0, 3) : "";
  if (kind != "ODD")
    context.fail(command, fmt::format("{} (a special surface) is not modelled; SPS ODD is", quotable(kind)),
                 where());
  surface.odd_polynomial = true;
  surface.asphere.clear();
  surface.odd_radius = command.has(first + 1) ? context.number(command, first + 1, where()) : 0;
}

void SeqSurfaces::apply_coefficient(SeqSurface& surface, const SeqCommand& command, std::size_t first,
                                    const SeqContext& context) {
  if (!surface.odd_polynomial)
    context.fail(command, "is a coefficient of a special surface, and no SPS ODD comes before it", where());
  const std::string name = command.has(first) ? upper_case(command.words[first]) : "";
  const int term = odd_term(name);
  if (term == 0)
    context.fail(command,
                 fmt::format("{} is not modelled; K, AR1 to AR{}, C1 to C{} and NRADIUS are", quotable(name),
                             seq_highest_odd_power, seq_highest_odd_power + 1),
                 where());
  const double value = context.number(command, first + 1, where());
  if (term == 1)
    surface.conic = value;
  else if (term == seq_odd_radius_term)
    surface.odd_radius = value;
  else
    surface.asphere[term - 1] = value;
}

/// Decentres and tilts of a surface, and how they go on behind it.
bool SeqSurfaces::apply_decentre(SeqSurface& surface, const SeqCommand& command, std::size_t first,
                                 const SeqContext& context) {
  const auto name = std::find(seq_decentres.begin(), seq_decentres.end(), command.name);
  if (name != seq_decentres.end())
    surface.decentre[static_cast<std::size_t>(name - seq_decentres.begin())] =
        context.number(command, first, where());
  else if (command.name == "DAR")
    surface.axes = SeqSurface::Axes::come_back;
  else if (command.name == "BEN")
    surface.axes = SeqSurface::Axes::bend;
  else if (command.name == "REV")
    surface.axes = SeqSurface::Axes::turn_back;
  else if (command.name == "RET" || command.name == "GLB")
    surface.axes = SeqSurface::Axes::other;
  else
    return false;
  return true;
}

/// CODE V turns left-handed about x and y and right-handed about z, after it has moved (CODE V Reference
/// Manual, "Tilted and Decentered Systems"). BEN: the axes are turned a second time behind the surface, so
/// that a mirror throws the axis where they point. REV: the surface stands as it is, and behind it the axes
/// move and turn the other way round.
void SeqSurfaces::put_poses(Lens& lens, double mm_per_unit, const SeqContext& context) const {
  std::vector<AxisBreak> breaks;
  const bool any = std::any_of(surfaces_.begin(), surfaces_.end(), [](const SeqSurface& surface) {
    return surface.decentre != std::array<double, 6>{};
  });
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    if (any && surfaces_[i].axes == SeqSurface::Axes::other)
      context.fail(
          surfaces_[i].command,
          fmt::format(
              "S{} refers its axes to others (RET or GLB), which is not modelled; DAR, REV and BEN are", i));
    const auto& [xde, yde, zde, ade, bde, cde] = surfaces_[i].decentre;
    const Pose pose{xde * mm_per_unit, yde * mm_per_unit, zde * mm_per_unit, -ade, -bde, cde};
    if (pose.is_none()) continue;
    if (i == 0) context.fail(surfaces_[i].command, "is a tilted or decentred object, which is not modelled");
    const std::size_t surface = i - 1, sensor = lens.surfaces.size();
    if (surface < sensor && surfaces_[i].axes == SeqSurface::Axes::come_back) {
      lens.surfaces[surface].pose = pose;
      continue;
    }
    if (surface < sensor && surfaces_[i].axes == SeqSurface::Axes::turn_back) {
      breaks.push_back({surface + 1, inverse(frame_of(pose)), -lens.surfaces[surface].thickness_mm});
      continue;
    }
    breaks.push_back({surface, frame_of(pose), 0});
    if (surface == sensor || surfaces_[i].axes != SeqSurface::Axes::bend) continue;
    Frame turn = frame_of(pose);
    turn.offset_mm = {};
    breaks.push_back({surface + 1, turn, -lens.surfaces[surface].thickness_mm});
  }
  put_axis_breaks(breaks, lens);
}

bool SeqSurfaces::apply_shape(SeqSurface& surface, const SeqCommand& command, std::size_t first,
                              const SeqContext& context) {
  const std::string& name = command.name;
  if ((name == "RDY" || name == "CUY" || name == "THI") && is_solve(command, first)) {
    context.notes.push_back(fmt::format("{}:{}: {}{}: a solve; the number on the surface's own line counts",
                                        context.file, command.line, where(), name));
  } else if (name == "SPS") {
    apply_special(surface, command, first, context);
  } else if (name == "SCO") {
    apply_coefficient(surface, command, first, context);
  } else if (name == "RDY" || name == "CUY") {
    surface.curvature = curvature(command, first, name == "RDY", context);
  } else if (name == "THI") {
    surface.thickness = context.number(command, first, where());
  } else if (name == "K") {
    surface.conic = context.number(command, first, where());
  } else if (const int power = asphere_power(name)) {
    surface.asphere[power] = context.number(command, first, where());
  } else if (name == "GLA" || name == "GL1") {
    if (!command.has(first)) context.fail(command, "must have a glass", where());
    surface.mirror = upper_case(command.words[first]) == "REFL";
    if (surface.mirror) return true;
    surface.glass = SeqCommand{command.line, name, {command.words[first]}};
  } else if (std::find(seq_aperture_words.begin(), seq_aperture_words.end(), name) !=
             seq_aperture_words.end()) {
    apply_aperture(surface, command, first, context);
  } else if (apply_decentre(surface, command, first, context) ||
             apply_grating(surface, command, first, context)) {
    return true;
  } else if (name == "PIM") {
    surface.solves_image_distance = true;
  } else if (name == "SPH") {
    surface.conic = 0;
    surface.asphere.clear();
    surface.odd_polynomial = false;
  } else if (name == "RMD") {
    const std::string mode = command.has(first) ? upper_case(command.words[first]).substr(0, 4) : "REFR";
    if (mode != "REFR" && mode != "REFL")
      context.fail(command,
                   fmt::format("{} is not modelled; REFR and REFL are", quotable(command.words[first])),
                   where());
    surface.mirror = mode == "REFL";
  } else {
    return false;
  }
  return true;
}

bool SeqSurfaces::apply(const SeqCommand& command, const SeqContext& context) {
  if (apply_private(command, context)) return true;
  if (command.name == "RDM") {
    radius_mode_ = !command.has(0) || upper_case(command.words[0]).substr(0, 1) != "N";
    return true;
  }
  if (enter_surface(command, context)) return true;
  static const std::vector<std::string> names{"STO", "RDY", "CUY", "THI", "K",   "GLA", "GL1", "PIM",
                                              "SPH", "RMD", "SPS", "SCO", "XDE", "YDE", "ZDE", "ADE",
                                              "BDE", "CDE", "DAR", "BEN", "REV", "RET", "GLB"};
  if (std::find(names.begin(), names.end(), command.name) == names.end() &&
      std::find(seq_aperture_words.begin(), seq_aperture_words.end(), command.name) ==
          seq_aperture_words.end() &&
      std::find(seq_grating_words.begin(), seq_grating_words.end(), command.name) ==
          seq_grating_words.end() &&
      !asphere_power(command.name))
    return false;
  std::size_t first = 0;
  const std::size_t surface = target(command, first, context);
  if (command.name != "STO") return apply_shape(surfaces_[surface], command, first, context);
  stop_ = surface;
  return true;
}

void SeqSurfaces::put_into(Lens& lens, double mm_per_unit, const SeqContext& context,
                           GlassLookup& glasses) const {
  constexpr std::size_t fewest_surfaces = 3;
  if (surfaces_.size() < fewest_surfaces || !ended_)
    throw InputError(
        context.file,
        "does not enter a whole lens; it needs the object SO, at least one surface S and the image SI");
  const auto check_end = [&](const SeqSurface& end, const char* what) {
    const bool object = &end == &surfaces_.front();
    if (end.curvature != 0 || !end.asphere.empty() || (end.glass && !object))
      context.fail(end.command,
                   fmt::format("is a curved {} surface or one with glass behind it, which is not "
                               "modelled",
                               what));
  };
  check_end(surfaces_.front(), "object");
  check_end(surfaces_.back(), "image");
  const auto material_of = [&](const SeqSurface& from, const std::string& place) {
    try {
      return seq_glass(from.glass->words[0], private_, glasses);
    } catch (const InputError& error) {
      return glasses.missing(
          InputError(context.file, from.glass->line, fmt::format("{}: {}", place, error.what())),
          from.glass->words[0], place);
    }
  };
  if (surfaces_.front().glass) lens.object_material = material_of(surfaces_.front(), "SO");
  const double object = surfaces_.front().thickness;
  lens.object_distance_mm.reset();
  if (!(std::abs(object) >= seq_infinite_distance)) lens.object_distance_mm = object * mm_per_unit;
  const std::size_t stop = stop_.value_or(1);
  if (!stop_) context.notes.push_back(context.file + ": no STO; the stop is the first surface");
  if (stop == 0 || stop + 1 == surfaces_.size())
    throw InputError(context.file, "has its stop STO on the object or the image surface");
  for (std::size_t i = 1; i + 1 < surfaces_.size(); ++i) {
    const SeqSurface& from = surfaces_[i];
    Surface surface;
    surface.curvature_per_mm = from.curvature / mm_per_unit;
    if (!(std::abs(from.thickness) < seq_infinite_distance))
      context.fail(from.command, "is infinitely far from the next surface; only the object may be");
    surface.thickness_mm = from.thickness * mm_per_unit;
    surface.conic = from.conic;
    if (from.odd_radius < 0)
      context.fail(from.command, "has a negative NRADIUS; a positive one, or 0 for none, would be right");
    const double radius_mm = mm_per_unit * (from.odd_radius > 0 ? from.odd_radius : 1);
    for (const auto& [power, value] : from.asphere)
      // One that is zero, or too small for a number in mm, is no term.
      if (const double scaled = value * mm_per_unit * std::pow(radius_mm, -power); scaled != 0)
        surface.asphere[power] = scaled;
    put_apertures(from, mm_per_unit, context, surface);
    put_grating(from, mm_per_unit, context, surface);
    surface.stop = i == stop;
    surface.mirror = from.mirror;
    if (from.glass && !from.mirror) surface.material = material_of(from, fmt::format("S{}", i));
    lens.surfaces.push_back(std::move(surface));
  }
  glasses.require_all_found();
  put_poses(lens, mm_per_unit, context);
}

}  // namespace petzval
