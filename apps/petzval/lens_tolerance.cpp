// SPDX-License-Identifier: BSD-3-Clause
// petzval lens tolerance.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/quantities.h>
#include <petzval/base/staged_files.h>
#include <petzval/base/whole_file.h>
#include <petzval/lens/lens_file.h>
#include <petzval/report/tolerance_tables.h>

#include <filesystem>
#include <map>
#include <memory>

#include "camera_option.h"
#include "field_option.h"
#include "lens_commands.h"
#include "option_names.h"
#include "output_option.h"
#include "plot_output.h"
#include "table_output.h"

namespace petzval::app {

namespace {

struct ToleranceCommand {
  LensChoice lens;
  FieldChoice fields;
  CameraChoice camera;
  ToleranceRequest request;
  std::vector<std::string> tolerances;
  std::string merit = "spot", azimuths, plot, csv, lenses, distribution = "normal";
  bool no_refocus = false;
};

const std::map<std::string, ErrorDistribution>& distributions() {
  static const std::map<std::string, ErrorDistribution> table{{"normal", ErrorDistribution::normal},
                                                              {"uniform", ErrorDistribution::uniform},
                                                              {"at-limit", ErrorDistribution::at_limit}};
  return table;
}

Merit merit_of(const std::string& text) {
  if (text == "spot") return {};
  constexpr std::string_view mtf = "mtf@";
  const auto frequency =
      text.starts_with(mtf) ? parse_number(std::string_view(text).substr(mtf.size())) : std::nullopt;
  if (!frequency || !(*frequency > 0))
    throw InputError(
        fmt::format("--merit \"{}\": spot, or mtf@40 for the MTF at 40 cycles/mm, would be right", text));
  return {Merit::Kind::mtf, *frequency};
}

std::string lens_path(const std::string& folder, std::size_t build) {
  return (std::filesystem::path(folder) / fmt::format("build-{:04}.json", build)).string();
}

/// Every build as a lens of its own, focused.
void write_lenses(const ToleranceCommand& command, const Lens& lens, std::uint64_t seed) {
  std::filesystem::create_directories(command.lenses);
  for (int i = 0; i < command.request.builds; ++i) {
    const auto build = static_cast<std::size_t>(i);
    write_lens(build_off_the_line(lens, command.request, seed, build), lens_path(command.lenses, build));
  }
}

void print_as_json(const Lens& lens, const ToleranceCommand& command, const ToleranceReport& report) {
  const Merit& merit = command.request.judge.merit;
  nlohmann::ordered_json json = {{"lens", lens.name},
                                 {"merit", merit.name()},
                                 {"unit", merit.unit()},
                                 {"designed", report.designed.overall},
                                 {"designed_worst", report.designed.worst},
                                 {"expected_change", report.expected_change},
                                 {"rss_change", report.rss_change},
                                 {"rows", rows_json(sensitivity_table(report, merit))}};
  if (!report.builds.empty()) {
    json["builds"] = report.builds.size();
    json["distribution"] = rows_json(build_table(report, merit));
  }
  if (command.request.accept && !report.builds.empty())
    json.update({{"accept", *command.request.accept},
                 {"yield", report.yield},
                 {"yield_interval_95", {report.yield_low, report.yield_high}}});
  print_json(json);
}

void print_as_text(const Lens& lens, const ToleranceCommand& command, const ToleranceReport& report) {
  const Merit& merit = command.request.judge.merit;
  const std::string unit = *merit.unit() ? fmt::format(" {}", merit.unit()) : "";
  fmt::print("{}: {} of all {} points together {:.4g}{}, at the worst of them {:.4g}{}\n", lens.name,
             merit.name(), report.points.size(), report.designed.overall, unit, report.designed.worst, unit);
  if (!report.sensitivities.empty()) {
    fmt::print("\nchange of the {} by each tolerance alone, at its limit{}\n", merit.name(),
               command.no_refocus ? "" : ", the sensor focused again");
    print_table(sensitivity_table(report, merit));
    fmt::print("all at their limits, by these alone: {:+.4g}{} on average, +- {:.4g}{} in quadrature\n",
               report.expected_change, unit, report.rss_change, unit);
  }
  if (report.builds.empty()) return;
  fmt::print("\n{} over {} builds; so many per cent keep at {} so much\n", merit.name(), report.builds.size(),
             merit.more_is_better() ? "least" : "most");
  print_table(build_table(report, merit));
  if (command.request.accept)
    fmt::print(
        "yield: {:.1f} % of the builds keep {} {:g}{} at their worst point (95 % interval {:.1f} to {:.1f} "
        "%)\n",
        100 * report.yield, merit.more_is_better() ? "at least" : "at most", *command.request.accept, unit,
        100 * report.yield_low, 100 * report.yield_high);
}

void run(ToleranceCommand command, const Shared& shared) {
  if (!command.plot.empty()) require_drawing(command.plot, "a plot");
  if (!command.csv.empty()) require_extension(command.csv, {".csv"}, "a table");
  ToleranceRequest& request = command.request;
  request.judge.merit = merit_of(command.merit);
  request.judge.refocus = !command.no_refocus;
  request.distribution = distributions().at(command.distribution);
  if (!command.azimuths.empty())
    request.judge.azimuths_deg = parse_number_list(command.azimuths, "azimuths_deg");
  for (const std::string& text : command.tolerances)
    for (const Tolerance& each : parse_tolerances(text)) request.tolerances.push_back(each);
  const Lens read = command.fields.prepare(command.lens.read(shared), shared);
  const Lens lens = command.camera.used(read, command.fields.request(read), shared);
  request.judge.at = command.fields.request(lens);
  const bool needs_builds = !command.plot.empty() || !command.csv.empty() || !command.lenses.empty();
  if (request.builds == 0 && needs_builds)
    throw InputError("--builds 0: a plot, a table of builds and their lenses need some; 200 would be right");
  const ToleranceReport report = tolerance_lens(lens, request, context_of(shared));
  const Merit& merit = request.judge.merit;
  if (!command.plot.empty())
    write_drawing(command.plot, yield_plot(lens.name, report, merit, request.accept).svg());
  if (!command.csv.empty()) write_whole_file(command.csv, to_csv(all_builds(report, merit)));
  if (!command.lenses.empty()) write_lenses(command, lens, shared.seed);
  shared.json ? print_as_json(lens, command, report) : print_as_text(lens, command, report);
}

}  // namespace

void add_lens_tolerance(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<ToleranceCommand>();
  CLI::App* command =
      add_command(lens, shared, "tolerance",
                  "What a maker's tolerances do to a lens: worst offenders, builds off the line, yield",
                  "petzval lens tolerance cooke-triplet --grade precision --accept 22 --plot yield.svg", true,
                  [options, &shared] { run(*options, shared); });
  ToleranceRequest& request = options->request;
  options->lens.offers_builds = false;
  options->lens.add_to(*command);
  std::string grades = fmt::format("{}", fmt::join(tolerance_grades(), ", "));
  command->add_option(
      "--grade", request.grade,
      fmt::format("Of the tolerances: {}; default: precision, unless the lens has its own", grades));
  command->add_option("--tolerance", options->tolerances,
                      "Instead: radius_percent@2=0.1 or element_tilt_deg@2-3=0.05, surfaces counted from 0; "
                      "may be given several times");
  command->add_option("--merit", options->merit,
                      "What a lens is judged by: spot (RMS radius), or mtf@F at F cycles/mm; default: spot");
  command->add_option("--accept", request.accept,
                      "What the worst point of a good lens keeps: at most of spots [um], at least of MTF");
  command->add_option("--builds", request.builds, "Lenses off the line; 0: sensitivities alone")
      ->check(CLI::Range(0, 1'000'000));
  command
      ->add_option("--distribution", options->distribution,
                   "Of errors within their limits: normal (deviation half the limit), uniform, at-limit")
      ->check(CLI::IsMember({"normal", "uniform", "at-limit"}));
  command->add_option("--inverse", request.inverse_change,
                      "Also the limit at which each tolerance alone costs so much of the merit");
  command->add_option("--azimuths", options->azimuths,
                      "Of the fields off the axis [deg]; default: 0,90,180,270");
  command->add_flag("--no-refocus", options->no_refocus, "Leave the sensor where the design has it");
  options->fields.add_to(*command);
  options->camera.add_stop_and_focus(*command, Focus::design());
  command->add_option("--plot", options->plot, "Also draw the yield over the merit: .svg, .png or .pdf")
      ->check(output_file());
  command->add_option("--csv", options->csv, "Also write every build, its merits and its errors")
      ->check(output_file());
  command->add_option("--record", request.record,
                      "Keep every build in this file as it is finished: the same command goes on from it");
  command->add_option("--lenses", options->lenses, "Also write every build as a lens file into this folder");
}

}  // namespace petzval::app
