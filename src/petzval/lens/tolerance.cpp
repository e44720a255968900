// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens.h>
#include <petzval/lens/shapes/xy_terms.h>
#include <petzval/lens/surface_kind.h>
#include <petzval/lens/tolerance.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace petzval {

namespace {

/// Light of test plates and interferometers [mm]: ISO 10110 counts fringes of the mercury line.
constexpr double fringe_mm = 546.07e-6;

using Apply = void (*)(Lens&, const Tolerance&, double, double);

const char* curved(const Lens& lens, std::size_t surface) {
  return lens.surfaces[surface].curvature_per_mm == 0
             ? "is flat and has no radius; radius_fringes would be right"
             : nullptr;
}
const char* bounded(const Lens& lens, std::size_t surface) {
  return lens.surfaces[surface].semi_diameter_mm
             ? nullptr
             : "has no clear aperture, over which it would be measured; semi_diameter_mm would be right";
}
const char* glass(const Lens& lens, std::size_t surface) {
  return lens.surfaces[surface].material.is_air()
             ? "is followed by air; a surface before glass would be right"
             : nullptr;
}
/// Where astigmatism can be added to the sag.
const char* polynomial(const Lens& lens, std::size_t surface) {
  const Surface& at = lens.surfaces[surface];
  if (at.grating || at.ideal_lens) return "is a grating or an ideal lens; a surface of glass would be right";
  if (at.shape && at.shape->kind != "xy_polynomial" && at.shape->kind != "zernike_sag")
    return "is of a kind to which no polynomial can be added; a conic, even powers of r, xy_polynomial or "
           "zernike_sag would be right";
  for (const auto& [power, coefficient] : at.asphere)
    if (power % 2 != 0 || power > 20)
      return "has odd powers of r or such above 20; even ones up to 20 would be right";
  return bounded(lens, surface);
}
const char* anywhere(const Lens&, std::size_t) {
  return nullptr;
}

void radius_percent(Lens& lens, const Tolerance& at, double x, double) {
  lens.surfaces[at.first].curvature_per_mm /= 1 + x / 100;
}
void radius_mm(Lens& lens, const Tolerance& at, double x, double) {
  double& c = lens.surfaces[at.first].curvature_per_mm;
  c = c / (1 + x * c);
}
/// N fringes in reflection over the clear aperture are a sag that is N λ/2 off at its rim: Δc y²/2.
void radius_fringes(Lens& lens, const Tolerance& at, double x, double) {
  Surface& surface = lens.surfaces[at.first];
  surface.curvature_per_mm += x * fringe_mm / (*surface.semi_diameter_mm * *surface.semi_diameter_mm);
}
/// The conic and even powers of r as a polynomial of x and y over the clear aperture.
AddedShape as_xy_polynomial(const Surface& surface) {
  const double radius = *surface.semi_diameter_mm;
  std::vector<double> terms(5);
  for (const auto& [power, coefficient] : surface.asphere) {
    const auto degree = static_cast<std::size_t>(power), half = degree / 2;
    terms.resize(std::max(terms.size(), degree * (degree + 3) / 2));
    double term = coefficient * std::pow(radius, power);  // of (x² + y²)^half, by the binomial theorem
    for (std::size_t k = 0; k <= half; ++k) {
      terms[degree * (degree + 1) / 2 - 1 + 2 * k] += term;
      term *= static_cast<double>(half - k) / static_cast<double>(k + 1);
    }
  }
  return {"xy_polynomial", {{"normalisation_radius_mm", {radius}}, {"coefficients_mm", terms}}};
}
/// N fringes in reflection are a sag that differs by N λ/2 between the highest and the lowest place of the
/// rim: N λ/4 times ρ² cos 2θ, and ρ² sin 2θ for y.
void irregularity_fringes(Lens& lens, const Tolerance& at, double x, double y) {
  Surface& surface = lens.surfaces[at.first];
  if (!surface.shape) {
    surface.shape = as_xy_polynomial(surface);
    surface.asphere.clear();
  }
  std::vector<double>& terms = surface.shape->parameters["coefficients_mm"];
  const double wider = shape_numbers(surface, "normalisation_radius_mm").at(0) / *surface.semi_diameter_mm;
  const double per_fringe = fringe_mm / 4 * wider * wider;
  if (surface.shape->kind == "xy_polynomial") {
    terms.resize(std::max<std::size_t>(terms.size(), 5));
    terms[2] += x * per_fringe;
    terms[3] += 2 * y * per_fringe;
    terms[4] -= x * per_fringe;
  } else {  // Noll's Z5 and Z6, √6 ρ² sin 2θ and √6 ρ² cos 2θ
    terms.resize(std::max<std::size_t>(terms.size(), 6));
    terms[4] += y * per_fringe / std::sqrt(6.0);
    terms[5] += x * per_fringe / std::sqrt(6.0);
  }
}
void thickness_mm(Lens& lens, const Tolerance& at, double x, double) {
  lens.surfaces[at.first].thickness_mm += x;
}
void melt(Lens& lens, const Tolerance& at, double nd, double vd_percent) {
  Material& material = lens.surfaces[at.first].material;
  const Material::Melt before = material.melt();
  material = material.melted({before.delta_nd + nd, before.delta_vd_percent + vd_percent});
}
void index(Lens& lens, const Tolerance& at, double x, double) {
  melt(lens, at, x, 0);
}
void abbe_percent(Lens& lens, const Tolerance& at, double x, double) {
  melt(lens, at, 0, x);
}
void surface_decentre_mm(Lens& lens, const Tolerance& at, double x, double y) {
  lens.surfaces[at.first].pose.decentre_x_mm += x;
  lens.surfaces[at.first].pose.decentre_y_mm += y;
}
void surface_tilt_deg(Lens& lens, const Tolerance& at, double x, double y) {
  lens.surfaces[at.first].pose.tilt_x_deg += x;
  lens.surfaces[at.first].pose.tilt_y_deg += y;
}
/// How far the dial rises over a turn: twice the tilt times the radius at which it touches.
void runout_mm(Lens& lens, const Tolerance& at, double x, double y) {
  const double per_mm = degrees(1 / (2 * *lens.surfaces[at.first].semi_diameter_mm));
  surface_tilt_deg(lens, at, x * per_mm, y * per_mm);
}
SurfaceGroup& own_group(Lens& lens, const Tolerance& at) {
  lens.groups.push_back({at.first, at.last, {}, 0});
  return lens.groups.back();
}
void element_decentre_mm(Lens& lens, const Tolerance& at, double x, double y) {
  Pose& pose = own_group(lens, at).pose;
  pose.decentre_x_mm = x;
  pose.decentre_y_mm = y;
}
void element_tilt_deg(Lens& lens, const Tolerance& at, double x, double y) {
  Pose& pose = own_group(lens, at).pose;
  pose.tilt_x_deg = x;
  pose.tilt_y_deg = y;
}
void sensor_tilt_deg(Lens& lens, const Tolerance&, double x, double y) {
  lens.sensor_pose.tilt_x_deg += x;
  lens.sensor_pose.tilt_y_deg += y;
}

constexpr ToleranceKind kinds[] = {
    {"radius_percent", "%", "of a radius of curvature", "", false, false, curved, radius_percent},
    {"radius_mm", "mm", "of a radius of curvature", "TRAD DLR", false, false, curved, radius_mm},
    {"radius_fringes", "fringes", "of power, in reflection at 546.07 nm over the clear aperture", "TFRN DLF",
     false, false, bounded, radius_fringes},
    {"irregularity_fringes", "fringes",
     "astigmatic, from peak to valley over the clear aperture, in reflection at 546.07 nm", "IRR", true,
     false, polynomial, irregularity_fringes},
    {"thickness_mm", "mm", "of the gap behind a surface; what lies behind moves along", "TTHI DLT", false,
     false, anywhere, thickness_mm},
    {"index", "", "nd of the glass behind a surface", "TIND DLN", false, false, glass, index},
    {"abbe_percent", "%", "Vd of the glass behind a surface", "", false, false, glass, abbe_percent},
    {"surface_decentre_mm", "mm", "of one surface across the axis", "TSDX TSDY", true, false, anywhere,
     surface_decentre_mm},
    {"surface_tilt_deg", "deg", "of one surface about its vertex", "TSTX TSTY", true, false, anywhere,
     surface_tilt_deg},
    {"runout_mm", "mm", "of one surface: the whole swing of a dial at its clear aperture", "TIR", true, false,
     bounded, runout_mm},
    {"element_decentre_mm", "mm", "of surfaces first to last as one, across the axis", "TEDX TEDY DIS", true,
     true, anywhere, element_decentre_mm},
    {"element_tilt_deg", "deg", "of surfaces first to last as one, about the first vertex", "TETX TETY", true,
     true, anywhere, element_tilt_deg},
    {"sensor_tilt_deg", "deg", "of the sensor about its middle", "", true, false, anywhere, sensor_tilt_deg}};

struct Grade {
  const char* name;
  double radius_percent, radius_fringes, thickness_mm, index, abbe_percent, runout_mm, decentre_mm, tilt_deg,
      irregularity_fringes;
};
constexpr Grade grades[] = {{"commercial", 0.2, 5, 0.15, 1e-3, 0.8, 0.05, 0.075, 0.1, 2},
                            {"precision", 0.1, 3, 0.05, 5e-4, 0.5, 0.01, 0.025, 0.05, 0.5},
                            {"high", 0.05, 1, 0.01, 2e-4, 0.2, 0.005, 0.01, 0.02, 0.1}};
constexpr const char* grade_names[] = {"commercial", "precision", "high"};

std::string kind_names() {
  std::vector<std::string> names;
  for (const ToleranceKind& kind : kinds) names.emplace_back(kind.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

const ToleranceKind& kind_of(const Tolerance& tolerance) {
  if (const ToleranceKind* kind = find_tolerance_kind(tolerance.kind)) return *kind;
  throw InputError(
      fmt::format("\"{}\" is not a kind of tolerance; there are {}", tolerance.kind, kind_names()));
}

std::optional<std::size_t> index_in(std::string_view text) {
  const auto number = parse_integer(std::string(text));
  if (!number || *number < 0) return {};
  return static_cast<std::size_t>(*number);
}

}  // namespace

std::span<const ToleranceKind> tolerance_kinds() {
  return kinds;
}

const ToleranceKind* find_tolerance_kind(std::string_view name) {
  for (const ToleranceKind& kind : kinds) {
    if (name == kind.name) return &kind;
    std::istringstream aliases(kind.aliases);
    for (std::string alias; aliases >> alias;)
      if (name == alias) return &kind;
  }
  return nullptr;
}

void check(const Lens& lens, const Tolerance& tolerance) {
  const ToleranceKind& kind = kind_of(tolerance);
  const std::size_t count = lens.surfaces.size();
  if (tolerance.first > tolerance.last || tolerance.last >= count)
    throw InputError(fmt::format("{}: there is no such surface; the lens has {}, 0 to {}",
                                 place_of(tolerance), count, count - 1));
  if (!kind.of_elements && tolerance.first != tolerance.last)
    throw InputError(fmt::format("{}: one surface would be right", place_of(tolerance)));
  if (const char* fault = kind.unusable(lens, tolerance.first))
    throw InputError(fmt::format("{}: surfaces[{}] {}", place_of(tolerance), tolerance.first, fault));
  if (!(tolerance.limit > 0) || !std::isfinite(tolerance.limit))
    throw InputError(fmt::format("{}: a limit of {:g}; a positive number{}{} would be right",
                                 place_of(tolerance), tolerance.limit, *kind.unit ? " of " : "", kind.unit));
}

Lens with_error(Lens lens, const Tolerance& tolerance, double x, double y) {
  check(lens, tolerance);
  kind_of(tolerance).apply(lens, tolerance, x, y);
  return lens;
}

std::span<const char* const> tolerance_grades() {
  return grade_names;
}

std::vector<std::pair<std::size_t, std::size_t>> elements_of(const Lens& lens) {
  std::vector<std::pair<std::size_t, std::size_t>> elements;
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
    if (lens.surfaces[i].material.is_air()) continue;
    const std::size_t first = i;
    while (i + 1 < lens.surfaces.size() && !lens.surfaces[i].material.is_air()) ++i;
    elements.emplace_back(first, i);
  }
  return elements;
}

std::vector<Tolerance> graded_tolerances(const Lens& lens, std::string_view name) {
  const Grade* grade =
      std::ranges::find(grades, name, [](const Grade& each) { return std::string_view(each.name); });
  if (grade == std::end(grades))
    throw InputError(
        fmt::format("\"{}\" is not a grade of tolerances; there are {}", name, fmt::join(grade_names, ", ")));
  std::vector<Tolerance> tolerances;
  const auto add = [&](const char* kind, std::size_t first, std::size_t last, double limit) {
    tolerances.push_back({kind, first, last, limit});
  };
  for (const auto& [first, last] : elements_of(lens)) {
    for (std::size_t i = first; i <= last; ++i) {
      const Surface& surface = lens.surfaces[i];
      if (surface.curvature_per_mm != 0)
        add("radius_percent", i, i, grade->radius_percent);
      else if (surface.semi_diameter_mm)
        add("radius_fringes", i, i, grade->radius_fringes);
      if (surface.semi_diameter_mm) add("runout_mm", i, i, grade->runout_mm);
      if (i == last) break;
      add("thickness_mm", i, i, grade->thickness_mm);
      add("index", i, i, grade->index);
      add("abbe_percent", i, i, grade->abbe_percent);
    }
    add("element_decentre_mm", first, last, grade->decentre_mm);
    add("element_tilt_deg", first, last, grade->tilt_deg);
    // The air behind, but for the distance to the sensor, which is focused.
    if (last + 1 < lens.surfaces.size()) add("thickness_mm", last, last, grade->thickness_mm);
  }
  // Last: what is drawn for the others does not depend on them.
  for (const auto& [first, last] : elements_of(lens))
    for (std::size_t i = first; i <= last; ++i)
      if (!polynomial(lens, i)) add("irregularity_fringes", i, i, grade->irregularity_fringes);
  return tolerances;
}

Tolerance parse_tolerance(std::string_view text) {
  const auto wrong = [&] {
    return InputError(
        fmt::format("\"{}\" is not a tolerance; write it like radius_percent@2=0.1 or "
                    "element_tilt_deg@2-3=0.05",
                    text));
  };
  const std::size_t at = text.find('@'), equals = text.find('=');
  if (at == text.npos || equals == text.npos || equals < at) throw wrong();
  const std::string_view surfaces = text.substr(at + 1, equals - at - 1);
  const std::size_t dash = surfaces.find('-');
  const auto first = index_in(surfaces.substr(0, dash));
  const auto last = dash == surfaces.npos ? first : index_in(surfaces.substr(dash + 1));
  const auto limit = parse_number(std::string(text.substr(equals + 1)));
  if (!first || !last || !limit) throw wrong();
  Tolerance tolerance{std::string(text.substr(0, at)), *first, *last, *limit};
  tolerance.kind = kind_of(tolerance).name;
  return tolerance;
}

std::vector<Tolerance> parse_tolerances(std::string_view text) {
  if (!text.starts_with("3/") && !text.starts_with("4/")) return {parse_tolerance(text)};
  const auto wrong = [&] {
    return InputError(
        fmt::format("\"{}\" is not a tolerance of ISO 10110; 3/POWER(IRREGULARITY)@SURFACE in fringes or "
                    "4/TILT@SURFACE in minutes of arc would be right",
                    text));
  };
  const std::size_t at = text.find('@');
  const auto surface = at == text.npos ? std::nullopt : index_in(text.substr(at + 1));
  if (!surface) throw wrong();
  std::vector<Tolerance> tolerances;
  const auto add = [&](const char* kind, std::string_view number, double unit) {
    if (number == "-") return;
    const auto limit = parse_number(std::string(number));
    if (!limit) throw wrong();
    tolerances.push_back({kind, *surface, *surface, *limit * unit});
  };
  const std::string_view limits = text.substr(2, at - 2);
  if (text.front() == '4') {
    add("surface_tilt_deg", limits.substr(0, limits.find('\'')), 1 / 60.0);
  } else {
    const std::size_t open = limits.find('(');
    add("radius_fringes", limits.substr(0, open), 1);
    if (open != limits.npos) {
      if (limits.back() != ')') throw wrong();
      add("irregularity_fringes", limits.substr(open + 1, limits.size() - open - 2), 1);
    }
  }
  if (tolerances.empty()) throw wrong();
  return tolerances;
}

std::string place_of(const Tolerance& tolerance) {
  return tolerance.first == tolerance.last
             ? fmt::format("{}@{}", tolerance.kind, tolerance.first)
             : fmt::format("{}@{}-{}", tolerance.kind, tolerance.first, tolerance.last);
}

}  // namespace petzval
