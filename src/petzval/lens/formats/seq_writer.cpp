// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/formats/axis_breaks.h>
#include <petzval/lens/formats/seq.h>
#include <petzval/lens/formats/seq_glass.h>
#include <petzval/lens/lens_states.h>
#include <petzval/lens/pose.h>
#include <petzval/lens/surface_shape.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace petzval {

namespace {

/// A constant index has no place of its own; as a private glass it stands at two wavelengths, and a reader
/// takes equal indices for a constant.
const Material::Table constant_at{{100, 0}, {100000, 0}};

/// How far an object at infinity is.
constexpr double seq_infinity = 1e13;

[[noreturn]] void refuse(std::size_t surface, const char* key, const std::string& why) {
  throw InputError(fmt::format("surfaces[{}].{}: a .seq file cannot hold {}", surface, key, why));
}

/// Titles as one line in single quotes.
std::string title_text(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == '\''; }, ' ');
  return fmt::format("'{}'", text);
}

std::string numbers_text(const std::vector<double>& numbers) {
  std::vector<std::string> texts;
  for (const double number : numbers) texts.push_back(number_text(number));
  return fmt::format("{}", fmt::join(texts, " "));
}

/// Names of glasses, and the private glasses that they need.
struct SeqGlassText {
  std::size_t surface;
  std::string& private_glasses;

  std::string operator()(const Material::Air&) const { return ""; }
  std::string operator()(const std::shared_ptr<const Glass>& glass) const {
    return fmt::format(" {}", guarded([&] { return seq_glass_name(*glass); }));
  }
  std::string operator()(const Material::Model& model) const {
    return fmt::format(" {}", guarded([&] { return fictitious_glass_text(model); }));
  }
  std::string operator()(const Material::Constant& constant) const {
    Material::Table table = constant_at;
    for (auto& entry : table) entry.second = constant.index;
    return (*this)(table);
  }
  std::string operator()(const Material::Table& table) const {
    const std::string name = fmt::format("G{}", surface + 1);
    std::vector<double> wavelengths_nm, indices;
    for (const auto& [wavelength_nm, index] : table) {
      wavelengths_nm.push_back(wavelength_nm);
      indices.push_back(index);
    }
    private_glasses +=
        fmt::format("PWL {}\n'{}' {}\n", numbers_text(wavelengths_nm), name, numbers_text(indices));
    return fmt::format(" '{}'", name);
  }

 private:
  template <typename Make>
  std::string guarded(Make make) const {
    try {
      return make();
    } catch (const InputError& error) {
      refuse(surface, "glass", error.what());
    }
  }
};

/// Powers that ASP has no letters for.
bool is_odd_polynomial(const Surface& surface) {
  return std::any_of(surface.asphere.begin(), surface.asphere.end(), [](const auto& term) {
    const int letter = (term.first - seq_lowest_asphere_power) / 2;
    return term.first % 2 != 0 || term.first < seq_lowest_asphere_power ||
           letter >= static_cast<int>(seq_asphere_letters.size());
  });
}

std::string odd_polynomial_text(const Surface& surface, std::size_t i) {
  std::string text = fmt::format("  SPS ODD 0.0\n  SCO K {}\n", number_text(surface.conic));
  for (const auto& [power, coefficient] : surface.asphere) {
    if (power > seq_highest_odd_power)
      refuse(i, "asphere", fmt::format("r^{}; it holds powers up to {}", power, seq_highest_odd_power));
    text += fmt::format("  SCO AR{} {}\n", power, number_text(coefficient));
  }
  return text;
}

std::string asphere_text(const Surface& surface, std::size_t i) {
  if (is_odd_polynomial(surface)) return odd_polynomial_text(surface, i);
  std::string text = "  ASP\n";
  if (surface.conic != 0) text += fmt::format("  K {}\n", number_text(surface.conic));
  for (const auto& [power, coefficient] : surface.asphere) {
    const auto letter = static_cast<std::size_t>((power - seq_lowest_asphere_power) / 2);
    text += fmt::format("  {} {}\n", seq_asphere_letters[letter], number_text(coefficient));
  }
  return text;
}

/// One figure that passes light, and one that obscures.
std::string seq_apertures_text(const Surface& surface, std::size_t i) {
  std::string text;
  bool taken[2] = {};
  for (const ApertureFigure& figure : surface.apertures) {
    const bool moved = figure.decentre_x_mm != 0 || figure.decentre_y_mm != 0;
    if (std::exchange(taken[figure.obscures], true) ||
        (!figure.obscures && moved && surface.semi_diameter_mm))
      refuse(i, "apertures",
             "more than one aperture and one obscuration, or a round one beside one off the middle");
    const std::string which = figure.obscures ? "OBS " : "";
    const auto line = [&](const std::string& name, double value) {
      text += fmt::format("  {} {}{}\n", name, which, number_text(value));
    };
    const std::string kind = figure.kind == ApertureFigure::Kind::rectangle ? "RE" : "EL";
    line(kind + "X", figure.half_width_x_mm);
    line(kind + "Y", figure.half_width_y_mm);
    if (figure.decentre_x_mm != 0) line("ADX", figure.decentre_x_mm);
    if (figure.decentre_y_mm != 0) line("ADY", figure.decentre_y_mm);
    if (figure.rotation_deg != 0) line("ARO", figure.rotation_deg);
  }
  return text;
}

/// The axes in front of a surface, and from there on.
std::string seq_break_text(const Frame& frame) {
  const Pose pose = pose_of(frame);
  const double values[] = {pose.decentre_x_mm, pose.decentre_y_mm, pose.shift_z_mm,
                           -pose.tilt_x_deg,   -pose.tilt_y_deg,   pose.tilt_z_deg};
  std::string text;
  for (std::size_t i = 0; i < seq_decentres.size(); ++i)
    if (values[i] != 0) text += fmt::format("  {} {}\n", seq_decentres[i], number_text(values[i]));
  return text;
}

std::string grating_text(const Grating& grating) {
  std::string text = fmt::format("  GRT\n  GRO {}\n  GRS {}\n", number_text(grating.order),
                                 number_text(1 / grating.lines_per_mm));
  if (grating.rotation_deg == 0) return text;
  const double turn = radians(grating.rotation_deg);
  return text +
         fmt::format("  GRX {}\n  GRY {}\n", number_text(-std::sin(turn)), number_text(std::cos(turn)));
}

std::string surface_text(const Lens& lens, std::size_t i, std::string& private_glasses) {
  const Surface& surface = lens.surfaces[i];
  if (surface.blades.count != 0)
    throw InputError(fmt::format(
        "surfaces[{0}]: Petzval writes no blades into a .seq file; set surfaces[{0}].blades=null first", i));
  std::string text = fmt::format(
      "S {} {}{}\n", number_text(surface.curvature_per_mm), number_text(surface.thickness_mm),
      surface.mirror ? " REFL" : std::visit(SeqGlassText{i, private_glasses}, surface.material.kind()));
  if (surface.stop) text += "  STO\n";
  if (surface.ideal_lens) refuse(i, "ideal_lens", "an ideal lens");
  if (surface.grating) text += grating_text(*surface.grating);
  if (surface.shape) refuse(i, "shape", fmt::format("the kind \"{}\"", surface.shape->kind));
  if (!is_spherical(surface)) text += asphere_text(surface, i);
  if (surface.semi_diameter_mm) text += fmt::format("  CIR {}\n", number_text(*surface.semi_diameter_mm));
  text += seq_apertures_text(surface, i);
  return text;
}

std::string aperture_text(const Lens& lens) {
  const std::string value = number_text(lens.aperture.value);
  switch (lens.aperture.kind) {
    case Aperture::Kind::f_number:
      if (lens.object_distance_mm)
        throw InputError(
            "aperture.f_number: a .seq file's FNO is the one at the object's distance; set "
            "aperture.working_f_number or aperture.entrance_pupil_diameter_mm first");
      return "FNO " + value;
    case Aperture::Kind::working_f_number:
      return "FNO " + value;
    case Aperture::Kind::image_na:
      return "NA " + value;
    case Aperture::Kind::object_na:
      return "NAO " + value;
    case Aperture::Kind::entrance_pupil_diameter_mm:
      return "EPD " + value;
    case Aperture::Kind::stop_semi_diameter_mm:
      break;
  }
  throw InputError(
      "aperture.stop_semi_diameter_mm: a .seq file cannot hold it; set aperture.entrance_pupil_diameter_mm "
      "or "
      "aperture.f_number first");
}

std::string fields_text(const Fields& fields) {
  constexpr const char* names[] = {"YAN", "YOB", "YIM", "YRI"};
  return fmt::format("{} {}\n", names[static_cast<std::size_t>(fields.kind)], numbers_text(fields.values));
}

std::string seq_wavelengths_text(const Lens& lens) {
  const auto& wavelengths = lens.wavelengths_nm;
  const auto reference = std::find(wavelengths.begin(), wavelengths.end(), lens.reference_wavelength_nm);
  if (reference == wavelengths.end())
    throw InputError("reference_wavelength_nm: in a .seq file it must be one of wavelengths_nm");
  return fmt::format("WL {}\nREF {}\nWTW {}\n", numbers_text(wavelengths),
                     reference - wavelengths.begin() + 1,
                     fmt::join(std::vector<int>(wavelengths.size(), 1), " "));
}

}  // namespace

namespace {

/// A .seq file's f-number is that at the object's distance; where that differs from state to state, the
/// diameter of the entrance pupil says the same.
Lens with_pupils_for_f_numbers(const Lens& lens) {
  bool finite = false;
  for (std::size_t i = 0; i < lens.states.size(); ++i)
    finite = finite || in_state(lens, static_cast<double>(i)).object_distance_mm;
  if (!finite || lens.aperture.kind != Aperture::Kind::f_number) return lens;
  return in_every_state(lens, [](Lens each) {
    each.aperture = {Aperture::Kind::entrance_pupil_diameter_mm,
                     first_order(each).entrance_pupil.diameter_mm};
    return each;
  });
}

/// "THI S5" of an entry of the lens, and its value in a state. \throws InputError for one that ZOO has not.
std::pair<std::string, std::string> seq_zoomed(const std::string& path, const Lens& state) {
  if (path == "object_distance_mm")
    return {"THI SO", number_text(state.object_distance_mm.value_or(seq_infinity))};
  if (path.starts_with("aperture.")) {
    const std::string text = aperture_text(state);
    const std::size_t blank = text.find(' ');
    return {text.substr(0, blank), text.substr(blank + 1)};
  }
  const std::size_t close = path.find("].");
  if (path.starts_with("surfaces[") && close != path.npos) {
    const auto i = static_cast<std::size_t>(std::atoi(path.c_str() + std::string("surfaces[").size()));
    const std::string key = path.substr(close + 2);
    const Surface& surface = state.surfaces[i];
    if (key == "thickness_mm") return {fmt::format("THI S{}", i + 1), number_text(surface.thickness_mm)};
    if (key == "radius_mm") return {fmt::format("CUY S{}", i + 1), number_text(surface.curvature_per_mm)};
    if (key == "conic" && !is_odd_polynomial(surface))
      return {fmt::format("K S{}", i + 1), number_text(surface.conic)};
    if (key == "semi_diameter_mm" && surface.semi_diameter_mm)
      return {fmt::format("CIR S{}", i + 1), number_text(*surface.semi_diameter_mm)};
    const bool table = std::holds_alternative<Material::Table>(surface.material.kind()) ||
                       std::holds_alternative<Material::Constant>(surface.material.kind());
    if (key == "glass" && !surface.material.is_air() && !table) {
      std::string unused;
      return {fmt::format("GLA S{}", i + 1),
              std::visit(SeqGlassText{i, unused}, surface.material.kind()).substr(1)};
    }
  }
  throw InputError(
      fmt::format("states: Petzval writes no states of {} into a .seq file; distances, radii, conics, clear "
                  "apertures, glasses, fields and the aperture are held",
                  path));
}

/// "ZOO YAN F2 5 4", a line a field.
std::string seq_zoomed_fields(const Lens& lens) {
  constexpr const char* names[] = {"YAN", "YOB", "YIM", "YRI"};
  std::string text;
  for (std::size_t k = 0; k < lens.fields.values.size(); ++k) {
    text += fmt::format("ZOO {} F{}", names[static_cast<std::size_t>(lens.fields.kind)], k + 1);
    for (std::size_t i = 0; i < lens.states.size(); ++i) {
      const Lens state = in_state(lens, static_cast<double>(i));
      if (state.fields.values.size() != lens.fields.values.size())
        throw InputError("states: a .seq file holds as many fields in every state");
      text += fmt::format(" {}", number_text(state.fields.values[k]));
    }
    text += "\n";
  }
  return text;
}

std::string seq_zoom_text(const Lens& lens) {
  if (lens.states.empty()) return "";
  require_centred(lens, "Petzval writes states into .seq files for centred lenses");
  std::string text = fmt::format("ZOO {}\n", lens.states.size());
  for (const StateRow& row : lens.states.rows) {
    if (row.path == "fields.values") {
      text += seq_zoomed_fields(lens);
      continue;
    }
    std::string line;
    for (std::size_t i = 0; i < lens.states.size(); ++i) {
      const auto [what, value] = seq_zoomed(row.path, in_state(lens, static_cast<double>(i)));
      line += i == 0 ? fmt::format("ZOO {} {}", what, value) : fmt::format(" {}", value);
    }
    text += line + "\n";
  }
  return text;
}

}  // namespace

std::string seq_text(const Lens& given) {
  given.validate();
  const Lens lens = with_pupils_for_f_numbers(given);
  constexpr double infinity = seq_infinity, farthest = 1e10;
  if (lens.object_distance_mm && *lens.object_distance_mm >= farthest)
    throw InputError("object_distance_mm: in a .seq file a distance from 1e10 on is infinite");
  std::string private_glasses, surfaces;
  const std::string object_glass =
      std::visit(SeqGlassText{lens.surfaces.size(), private_glasses}, lens.object_material.kind());
  AxisBreaks axis = axis_breaks_of(lens);
  std::vector<std::string> breaks(lens.surfaces.size() + 1);
  for (AxisBreak& each : axis.breaks) {
    each.frame.offset_mm[2] = axis.gap_shift_mm[each.surface];
    breaks[each.surface] = seq_break_text(each.frame);
  }
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
    if (!(std::abs(lens.surfaces[i].thickness_mm) < farthest))
      refuse(i, "thickness_mm", "a distance from 1e10 on: it is infinite");
    surfaces += surface_text(lens, i, private_glasses) + breaks[i];
  }
  std::string text =
      fmt::format("RDM N\nLEN\nTITLE {}\nDIM M\n{}\n", title_text(lens.name), aperture_text(lens));
  text += seq_wavelengths_text(lens) + fields_text(lens.fields);
  if (!private_glasses.empty()) text += fmt::format("PRV\n{}END\n", private_glasses);
  text += fmt::format("SO 0.0 {}{}\n", number_text(lens.object_distance_mm.value_or(infinity)), object_glass);
  return text + surfaces + "SI 0.0 0.0\n" + breaks.back() + seq_zoom_text(lens) + "GO\n";
}

}  // namespace petzval
