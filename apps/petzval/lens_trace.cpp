// SPDX-License-Identifier: BSD-3-Clause
// petzval lens trace: explicit rays from a CSV file.
#include <fmt/format.h>
#include <petzval/analysis/ray_steps.h>
#include <petzval/base/error.h>
#include <petzval/base/wavelength.h>
#include <petzval/base/whole_file.h>
#include <petzval/trace/tracer.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "field_option.h"
#include "lens_commands.h"
#include "loss_option.h"
#include "output_option.h"

namespace petzval::app {

namespace {

constexpr std::array<std::string_view, 7> ray_columns = {"x_mm", "y_mm", "z_mm",         "L",
                                                         "M",    "N",    "wavelength_nm"};

struct TraceCommand {
  LensChoice lens;
  std::string rays, output;
  bool ignore_apertures = false;
  LossChoice losses;
};

struct RayLine {
  Ray ray;
  double wavelength_nm;
};

std::vector<std::string_view> split(std::string_view line) {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    std::string_view cell = line.substr(0, comma);
    while (!cell.empty() && (cell.front() == ' ' || cell.front() == '\t')) cell.remove_prefix(1);
    while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\t')) cell.remove_suffix(1);
    cells.push_back(cell);
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

/// Which column holds each of ray_columns.
std::array<std::size_t, 7> find_columns(const std::vector<std::string_view>& header, const std::string& file,
                                        int line) {
  std::array<std::size_t, 7> where{};
  for (std::size_t c = 0; c < ray_columns.size(); ++c) {
    const auto found = std::find(header.begin(), header.end(), ray_columns[c]);
    if (found == header.end())
      throw InputError(
          file, line,
          fmt::format("no column {}; the header must be x_mm,y_mm,z_mm,L,M,N,wavelength_nm", ray_columns[c]));
    where[c] = static_cast<std::size_t>(found - header.begin());
  }
  return where;
}

RayLine parse_ray(const std::vector<std::string_view>& cells, const std::array<std::size_t, 7>& where,
                  const std::string& file, int line) {
  std::array<double, 7> value{};
  for (std::size_t c = 0; c < where.size(); ++c) {
    const std::string_view cell = where[c] < cells.size() ? cells[where[c]] : std::string_view();
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value[c]);
    if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value[c]))
      throw InputError(file, line,
                       fmt::format("{} is '{}'; a finite number would be right", ray_columns[c], cell));
  }
  if (const std::string wrong = wavelength_fault(value[6]); !wrong.empty())
    throw InputError(file, line, wrong);
  const double length = std::hypot(value[3], value[4], value[5]);
  if (!(length > 0))
    throw InputError(file, line, "L, M, N are all zero; direction cosines of unit length would be right");
  return {{{value[0], value[1], value[2]}, {value[3] / length, value[4] / length, value[5] / length}},
          value[6]};
}

std::vector<RayLine> read_rays(const std::string& file) {
  const std::string text = read_whole_file(file);
  std::vector<RayLine> rays;
  std::array<std::size_t, 7> where{};
  bool header_seen = false;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line(text.data() + at, end - at);
    at = end + 1;
    ++number;
    const std::vector<std::string_view> cells = split(line);
    if (line.empty() || line.front() == '#' || (cells.size() == 1 && cells[0].empty())) continue;
    if (!header_seen) {
      where = find_columns(cells, file, number);
      header_seen = true;
    } else {
      rays.push_back(parse_ray(cells, where, file, number));
    }
  }
  if (!header_seen)
    throw InputError(file, "is empty; its first line must be x_mm,y_mm,z_mm,L,M,N,wavelength_nm");
  return rays;
}

/// What the rays of one wavelength need.
struct Prepared {
  Tracer tracer;
  LensTransmittance transmittance;
};

struct TracedRay {
  Ray ray;
  double wavelength_nm;
  std::optional<double> transmittance;  ///< with losses, of a ray that arrived
  std::optional<BlockedRay> end;        ///< of one that did not

  bool arrived() const { return ray.status == RayStatus::ok; }
};

TracedRay traced(const RayLine& line, const Prepared& prepared, Tracer::Clip clip, bool with_losses) {
  std::vector<Intersection> path;
  const Ray ray = prepared.tracer.trace(line.ray, clip, with_losses ? &path : nullptr);
  TracedRay result{ray, line.wavelength_nm, {}, {}};
  if (!result.arrived()) result.end = blocked(prepared.tracer, line.ray, clip);
  if (with_losses && result.arrived()) result.transmittance = prepared.transmittance.along(line.ray, path);
  return result;
}

/// By how much an aperture stops it; NaN for one that misses a surface or is totally reflected.
double beyond_mm(const BlockedRay& end) {
  return end.why == RayStatus::vignetted ? end.beyond_mm() : std::numeric_limits<double>::quiet_NaN();
}

std::string beyond_text(const BlockedRay& end) {
  return std::isnan(beyond_mm(end)) ? "nan" : fmt::format("{:.6g}", beyond_mm(end));
}

std::string csv_line(const TracedRay& traced, bool with_losses) {
  const Ray& ray = traced.ray;
  if (!traced.arrived())
    return fmt::format("{},nan,nan,nan,nan,nan,nan,nan{},{},{}\n", to_string(ray.status),
                       with_losses ? ",nan" : "", traced.end->surface, beyond_text(*traced.end));
  std::string text = fmt::format("ok,{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}",
                                 ray.point_mm[0], ray.point_mm[1], ray.point_mm[2], ray.direction[0],
                                 ray.direction[1], ray.direction[2], ray.opl_mm);
  if (traced.transmittance) text += fmt::format(",{:.17g}", *traced.transmittance);
  return text + ",,\n";
}

/// Numbers of a ray that did not arrive are null.
nlohmann::ordered_json json_row(const TracedRay& traced, bool with_losses) {
  const Ray& ray = traced.ray;
  const auto number = [&](double value) { return traced.arrived() ? number_or_null(value) : nullptr; };
  nlohmann::ordered_json row{{"status", to_string(ray.status)}, {"wavelength_nm", traced.wavelength_nm},
                             {"x_mm", number(ray.point_mm[0])}, {"y_mm", number(ray.point_mm[1])},
                             {"z_mm", number(ray.point_mm[2])}, {"L", number(ray.direction[0])},
                             {"M", number(ray.direction[1])},   {"N", number(ray.direction[2])},
                             {"opl_mm", number(ray.opl_mm)}};
  if (with_losses) row["transmittance"] = number(traced.transmittance.value_or(0));
  if (traced.end) {
    row["ends_at_surface"] = traced.end->surface;
    row["beyond_aperture_mm"] = number_or_null(beyond_mm(*traced.end));
  }
  return row;
}

void trace(const TraceCommand& options, const Shared& shared) {
  const Lens lens = options.lens.read(shared);
  const Tracer::Clip clip = options.ignore_apertures ? Tracer::Clip::none : Tracer::Clip::apertures;
  const Losses losses = options.losses.losses(lens, shared).of(lens);
  std::map<double, Prepared> prepared;
  std::string csv = "status,x_mm,y_mm,z_mm,L,M,N,opl_mm";
  csv += losses.any() ? ",transmittance" : "";
  csv += ",ends_at_surface,beyond_aperture_mm\n";
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const RayLine& line : read_rays(options.rays)) {
    const double nm = line.wavelength_nm;
    auto at = prepared.find(nm);
    if (at == prepared.end())
      at = prepared.emplace(nm, Prepared{Tracer(lens, nm), LensTransmittance(lens, nm, losses)}).first;
    const TracedRay result = traced(line, at->second, clip, losses.any());
    csv += csv_line(result, losses.any());
    if (shared.json) rows.push_back(json_row(result, losses.any()));
  }
  if (!options.output.empty()) write_whole_file(options.output, csv);
  if (shared.json)
    print_json({{"lens", lens.name}, {"at", "image surface"}, {"rows", rows}});
  else if (options.output.empty())
    fmt::print("{}", csv);
}

}  // namespace

void add_lens_trace(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<TraceCommand>();
  CLI::App* command = add_command(lens, shared, "trace", "Trace explicit rays to the image surface",
                                  "petzval lens trace cooke-triplet --rays rays.csv -o traced.csv", true,
                                  [=, &shared] { trace(*options, shared); });
  options->lens.add_to(*command);
  command->add_option("--rays", options->rays, "CSV with x_mm,y_mm,z_mm,L,M,N,wavelength_nm in lens space")
      ->required();
  command->add_option("-o,--output", options->output, "CSV to write; default: standard output")
      ->check(output_file());
  command->add_flag("--ignore-apertures", options->ignore_apertures, "Clip no ray");
  options->losses.add_to(*command);
}

}  // namespace petzval::app
