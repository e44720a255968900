// SPDX-License-Identifier: BSD-3-Clause
// petzval sweep: pictures and numbers over a range of parameters.
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/render/pbrt/scene_files.h>
#include <petzval/report/html.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "child_process.h"
#include "field_option.h"
#include "sweep_points.h"
#include "sweep_sheet.h"

namespace petzval::app {

namespace {

using Json = nlohmann::ordered_json;

struct SweepCommand {
  std::string command;  ///< image or lens
  std::vector<std::string> words;
  std::vector<std::string> vary;
  std::string folder;
  std::string irradiance;
};

/// What became of one point; kept in a file, so that a sweep can go on where it was ended.
struct PointResult {
  SweepPoint point;
  std::vector<std::string> arguments;
  bool done = false;
  std::string error, picture;
  Json checksums;  ///< of the files that the arguments name
  Json numbers;
};

/// The command of this program that is swept, with its options.
const CLI::App& swept_app(const CLI::App& program, const SweepCommand& options) {
  const CLI::App* command = program.get_subcommand(options.command);
  if (options.command != "lens") return *command;
  if (options.words.empty())
    throw InputError("sweep lens: which analysis? sweep lens mtf LENS --vary … would be right");
  for (const CLI::App* below : command->get_subcommands([](const CLI::App*) { return true; }))
    if (below->get_name() == options.words.front()) return *below;
  throw InputError(fmt::format("sweep lens: there is no command lens {}", options.words.front()));
}

/// What the names of a sensor's entries begin with.
constexpr std::string_view sensor_prefix = "sensor.";

/// Arguments of a point: an option of the command, its LENS, an entry of the sensor, or else a --set of the
/// lens.
std::vector<std::string> arguments_of(const CLI::App& app, const SweepCommand& options,
                                      const SweepPoint& point, const Shared& shared) {
  std::vector<std::string> arguments{options.command};
  arguments.insert(arguments.end(), options.words.begin(), options.words.end());
  for (const auto& [key, value] : point) {
    const bool positional = options.command == "lens" && key == "lens";
    if (positional) {
      arguments.insert(arguments.begin() + 2, value);
    } else if (key == "scene" && options.command == "image") {
      arguments.insert(arguments.begin() + 1, value);
    } else if (app.get_option_no_throw("--" + key) != nullptr) {
      arguments.push_back("--" + key);
      arguments.push_back(value);
    } else if (key.starts_with(sensor_prefix) && app.get_option_no_throw("--sensor-set") != nullptr) {
      arguments.push_back("--sensor-set");
      arguments.push_back(key.substr(sensor_prefix.size()) + "=" + value);
    } else {
      arguments.push_back("--set");
      arguments.push_back(key + "=" + value);
    }
  }
  arguments.insert(arguments.end(),
                   {"--threads", std::to_string(shared.threads), "--seed", std::to_string(shared.seed)});
  arguments.push_back("--quiet");
  arguments.push_back("--json");
  return arguments;
}

std::string label_of(const SweepPoint& point) {
  std::string label;
  for (const auto& [key, value] : point) label += (label.empty() ? "" : "  ") + key + " " + value;
  return label;
}

std::string last_line(const std::string& text) {
  std::string_view view(text);
  while (!view.empty() && view.back() == '\n') view.remove_suffix(1);
  const std::size_t at = view.rfind('\n');
  std::string line(at == std::string_view::npos ? view : view.substr(at + 1));
  constexpr std::string_view prefix = "petzval: error: ";
  return line.compare(0, prefix.size(), prefix) == 0 ? line.substr(prefix.size()) : line;
}

/// Checksums of the files that arguments name, as they stand or behind '=': a lens that was edited since
/// makes another point. \param outputs  that the point writes begin so.
Json checksums_of(const std::vector<std::string>& arguments, const std::string& outputs) {
  Json sums = Json::object();
  for (const std::string& argument : arguments)
    for (const std::string& name : {argument, argument.substr(argument.find('=') + 1)}) {
      std::error_code ignored;
      if (!name.starts_with(outputs) && std::filesystem::is_regular_file(name, ignored))
        sums[name] = render::hash_text(read_whole_file(name));
    }
  return sums;
}

Json record_of(const PointResult& result) {
  return {{"version", version()},
          {"arguments", result.arguments},
          {"files", result.checksums},
          {"numbers", result.numbers}};
}

/// Takes the point from an earlier run of the same arguments, if it was finished then.
bool recall(const std::string& record_path, PointResult& result) {
  std::error_code ignored;
  if (!std::filesystem::exists(record_path, ignored)) return false;
  if (!result.picture.empty() && !std::filesystem::exists(result.picture, ignored)) return false;
  const Json record = Json::parse(read_whole_file(record_path), nullptr, false);
  if (record.is_discarded() || !record.is_object() || record.value("version", "") != version() ||
      record.value("arguments", Json()) != Json(result.arguments) ||
      record.value("files", Json()) != result.checksums)
    return false;
  result.numbers = record.value("numbers", Json::object());
  return result.done = true;
}

PointResult run_point(const CLI::App& app, const SweepCommand& options, const SweepPoint& point,
                      std::size_t index, const Shared& shared) {
  PointResult result;
  result.point = point;
  result.arguments = arguments_of(app, options, point, shared);
  const std::string stem = fmt::format("{}/point-{:04}", options.folder, index);
  if (options.command == "image") {
    result.picture = stem + ".png";
    result.arguments.insert(result.arguments.end(), {"-o", result.picture});
    if (!options.irradiance.empty())
      result.arguments.insert(result.arguments.end(), {"-o", stem + "." + options.irradiance});
  }
  result.checksums = checksums_of(result.arguments, stem);
  if (recall(stem + ".json", result)) return result;
  const ChildOutcome outcome = run_again(result.arguments, stem + ".out", stem + ".err");
  result.numbers = Json::parse(outcome.out, nullptr, false);
  result.done = outcome.exit_code == 0 && !result.numbers.is_discarded();
  if (!result.done) {
    result.numbers = Json::object();
    result.error = last_line(outcome.error);
    if (result.error.empty()) result.error = fmt::format("ended with code {}", outcome.exit_code);
    result.picture.clear();
    return result;
  }
  write_whole_file(stem + ".json", record_of(result).dump(1) + "\n");
  return result;
}

/// Puts the plain values of an object into a row, those of objects within it by "outer.inner".
void flatten(const Json& object, const std::string& prefix, Json& row) {
  for (const auto& [key, value] : object.items()) {
    if (value.is_object()) flatten(value, prefix + key + ".", row);
    if (value.is_number() || value.is_string() || value.is_boolean() || value.is_null())
      if (!row.contains(prefix + key)) row[prefix + key] = value;
  }
}

/// Flat rows: one a point, or as many as the command has rows at each.
Json rows_of(const std::vector<PointResult>& results) {
  Json rows = Json::array();
  for (const PointResult& result : results) {
    Json start = Json::object();
    for (const auto& [key, value] : result.point) start[key] = value;
    start["status"] = result.done ? "ok" : "failed";
    if (!result.done) start["error"] = result.error;
    const auto inner = result.numbers.find("rows");
    if (inner == result.numbers.end() || !inner->is_array()) {
      flatten(result.numbers, "", start);
      rows.push_back(start);
      continue;
    }
    for (const Json& values : *inner) {
      Json row = start;
      flatten(values, "", row);
      rows.push_back(row);
    }
  }
  return rows;
}

/// All keys of the rows, in the order in which they first come.
Table table_of(const Json& rows) {
  Table table;
  for (const Json& row : rows)
    for (const auto& [key, value] : row.items())
      if (std::none_of(table.columns.begin(), table.columns.end(),
                       [&key = key](const TableColumn& column) { return column.key == key; }))
        table.columns.push_back({key, "", 5, key});
  for (const Json& row : rows) {
    std::vector<TableCell> cells;
    for (const TableColumn& column : table.columns) {
      const auto found = row.find(column.key);
      if (found == row.end() || found->is_null())
        cells.emplace_back(std::string());
      else if (found->is_number())
        cells.emplace_back(found->get<double>());
      else
        cells.emplace_back(found->is_string() ? found->get<std::string>() : found->dump());
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

void write_page(const SweepCommand& options, const std::vector<PointResult>& results, const Table& table,
                bool pictures) {
  html::Page page(fmt::format("Sweep of petzval {}", options.command),
                  fmt::format("{} points", results.size()));
  if (pictures)
    page.section("Contact sheet")
        .add(html::picture(html::linked_image("contact-sheet.png", "contact sheet")));
  page.section("Numbers").add(html::table(table));
  page.footer(fmt::format("petzval {}", version()));
  write_whole_file(options.folder + "/index.html", page.html());
}

int pictures_per_row(const std::vector<SweptParameter>& parameters) {
  constexpr std::size_t most = 6;
  // Two or more parameters: a row for each value of the others, if the last one fits.
  return static_cast<int>(std::min(most, parameters.back().values.size()));
}

void sweep(const CLI::App& program, const SweepCommand& options, const Shared& shared) {
  const CLI::App& app = swept_app(program, options);
  std::vector<SweptParameter> parameters;
  for (const std::string& text : options.vary) parameters.push_back(parse_swept(text));
  const std::vector<SweepPoint> points = sweep_points(parameters);
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (error) throw InputError(options.folder, "cannot be made: " + error.message());

  std::vector<PointResult> results;
  std::vector<SheetEntry> sheet;
  std::size_t failed = 0;
  for (const SweepPoint& point : points) {
    results.push_back(run_point(app, options, point, results.size(), shared));
    const PointResult& result = results.back();
    sheet.push_back({result.picture, label_of(point)});
    if (result.done) continue;
    ++failed;
    note(shared, fmt::format("{}: {}", label_of(point), result.error));
  }
  const Json rows = rows_of(results);
  const Table table = table_of(rows);
  const bool pictures = options.command == "image" && failed < points.size();
  write_whole_file(options.folder + "/sweep.csv", to_csv(table));
  write_whole_file(options.folder + "/sweep.json", Json{{"rows", rows}}.dump(1) + "\n");
  if (pictures)
    write_contact_sheet(options.folder + "/contact-sheet.png", sheet, pictures_per_row(parameters));
  write_page(options, results, table, pictures);
  if (failed == points.size())
    throw Failure(fmt::format("every point failed, the last one: {}", results.back().error));
  if (shared.json) return print_json({{"points", points.size()}, {"failed", failed}, {"rows", rows}});
  if (!shared.quiet)
    fmt::print("{} points, {} failed: {}/index.html, sweep.csv, sweep.json{}\n", points.size(), failed,
               options.folder, pictures ? ", contact-sheet.png" : "");
}

void add_swept(CLI::App& sweeps, CLI::App& program, Shared& shared, const std::string& name,
               const std::string& description, const std::string& example) {
  auto options = std::make_shared<SweepCommand>();
  options->command = name;
  CLI::App* command = nullptr;
  command = add_command(sweeps, shared, name, description, example, true, [options, &program, &shared, name] {
    CLI::App* self = program.get_subcommand("sweep")->get_subcommand(name);
    options->words = self->remaining();
    sweep(program, *options, shared);
  });
  command->allow_extras();
  command
      ->add_option("--vary", options->vary,
                   "KEY=FROM:TO:STEP or KEY=A,B,…: an option of the command (f-number, focus, sensor, lens), "
                   "a parameter of the lens (surfaces[4].thickness_mm) or of the sensor (sensor.pitch_um); "
                   "repeatable: all combinations")
      ->required()
      ->take_all()
      ->allow_extra_args(false);
  command->add_option("-o,--output", options->folder, "Folder for pictures, tables and index.html")
      ->required();
  if (name == "image")
    command
        ->add_option("--irradiance", options->irradiance,
                     "Keep the irradiance of every point too: exr or npy")
        ->check(CLI::IsMember({"exr", "npy"}));
}

}  // namespace

void add_sweep_command(CLI::App& app, Shared& shared) {
  CLI::App* sweeps = app.add_subcommand(
      "sweep", "Pictures and numbers over a range of any parameter: a contact sheet and a table");
  sweeps->require_subcommand(1);
  add_swept(*sweeps, app, shared, "image", "Sweep petzval image; what is not listed here goes to it",
            "petzval sweep image checkerboard --lens edmund-54852 --sensor 64x48@60 --wavelengths 550 "
            "--vary surfaces[4].thickness_mm=0.4:0.6:0.1 --vary f-number=2,4 -o sweep");
  add_swept(
      *sweeps, app, shared, "lens", "Sweep an analysis of petzval lens; what is not listed here goes to it",
      "petzval sweep lens distortion edmund-54852 --fields 2 --vary surfaces[4].thickness_mm=0.4:0.6:0.1 "
      "-o sweep");
}

}  // namespace petzval::app
