// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/glass/packed_catalogue.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/formats/seq.h>
#include <petzval/lens/formats/seq_surfaces.h>
#include <petzval/lens/formats/seq_system.h>
#include <petzval/lens/formats/seq_zoom.h>
#include <petzval/lens/lens_fault.h>
#include <petzval/lens/lens_states.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

namespace petzval {

namespace {

enum class SeqRole { harmless, vignetting_factor, refused, refused_unless_zero };

struct SeqKeyword {
  SeqRole role;
  const char* meaning;
};

const std::map<std::string, SeqKeyword, std::less<>>& keywords() {
  static const std::map<std::string, SeqKeyword, std::less<>> table = [] {
    std::map<std::string, SeqKeyword, std::less<>> k;
    const auto add = [&](SeqRole role, std::initializer_list<const char*> names, const char* meaning) {
      for (const char* name : names) k[name] = {role, meaning};
    };
    // Names, weights, how a program varies, solves and draws; the present value of a solve is written out.
    add(SeqRole::harmless,
        {"LEN", "GO",  "INI", "WTW", "WTF", "CWL", "DER", "SLB", "COM", "CON", "ASP", "CCY", "CCX", "THC",
         "GLC", "KC",  "AC",  "BC",  "CC",  "DC",  "EC",  "FC",  "GC",  "HC",  "JC",  "XDC", "YDC", "ZDC",
         "ADC", "BDC", "CDC", "PFR", "MFL", "WID", "SAV", "RES", "DOR", "UID", "SCC", "FRZ", "VIE", "LIS",
         "CIN", "TOR", "UMY", "UMC", "UIY", "HMY", "HCY", "UCY", "CAI", "DLC", "DLT"},
        "");
    add(SeqRole::vignetting_factor, {"VUX", "VLX", "VUY", "VLY"}, "");
    add(SeqRole::refused_unless_zero, {"CUF"}, "a Fresnel surface");
    add(SeqRole::refused, {"NSS", "NSC"}, "a non-sequential path");
    add(SeqRole::refused, {"XTO", "YTO", "CYL", "AAS", "RDX", "CUX"}, "a surface that is not round");
    add(SeqRole::refused, {"SPL", "UDS", "QBF", "QCN", "INT", "MOD", "ZRN"}, "a special surface");
    add(SeqRole::refused, {"DIF", "HOE", "HOR", "HWL", "HCT", "HCO"}, "a hologram");
    add(SeqRole::refused, {"GRN", "UDG", "THM"}, "a graded index");
    return k;
  }();
  return table;
}

bool seq_all_zero(const SeqCommand& command) {
  return std::all_of(command.words.begin(), command.words.end(),
                     [](const std::string& word) { return parse_number(word).value_or(0) == 0; });
}

struct SeqFindings {
  std::set<std::string> unknown;
  bool vignetting = false;
};

void check_keyword(const SeqCommand& command, const SeqContext& context, const std::string& where,
                   SeqFindings& findings) {
  const auto keyword = keywords().find(command.name);
  if (keyword == keywords().end()) {
    findings.unknown.insert(quotable(command.name));
    return;
  }
  const auto [role, meaning] = keyword->second;
  if (role == SeqRole::refused || (role == SeqRole::refused_unless_zero && !seq_all_zero(command)))
    context.fail(command, fmt::format("({}) is not modelled; remove it from the file", meaning), where);
  if (role == SeqRole::vignetting_factor && !seq_all_zero(command)) findings.vignetting = true;
}

void note_findings(const SeqFindings& findings, const SeqContext& context) {
  if (findings.vignetting)
    context.notes.push_back(context.file +
                            ": vignetting factors are not used; the clear apertures vignette by themselves");
  constexpr std::size_t most_named = 12;
  std::vector<std::string> unknown(findings.unknown.begin(), findings.unknown.end());
  if (unknown.empty()) return;
  unknown.resize(std::min(unknown.size(), most_named));
  context.notes.push_back(fmt::format("{}: passed over commands that are not known here: {}{}", context.file,
                                      fmt::join(unknown, ", "),
                                      findings.unknown.size() > most_named ? " …" : ""));
}

/// PIM without a distance, and the shift of focus that the image surface holds.
void place_image(Lens& lens, const SeqSurfaces& surfaces, double mm_per_unit, const SeqContext& context) {
  double& last_mm = lens.surfaces.back().thickness_mm;
  if (surfaces.wants_image_distance()) {
    last_mm = 0;
    last_mm = lens.last_sense() *
              paraxial_image_distance_mm(lens, lens.object_distance_mm, lens.reference_wavelength_nm);
    if (!std::isfinite(last_mm))
      throw InputError("PIM: the lens has no paraxial image to put the image surface at");
    context.notes.push_back(
        fmt::format("{}: PIM: the image surface is put at the paraxial image, {:.6g} mm "
                    "behind the last surface",
                    context.file, last_mm));
  }
  const double shift_mm = surfaces.focus_shift() * mm_per_unit;
  if (shift_mm == 0) return;
  last_mm += shift_mm;
  context.notes.push_back(fmt::format("{}: the shift of focus of SI, {:.6g} mm, is added to the last gap",
                                      context.file, shift_mm));
}

/// Radii in a file that does not say RDM give a lens of absurd curvatures.
void note_doubtful_curvatures(const Lens& lens, const SeqContext& context) {
  constexpr double strongest_usual_per_mm = 4;
  std::size_t curved = 0, absurd = 0;
  for (const Surface& surface : lens.surfaces) {
    const double c = std::abs(surface.curvature_per_mm);
    curved += c != 0;
    absurd += c > strongest_usual_per_mm;
  }
  if (absurd > 0 && absurd == curved)
    context.notes.push_back(
        context.file +
        ": all surfaces are curved by more than 4 per mm; if these are radii, the file must say RDM");
}

void note_unbounded(const Lens& lens, const SeqContext& context) {
  const auto unbounded =
      std::count_if(lens.surfaces.begin(), lens.surfaces.end(),
                    [](const Surface& surface) { return !surface.semi_diameter_mm && !surface.stop; });
  if (unbounded > 0)
    context.notes.push_back(fmt::format("{}: {} of {} surfaces have no clear aperture and are unbounded",
                                        context.file, unbounded, lens.surfaces.size()));
}

[[noreturn]] void fail_at(const LensFault& fault, const SeqSurfaces& surfaces, const std::string& file) {
  const std::string prefix = "surfaces[", message = fault.path + " " + fault.message;
  if (fault.path.compare(0, prefix.size(), prefix) != 0) throw InputError(file, message);
  const auto i = static_cast<std::size_t>(std::atoi(fault.path.c_str() + prefix.size()));
  throw InputError(file, surfaces.line_of(i), fmt::format("S{}: {}", i + 1, message));
}

/// One zoom position.
Lens read_position(const std::vector<SeqCommand>& commands, const SeqContext& context, GlassLookup& glasses) {
  SeqSystem system;
  SeqSurfaces surfaces;
  SeqFindings findings;
  for (const SeqCommand& command : commands)
    if (!surfaces.apply(command, context) && !system.apply(command, context))
      check_keyword(command, context, surfaces.where(), findings);
  note_findings(findings, context);
  Lens lens;
  surfaces.put_into(lens, system.mm_per_unit, context, glasses);
  system.put_into(lens, context);
  if (const auto fault = find_fault(lens)) fail_at(*fault, surfaces, context.file);
  try {
    place_image(lens, surfaces, system.mm_per_unit, context);
  } catch (const InputError& error) {
    throw InputError(context.file, error.what());
  }
  if (const auto fault = find_fault(lens)) fail_at(*fault, surfaces, context.file);
  return lens;
}

/// Zoom positions become states, zoom-1 and so on; the lens stands in the first.
Lens read_positions(const std::vector<SeqCommand>& commands, const SeqContext& context,
                    GlassLookup& glasses) {
  const SeqZoom zoom = seq_zoom(commands, context);
  Lens lens = read_position(seq_at_position(zoom, 0, context), context, glasses);
  if (zoom.positions < 2) return lens;
  std::vector<std::string> names{"zoom-1"}, scratch;
  std::vector<Lens> lenses{lens};
  const SeqContext silent{context.file, scratch};
  for (std::size_t i = 1; i < zoom.positions; ++i) {
    names.push_back(fmt::format("zoom-{}", i + 1));
    lenses.push_back(read_position(seq_at_position(zoom, i, silent), silent, glasses));
  }
  LensStates states = joined_states(std::move(names), lenses).states;
  const bool same = states.rows.empty();
  if (!same) lens.states = std::move(states);
  context.notes.push_back(
      same ? fmt::format("{}: all {} zoom positions (ZOO) are the same", context.file, zoom.positions)
           : fmt::format(
                 "{}: each of {} zoom positions (ZOO) is a state, zoom-1 to zoom-{}; the first is read",
                 context.file, zoom.positions, zoom.positions));
  return lens;
}

}  // namespace

LensFile read_seq(const std::string& text, const std::string& file, const LensReadOptions& options) {
  LensFile result;
  const SeqContext context{file, result.notes};
  GlassLookup glasses(options, file, result.notes);
  result.lens = read_positions(seq_commands(text), context, glasses);
  try {
    glasses.require_all_used();
  } catch (const InputError& error) {
    throw InputError(file, error.what());
  }
  note_doubtful_curvatures(result.lens, context);
  note_unbounded(result.lens, context);
  return result;
}

}  // namespace petzval
