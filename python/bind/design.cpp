// SPDX-License-Identifier: BSD-3-Clause
// Lenses as they are built, and better ones.
#include <petzval/report/fit_build_tables.h>
#include <petzval/report/optimise_tables.h>
#include <petzval/report/tolerance_tables.h>

#include "analysis.h"
#include "call.h"
#include "camera.h"
#include "edges.h"
#include "lens.h"
#include "lens_parts.h"

namespace petzval::python {

namespace {

ErrorDistribution distribution_from(const std::string& word) {
  return choice<ErrorDistribution>("distribution", word,
                                   {{"normal", ErrorDistribution::normal},
                                    {"uniform", ErrorDistribution::uniform},
                                    {"at-limit", ErrorDistribution::at_limit}});
}

nb::object toleranced(const Lens& lens, const Numbers& fields, const std::optional<std::string>& field_type,
                      const Numbers& wavelengths_nm, const std::vector<std::string>& tolerances,
                      const std::string& grade, std::optional<double> mtf_cpmm, std::optional<double> accept,
                      int builds, const std::string& distribution, const Numbers& azimuths_deg, bool refocus,
                      std::optional<double> inverse_change, bool ignore_apertures, const std::string& record,
                      std::uint64_t seed, int threads, const nb::object& progress) {
  ToleranceRequest request;
  request.tolerances = tolerances_from(tolerances);
  request.grade = grade;
  request.record = record;
  request.judge.at = request_of(lens, fields, field_type, wavelengths_nm, ignore_apertures);
  if (!azimuths_deg.empty()) request.judge.azimuths_deg = azimuths_deg;
  if (mtf_cpmm) request.judge.merit = {Merit::Kind::mtf, *mtf_cpmm};
  request.judge.refocus = refocus;
  request.builds = builds;
  request.distribution = distribution_from(distribution);
  request.accept = accept;
  request.inverse_change = inverse_change;
  Call call({threads, seed, progress});
  const ToleranceReport report =
      call([lens, &request](const Context& context) { return tolerance_lens(lens, request, context); });
  const Merit& merit = request.judge.merit;
  AnalysisResult result;
  result.lens = lens.name;
  result.field_kind = request.judge.at.field_kind;
  result.reference_wavelength_nm = lens.reference_wavelength_nm;
  result.facts = {{"merit", merit.name()},
                  {"designed", Numbers{report.designed.overall}},
                  {"designed_worst", Numbers{report.designed.worst}},
                  {"expected_change", Numbers{report.expected_change}},
                  {"rss_change", Numbers{report.rss_change}}};
  if (accept && builds > 0)
    result.facts.push_back({"yield", Numbers{report.yield, report.yield_low, report.yield_high}});
  result.tables.push_back({"rows", "change by each tolerance alone", sensitivity_table(report, merit)});
  if (builds > 0) {
    result.tables.push_back({"distribution", "over all builds", build_table(report, merit)});
    result.tables.push_back({"builds", "every build", all_builds(report, merit)});
    result.plots.push_back(yield_plot(lens.name, report, merit, accept));
  }
  return python_of("tolerance", result);
}

std::shared_ptr<Lens> built(const Lens& lens, std::size_t number, const std::vector<std::string>& tolerances,
                            const std::string& grade, const std::string& distribution, std::uint64_t seed) {
  ToleranceRequest request;
  request.tolerances = tolerances_from(tolerances);
  request.grade = grade;
  request.distribution = distribution_from(distribution);
  return std::make_shared<Lens>(build_off_the_line(lens, request, seed, number));
}

nb::tuple optimised(const Lens& lens, const std::vector<std::string>& variables, const Numbers& fields,
                    const std::optional<std::string>& field_type, const Numbers& wavelengths_nm,
                    const Numbers& field_weights, const Numbers& azimuths_deg, const std::string& merit,
                    std::optional<double> efl_mm, double least_rim_mm, int rounds, int starts,
                    double start_spread, int glasses, std::optional<double> mtf_cpmm,
                    std::optional<double> most_distortion_percent, bool ignore_apertures, std::uint64_t seed,
                    int threads, const nb::object& progress) {
  OptimiseRequest request;
  for (const std::string& text : variables)
    for (const LensVariable& each : parse_lens_variables(lens, text)) request.variables.push_back(each);
  request.at = request_of(lens, fields, field_type, wavelengths_nm, ignore_apertures);
  request.field_weights = field_weights;
  request.azimuths_deg = azimuths_deg;
  request.merit = choice<OptimiseMerit>(
      "merit", merit, {{"spot", OptimiseMerit::rms_spot}, {"wavefront", OptimiseMerit::wavefront}});
  if (mtf_cpmm) request.merit = OptimiseMerit::mtf, request.mtf_frequency_cpmm = *mtf_cpmm;
  request.most_distortion_percent = most_distortion_percent;
  request.efl_mm = efl_mm;
  request.least_rim_mm = least_rim_mm;
  request.rounds = rounds, request.starts = starts, request.start_spread = start_spread;
  request.glasses = glasses;
  Call call({threads, seed, progress});
  const OptimiseResult found =
      call([lens, &request](const Context& context) { return optimise(lens, request, context); });
  AnalysisResult result;
  result.lens = found.lens.name;
  result.field_kind = request.at.field_kind;
  result.reference_wavelength_nm = lens.reference_wavelength_nm;
  result.facts = {{"merit", name_of(request.merit)},
                  {"before", Numbers{found.before}},
                  {"after", Numbers{found.after}},
                  {"efl_mm", Numbers{found.efl_before_mm, found.efl_after_mm}},
                  {"start", Numbers{static_cast<double>(found.start)}},
                  {"by_round", found.by_round}};
  result.tables = {{"rows", "by field", optimised_fields(found, request.at, request.merit)},
                   {"numbers", "what was altered", optimised_numbers(found)},
                   {"glasses", "glasses that were replaced", optimised_glasses(found)}};
  result.plots.push_back(optimise_plot(found.lens.name, found, request.merit));
  return nb::make_tuple(std::make_shared<Lens>(found.lens), python_of("optimise", result));
}

/// Edges of pz.sfr, or the name of a file that the program's `sfr --json` wrote; or a list of those.
std::vector<SfrMap> maps_from(const nb::object& edges) {
  std::vector<SfrMap> maps;
  if (nb::isinstance<nb::str>(edges)) return read_sfr_maps(nb::cast<std::string>(edges));
  if (nb::isinstance<Edges>(edges)) {
    const Edges& of = nb::cast<const Edges&>(edges);
    return {sfr_map(of.all, of.columns, of.rows)};
  }
  for (const nb::handle each : edges)
    for (SfrMap& map : maps_from(nb::borrow<nb::object>(each))) maps.push_back(std::move(map));
  return maps;
}

nb::tuple build_fitted(const Lens& lens, const nb::object& edges, std::optional<double> pixel_pitch_um,
                       const nb::object& sensor, const std::vector<std::string>& free,
                       const Numbers& wavelengths_nm, const Numbers& weights, const std::string& channel,
                       const Numbers& focus_shifts_mm, int threads, const nb::object& progress) {
  FitBuildRequest request;
  request.free = free;
  if (!sensor.is_none()) {
    const std::shared_ptr<Sensor> taken = sensor_from(sensor);
    request.pixel_pitch_um = taken->geometry.pitch_um, request.photosite = taken->photosite;
  }
  if (pixel_pitch_um) request.pixel_pitch_um = *pixel_pitch_um;
  request.wavelengths_nm = wavelengths_nm;
  request.weights = weights;
  request.channel = channel;
  request.focus_shifts_mm = focus_shifts_mm;
  const std::vector<SfrMap> maps = maps_from(edges);
  Call call({threads, 1, progress});
  const FitBuildResult found = call(
      [&lens, &maps, &request](const Context& context) { return fit_build(lens, maps, request, context); });
  AnalysisResult result;
  result.lens = found.lens.name;
  result.reference_wavelength_nm = lens.reference_wavelength_nm;
  result.facts = {{"chi_squared", Numbers{found.chi_squared}},
                  {"chi_squared_before", Numbers{found.chi_squared_before}},
                  {"freedom", Numbers{static_cast<double>(found.freedom)}},
                  {"scaled_by", Numbers{found.scaled_by}},
                  {"correlation", found.correlation}};
  result.tables = {{"rows", "how the lens was built", fitted_numbers(found)},
                   {"edges", "edge by edge", fitted_edges(found)}};
  result.remarks = found.remarks;
  return nb::make_tuple(std::make_shared<Lens>(found.lens), python_of("fit-build", result));
}

constexpr const char* fit_build_text =
    "How this lens was built, from the sharpness of edges: the lens as built and an Analysis with `rows` "
    "(number, value, deviation, unit), a table \"edges\" and remarks on what cannot be told. `edges`: of "
    "pz.sfr, or a file of `petzval sfr --json`, or a list of them from photographs at different focus. "
    "`free`: "
    "[\"defocus_mm\", \"sensor_tilt_deg\", \"element_decentre_mm@2-3=0.05\", \"sag4_um@0\"]. "
    "`focus_shifts_mm`: where the sensor stood in each photograph, away from the lens. docs/TOLERANCES.md.";
constexpr const char* tolerance_text =
    "What a maker's tolerances do: an Analysis with `rows` (sensitivities), tables \"distribution\" and "
    "\"builds\", facts `yield` (share, low and high end of its 95 % interval) and a plot. `tolerances`: "
    "[\"element_tilt_deg@2-3=0.05\"], else the lens's own, else those of `grade` (commercial, precision, "
    "high). "
    "`mtf_cpmm`: judge by the MTF at that frequency, else by RMS spots [um]. `record`: a file that keeps "
    "builds as "
    "they are finished; the same call goes on from it. Same seed, same builds. docs/TOLERANCES.md.";
constexpr const char* built_text =
    "The lens as number `number` off the line has it, its sensor focused: the lens of that row of "
    "tolerance().";
constexpr const char* optimise_text =
    "A better lens and an Analysis of what was done. `variables`: [\"radii\", \"gaps\", \"thicknesses\", "
    "\"image\", \"poses\", "
    "\"surfaces[1].conic=-2:0\", \"sensor_pose.tilt_x_deg\"]; none: radii and image. `azimuths_deg`: of the "
    "fields; none: four where the lens is not round or poses may be altered. `merit`: spot [um] or wavefront "
    "[nm]. `efl_mm`: the "
    "focal "
    "length to hold; None: as it is. `glasses`: try so many near ones of its maker in the place of each. "
    "`mtf_cpmm`: the frequency at which what the MTF lacks of 1 is "
    "made small, in place of `merit`. `most_distortion_percent`: of every field. "
    "docs/OPTIMISING.md.";

}  // namespace

void bind_design(nb::module_&) {
  const nb::handle type = nb::type<Lens>();
  const auto add = [&](const char* name, auto function, auto... extra) {
    nb::cpp_function_def(function, nb::scope(type), nb::name(name), nb::is_method(), extra...);
  };
  add("tolerance", toleranced, nb::arg("fields") = Numbers(), nb::kw_only(),
      nb::arg("field_type").none() = nb::none(), nb::arg("wavelengths_nm") = Numbers(),
      nb::arg("tolerances") = std::vector<std::string>(), nb::arg("grade") = "precision",
      nb::arg("mtf_cpmm").none() = nb::none(), nb::arg("accept").none() = nb::none(), nb::arg("builds") = 200,
      nb::arg("distribution") = "normal", nb::arg("azimuths_deg") = Numbers(), nb::arg("refocus") = true,
      nb::arg("inverse").none() = nb::none(), nb::arg("ignore_apertures") = false, nb::arg("record") = "",
      nb::arg("seed") = 1, nb::arg("threads") = 0, nb::arg("progress").none() = nb::none(), tolerance_text);
  add("built", built, nb::arg("number"), nb::kw_only(), nb::arg("tolerances") = std::vector<std::string>(),
      nb::arg("grade") = "precision", nb::arg("distribution") = "normal", nb::arg("seed") = 1, built_text);
  add("fit_build", build_fitted, nb::arg("edges"), nb::kw_only(),
      nb::arg("pixel_pitch_um").none() = nb::none(), nb::arg("sensor").none() = nb::none(),
      nb::arg("free") = std::vector<std::string>(), nb::arg("wavelengths_nm") = Numbers(),
      nb::arg("weights") = Numbers(), nb::arg("channel") = "", nb::arg("focus_shifts_mm") = Numbers(),
      nb::arg("threads") = 0, nb::arg("progress").none() = nb::none(), fit_build_text);
  add("optimise", optimised, nb::arg("variables") = std::vector<std::string>(), nb::kw_only(),
      nb::arg("fields") = Numbers(), nb::arg("field_type").none() = nb::none(),
      nb::arg("wavelengths_nm") = Numbers(), nb::arg("field_weights") = Numbers(),
      nb::arg("azimuths_deg") = Numbers(), nb::arg("merit") = "spot", nb::arg("efl_mm").none() = nb::none(),
      nb::arg("least_rim_mm") = 0.5, nb::arg("rounds") = 30, nb::arg("starts") = 1,
      nb::arg("start_spread") = 0.05, nb::arg("glasses") = 0, nb::arg("mtf_cpmm").none() = nb::none(),
      nb::arg("most_distortion_percent").none() = nb::none(), nb::arg("ignore_apertures") = false,
      nb::arg("seed") = 1, nb::arg("threads") = 0, nb::arg("progress").none() = nb::none(), optimise_text);
}

}  // namespace petzval::python
