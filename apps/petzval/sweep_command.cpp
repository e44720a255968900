// SPDX-License-Identifier: BSD-3-Clause
// petzval sweep: pictures and numbers over a range of parameters.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/version.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/html.h>
#include <petzval/report/sweep_plot.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numeric>
#include <utility>

#include "clip.h"
#include "field_option.h"
#include "interrupted.h"
#include "output_option.h"
#include "plot_output.h"
#include "sweep_folder.h"
#include "sweep_frames.h"
#include "sweep_result.h"
#include "sweep_scene.h"
#include "sweep_sheet.h"
#include "sweep_tables.h"
#include "sweep_yield.h"

namespace petzval::app {

namespace {

using Json = nlohmann::ordered_json;

std::string label_of(const SweepPoint& point) {
  std::string label;
  for (const auto& [key, value] : point)
    if (key == label_key && !value.empty()) return value;
  for (const auto& [key, value] : point) label += (label.empty() ? "" : "  ") + key + " " + value;
  return label;
}

/// What was measured over what was varied.
std::string plot_svg(const SweepCommand& options, const std::vector<SweptParameter>& parameters,
                     const Table& table, const Shared& shared) {
  std::vector<std::string> varied, left_out;
  for (const SweptParameter& parameter : parameters) varied.push_back(parameter.key);
  const std::vector<Plot> plots = sweep_plots(table, varied, options.plot_of, &left_out);
  for (const std::string& text : left_out) note(shared, fmt::format("{}: {}", options.plot, text));
  return plot_grid_svg(plots, 1, "");
}

/// \throws InputError if a plot is asked for that cannot be.
void check_plot(const SweepCommand& options, const std::vector<SweptParameter>& parameters) {
  if (options.plot.empty()) {
    if (!options.plot_of.empty())
      throw InputError("--plot-of says what a plot shows; with --plot FILE.svg it would be right");
    return;
  }
  require_drawing(options.plot, "a plot");
  std::string keys;
  for (const SweptParameter& parameter : parameters) {
    if (swept_axis(parameter.values)) return;
    keys += (keys.empty() ? "" : ", ") + parameter.key;
  }
  throw InputError(fmt::format(
      "--plot: {} cannot be an axis; two or more numbers in one unit would be right, as in f-number=4,5.6,8",
      keys));
}

/// Options that name a column, and the column.
std::vector<std::pair<const char*, std::string>> columns_asked(const SweepCommand& options) {
  std::vector<std::pair<const char*, std::string>> asked;
  for (const std::string& key : options.plot_of) asked.emplace_back("--plot-of", key);
  for (const std::string& text : options.accept) asked.emplace_back("--accept", parse_criterion(text).column);
  return asked;
}

/// What the corners of pictures say is known before there is one.
/// \throws InputError for a column of theirs that there will not be.
void check_corner_columns(const SweepCommand& options) {
  for (const auto& [option, key] : columns_asked(options)) {
    if (!key.starts_with("corners.")) continue;
    if (!options.corners)
      throw InputError(fmt::format("{} {}: corners are not measured; --corners would be right", option, key));
    const std::vector<std::string> known = corner_columns();
    if (std::ranges::find(known, key) == known.end())
      throw InputError(fmt::format("{} {}: no such thing is measured; {} would be right", option, key,
                                   fmt::join(known, ", ")));
  }
}

/// \throws Failure for a quantity that the command does not measure. The first point stays for the command
/// that names it rightly. \throws InputError where it would take the place of a sweep that was finished here:
/// that one stays. \param results  of which the last was made.
void check_quantities(const SweepCommand& options, const std::vector<PointResult>& results,
                      SweepFolder& folder) {
  const std::vector<std::pair<const char*, std::string>> asked = columns_asked(options);
  if (asked.empty()) return;
  std::vector<std::string> varied;
  for (const auto& [key, value] : results.back().point) varied.push_back(key);
  const std::vector<std::string> measured = measured_columns(table_of(rows_of(results)), varied);
  for (const auto& [option, key] : asked) {
    if (std::ranges::find(measured, key) != measured.end()) continue;
    const std::string wrong = fmt::format("{} {}: the command measures no such thing; {} would be right",
                                          option, key, fmt::join(measured, ", "));
    if (folder.is_new()) {
      folder.keep();
      throw Failure(wrong + " (the point that was made is kept)");
    }
    std::error_code ignored;
    std::filesystem::remove(options.folder + "/" + name_of_point(results.size() - 1) + ".json", ignored);
    for (const std::string& path : results.back().outputs) std::filesystem::remove(path, ignored);
    throw InputError(wrong);
  }
}

void write_page(const SweepCommand& options, const std::vector<PointResult>& results, const Table& table,
                const std::string& plot, const std::string& yield, bool pictures) {
  html::Page page(fmt::format("Sweep of petzval {}", options.command),
                  fmt::format("{} points", results.size()));
  if (!yield.empty()) page.add(html::paragraph(yield));
  if (pictures)
    page.section("Contact sheet")
        .add(html::picture(html::linked_image("contact-sheet.png", "contact sheet")));
  if (!plot.empty()) page.section("Plot").add(html::drawing(plot));
  page.section("Numbers").add(html::table(table));
  page.footer(fmt::format("petzval {}", version()));
  write_whole_file(options.folder + "/index.html", page.html());
}

/// How many pictures make a unit of the sheet that rows should not break: the values of the last parameter,
/// where there are several.
int pictures_in_unit(const SweepCommand& options, const std::vector<SweptParameter>& parameters) {
  return options.points.empty() && parameters.size() > 1 ? static_cast<int>(parameters.back().values.size())
                                                         : 1;
}

/// The points of the table, of --vary, or each of the former with each of the latter.
std::vector<SweepPoint> points_of(const SweepCommand& options, std::vector<SweptParameter>& parameters) {
  const std::vector<SweepPoint> varied = sweep_points(parameters);
  if (options.points.empty()) return varied;
  constexpr std::size_t most_points = 10000;
  const std::vector<SweepPoint> table = read_sweep_points(options.points);
  if (table.size() > most_points / varied.size())
    throw InputError(options.points, fmt::format("the sweep has more than {} points", most_points));
  std::vector<SweptParameter> all = parameters_of(table);
  for (const SweptParameter& parameter : parameters)
    for (const SweptParameter& of_table : all)
      if (parameter.key == of_table.key)
        throw InputError(fmt::format("--vary {}: {} gives it too; one of the two would be right",
                                     parameter.key, options.points));
  std::vector<SweepPoint> points;
  for (const SweepPoint& row : table)
    for (const SweepPoint& point : varied) {
      points.push_back(row);
      points.back().insert(points.back().end(), point.begin(), point.end());
    }
  all.insert(all.end(), parameters.begin(), parameters.end());
  parameters = std::move(all);
  return points;
}

/// Names of the files that a sweep may write.
std::set<std::string> planned_files(const SweepCommand& options, std::size_t points) {
  std::set<std::string> names{"index.html", "sweep.csv", "sweep.json"};
  std::vector<std::string> extensions{".json"};
  if (options.makes_pictures()) {
    names.insert("contact-sheet.png");
    extensions.push_back(".png");
    for (const std::string& extension : options.other_files()) extensions.push_back("." + extension);
  }
  for (std::size_t i = 0; i < points; ++i)
    for (const std::string& extension : extensions) names.insert(name_of_point(i) + extension);
  return names;
}

/// \throws InputError if the sweep would replace what it reads.
void check_inputs(const SweepCommand& options, const std::vector<SweptParameter>& parameters,
                  const SweepFolder& folder) {
  std::vector<std::string> words = options.words;
  for (const SweptParameter& parameter : parameters)
    words.insert(words.end(), parameter.values.begin(), parameter.values.end());
  for (const std::string& word : words)
    for (const std::string& name : {word, word.substr(word.find('=') + 1)}) {
      std::error_code ignored;
      if (std::filesystem::is_regular_file(name, ignored) && folder.owns(name))
        throw InputError(fmt::format(
            "--output {}: this would overwrite {}, which the sweep reads; another folder would be right",
            options.folder, name));
    }
}

/// The exit code of a command that is given what is wrong.
constexpr int refused = 2;

/// \throws InputError if the command refused every point: that is what the user wrote, and nothing is to be
/// kept.
void refuse_if_all_are_refused(const std::vector<PointResult>& results) {
  for (const PointResult& result : results)
    if (result.done || result.exit_code != refused) return;
  const std::string& first = results.front().error;
  const bool same = std::all_of(results.begin(), results.end(),
                                [&](const PointResult& result) { return result.error == first; });
  // An error that names its --vary names its point.
  const std::string at = first.starts_with("--vary ") ? "" : label_of(results.front().point) + ": ";
  throw InputError(same ? first : fmt::format("{}{} (and the other points are refused too)", at, first));
}

/// Pictures in the order of the points; where they are judged, from the best to the worst, with what they
/// are judged by.
std::vector<SheetEntry> sheet_entries(const std::vector<PointResult>& results,
                                      const std::vector<JudgedPoint>& judged,
                                      const std::vector<Criterion>& criteria) {
  std::vector<std::size_t> order(results.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (!judged.empty())
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
      const double sign = criteria.front().at_least ? 1 : -1;
      const double first = sign * judged[a].value, second = sign * judged[b].value;
      return !std::isnan(first) && (std::isnan(second) || first > second);
    });
  std::vector<SheetEntry> sheet;
  // "least_cpp" of "corners.least_cpp".
  const std::string name =
      criteria.empty() ? "" : criteria.front().column.substr(criteria.front().column.rfind('.') + 1);
  for (const std::size_t i : order) {
    std::string label = label_of(results[i].point);
    if (!judged.empty())
      label += fmt::format("  {} {:.3g}{}", name, judged[i].value, judged[i].good ? "" : "  rejected");
    sheet.push_back({results[i].picture, label});
  }
  return sheet;
}

/// Tables, the sheet and the page. \returns their names.
std::set<std::string> write_summary(const SweepCommand& options, const std::vector<PointResult>& results,
                                    const std::vector<SweptParameter>& parameters, const Json& rows,
                                    const std::vector<JudgedPoint>& judged,
                                    const std::vector<Criterion>& criteria, const Shared& shared) {
  std::set<std::string> names{"sweep.csv", "index.html"};
  const Table table = table_of(rows);
  write_whole_file(options.folder + "/sweep.csv", to_csv(table));
  const std::vector<SheetEntry> sheet = sheet_entries(results, judged, criteria);
  const bool pictures =
      std::ranges::any_of(results, [](const PointResult& result) { return !result.picture.empty(); });
  if (pictures) {
    const double brightening = write_contact_sheet(options.folder + "/contact-sheet.png", sheet,
                                                   pictures_in_unit(options, parameters));
    if (brightening > 1)
      note(shared, fmt::format("contact-sheet.png shows the pictures {:.3g} times as bright as they are",
                               brightening));
    names.insert("contact-sheet.png");
  }
  const std::string plot = options.plot.empty() ? "" : plot_svg(options, parameters, table, shared);
  if (!plot.empty()) write_drawing(options.plot, plot);
  write_page(options, results, table, plot, judged.empty() ? "" : yield_text(judged, criteria), pictures);
  return names;
}

/// All points, to be rendered together.
SweepFrames frames_of(const CLI::App& app, const SweepCommand& options, const std::vector<SweepPoint>& points,
                      const std::vector<std::string>& angles, const Shared& shared) {
  std::vector<std::vector<std::string>> commands;
  for (std::size_t i = 0; i < points.size(); ++i) {
    commands.push_back(words_of_point(app, options, points[i], angles[i], shared));
    commands.back().insert(commands.back().end(), {"-o", options.folder + "/" + name_of_point(i) + ".png"});
  }
  return SweepFrames(std::move(commands));
}

/// What is to be made, and how it is judged.
struct PlannedSweep {
  std::vector<SweptParameter> parameters;
  std::vector<SweepPoint> points;
  std::vector<Criterion> criteria;
};

/// \throws InputError for whatever can be known to be wrong before the first point.
PlannedSweep planned_sweep(const CLI::App& program, const SweepCommand& options, const Shared& shared) {
  std::vector<std::string> words{options.command};
  words.insert(words.end(), options.words.begin(), options.words.end());
  refuse_unknown_words(program, words);
  PlannedSweep plan;
  std::vector<std::string> notes;
  for (const std::string& text : options.vary)
    plan.parameters.push_back(parse_swept(text, notes, options.frames));
  if (!options.clip.empty()) require_clip_maker(options.clip);
  if (plan.parameters.empty() && options.points.empty())
    throw InputError("what is varied? --vary f-number=2,4,8 or --points FILE.csv would be right");
  plan.points = points_of(options, plan.parameters);
  check_plot(options, plan.parameters);
  for (const std::string& text : options.accept) plan.criteria.push_back(parse_criterion(text));
  check_corner_columns(options);
  check_command_lines(swept_app(program, options), options, plan.parameters, shared);
  for (const std::string& text : notes) note(shared, text);
  return plan;
}

struct FinishedPoints {
  std::vector<PointResult> results;
  std::set<std::string> written;  ///< names of files
  std::size_t failed = 0;
};

/// Runs the command at each point. \throws InputError if it refused every one.
FinishedPoints run_points(const CLI::App& app, const SweepCommand& options,
                          const std::vector<SweepPoint>& points, SweepFolder& folder, const Shared& shared) {
  const std::vector<std::string> angles = scene_angles(app, options, points, folder, shared);
  RenderSession renders;
  Shared with_session = shared;
  with_session.renders = &renders;
  std::optional<SweepFrames> frames;
  if (options.share_paths) frames = frames_of(app, options, points, angles, shared);
  if (frames) with_session.frames = &*frames;
  FinishedPoints all;
  std::vector<std::string> held;
  for (const SweepPoint& point : points) {
    const std::size_t index = all.results.size();
    try {
      all.results.push_back(run_point(app, options, point, index, angles[index], with_session));
    } catch (const Cancelled&) {
      if (all.written.empty()) throw;
      throw Interrupted(fmt::format("stopped after {} of {} points; the same command goes on with the rest",
                                    index, points.size()));
    }
    const PointResult& result = all.results.back();
    check_scene_angle(result, angles[index], shared);
    if (!result.done) {
      ++all.failed;
      held.push_back(fmt::format("{}: {}", label_of(point), result.error));
    }
    // As long as every point was refused, their messages wait: if all are, one error says it.
    if (result.done || result.exit_code != refused || all.failed < all.results.size()) {
      for (const std::string& text : held) note(shared, text);
      held.clear();
    }
    if (!result.done) continue;
    if (all.written.empty()) check_quantities(options, all.results, folder);
    folder.keep();
    all.written.insert(name_of_point(index) + ".json");
    for (const std::string& path : result.outputs)
      all.written.insert(std::filesystem::path(path).filename().string());
  }
  refuse_if_all_are_refused(all.results);
  return all;
}

void print_sweep(const SweepCommand& options, const FinishedPoints& all, const Json& rows,
                 const std::vector<JudgedPoint>& judged, const std::vector<Criterion>& criteria,
                 const Shared& shared) {
  if (shared.json) {
    Json json = {{"points", all.results.size()}, {"failed", all.failed}, {"rows", rows}};
    if (!judged.empty()) {
      const Yield yield = yield_of(good_points(judged), judged.size());
      json["yield"] = yield.share;
      json["yield_interval_95"] = {yield.low, yield.high};
      for (const JudgedPoint& point : judged) json["good"].push_back(point.good);
    }
    return print_json(json);
  }
  if (shared.quiet) return;
  fmt::print("{} points, {} failed: {}/index.html, sweep.csv, sweep.json{}\n", all.results.size(), all.failed,
             options.folder, all.written.contains("contact-sheet.png") ? ", contact-sheet.png" : "");
  if (!judged.empty()) fmt::print("{}\n", yield_text(judged, criteria));
}

void sweep(const CLI::App& program, const SweepCommand& options, const Shared& shared) {
  const PlannedSweep plan = planned_sweep(program, options, shared);
  SweepFolder folder(options.folder, planned_files(options, plan.points.size()));
  check_inputs(options, plan.parameters, folder);
  FinishedPoints all = run_points(swept_app(program, options), options, plan.points, folder, shared);
  const Json rows = rows_of(all.results);
  const std::vector<JudgedPoint> judged =
      plan.criteria.empty() ? std::vector<JudgedPoint>() : judged_points(all.results, plan.criteria);
  all.written.merge(
      write_summary(options, all.results, plan.parameters, rows, judged, plan.criteria, shared));
  folder.finish(rows, all.written);
  if (!options.clip.empty() && all.failed == 0)
    write_clip(options.clip, options.folder + "/point-%04d.png", options.frames_per_second);
  if (all.failed == plan.points.size())
    throw Failure(fmt::format("every point failed, the last one: {}", all.results.back().error));
  print_sweep(options, all, rows, judged, plan.criteria, shared);
}

void add_swept(CLI::App& sweeps, CLI::App& program, Shared& shared, const std::string& name,
               const std::string& description, const std::string& example) {
  auto options = std::make_shared<SweepCommand>();
  options->command = name;
  CLI::App* command = nullptr;
  command = add_command(sweeps, shared, name, description, example, true, [options, &program, &shared, name] {
    CLI::App* self = program.get_subcommand("sweep")->get_subcommand(name);
    options->words = self->remaining();
    if (options->scene_width != "same" && options->scene_width != "each")
      options->words.insert(options->words.end(),
                            {"--scene-width", std::exchange(options->scene_width, "same")});
    sweep(program, *options, shared);
  });
  command->allow_extras();
  command
      ->add_option(
          "--vary", options->vary,
          "KEY=START:STEP:STOP or KEY=A,B,…: an option of the command (f-number, focus, sensor, lens), "
          "a parameter of the lens (surfaces[4].thickness_mm) or of the sensor (sensor.pitch_um); "
          "repeatable: all combinations")
      ->take_all()
      ->allow_extra_args(false);
  command->add_option(
      "--points", options->points,
      "A table of points (.csv): a line of such keys, then a line of values a point; a column label "
      "names them. With --vary: each of both");
  command->add_option("-o,--output", options->folder, "Folder for pictures, tables and index.html")
      ->check(output_folder())
      ->required();
  command
      ->add_option("--frames", options->frames,
                   "So many values of a range without a step, --vary KEY=START:STOP")
      ->check(CLI::Range(2, 10000));
  command
      ->add_option(
          "--plot", options->plot,
          "Also plot what was measured over what was varied (.svg, .png, .pdf): a curve for each field, "
          "wavelength, frequency and value of further parameters")
      ->check(output_file());
  command
      ->add_option(
          "--plot-of", options->plot_of,
          "Columns of sweep.csv that the plot shows, separated by commas; default: what the command is "
          "about")
      ->delimiter(',');
  command
      ->add_option(
          "--accept", options->accept,
          "What a good point keeps, COLUMN>=VALUE or COLUMN<=VALUE of sweep.csv: the share of good points "
          "with its interval, and the sheet from the best to the worst (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  if (name == "lens") return;
  command->add_flag("--corners", options->corners,
                    "Measure the edges in the four corners of every picture: MTF50 of each, the least, their "
                    "symmetry, and the colours' offset");
  command
      ->add_option("--clip", options->clip,
                   "Also put the pictures together into a film (.mp4, .webm or .gif), by the program ffmpeg")
      ->check(output_file());
  command->add_option("--fps", options->frames_per_second, "Pictures a second of that")
      ->check(positive_number())
      ->capture_default_str();
  if (name == "render")
    command->add_flag("--share-paths", options->share_paths,
                      "Render all pictures together, in a fraction of the time: points differ in lens and "
                      "focus alone, and the "
                      "path of each ray serves every picture whose lens lets it through. --spp then says how "
                      "noisy a picture is "
                      "at most: as with so many paths of its own; fewer are sent");
  if (name != "image") return;
  command
      ->add_option("--irradiance", options->irradiance, "Keep the irradiance of every point too: exr or npy")
      ->check(CLI::IsMember({"exr", "npy"}));
  command
      ->add_option("--keep", options->kept,
                   "Write these at every point too, as petzval image writes them: dng,exr")
      ->delimiter(',')
      ->check(CLI::IsMember({"dng", "tif", "exr", "npy"}));
  command
      ->add_option("--scene-width", options->scene_width,
                   "A chart or a photograph without --scene-angle is as wide at all points as the widest "
                   "frame needs (same), fills each frame (each), or has a width at its distance (200mm)")
      ->capture_default_str();
}

}  // namespace

void add_sweep_command(CLI::App& app, Shared& shared) {
  CLI::App* sweeps = app.add_subcommand(
      "sweep", "Pictures and numbers over a range of any parameter: a contact sheet and a table");
  sweeps->require_subcommand(1);
  add_swept(*sweeps, app, shared, "image", "Sweep petzval image; what is not listed here goes to it",
            "petzval sweep image checkerboard --lens edmund-54852 --sensor 64x48@60 --wavelengths 550 "
            "--vary surfaces[4].thickness_mm=0.4:0.1:0.6 --vary f-number=2,4 -o sweep");
  add_swept(*sweeps, app, shared, "render",
            "Sweep petzval render: focus, f-number, lens, camera; what is not listed here goes to it",
            "petzval sweep render spheres --lens dgauss-50mm --size 120x90 --spp 16 --vary "
            "focus=1m:0.25m:2m -o sweep");
  add_swept(
      *sweeps, app, shared, "lens", "Sweep an analysis of petzval lens; what is not listed here goes to it",
      "petzval sweep lens distortion edmund-54852 --fields 2 --vary surfaces[4].thickness_mm=0.4:0.1:0.6 "
      "-o sweep");
}

}  // namespace petzval::app
