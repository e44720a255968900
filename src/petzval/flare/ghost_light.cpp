// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/flare/ghost_light.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <numeric>
#include <optional>

namespace petzval {

namespace {

constexpr double square_metres_per_mm2 = 1e-6;

/// One pair, of one source at one wavelength.
struct GhostTask {
  std::size_t source = 0, band = 0;
  GhostPair pair = {};
  std::optional<PupilBox> box = {};
  double most_w = 0;  ///< bound of its light
  GhostBundle bundle = {};
  double seconds = 0;
};

double since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<std::unique_ptr<GhostTracer>> tracers_of(const Lens& lens,
                                                     const std::vector<double>& wavelengths_nm,
                                                     const Losses& losses, const GhostLightOptions& options) {
  std::vector<std::unique_ptr<GhostTracer>> tracers(wavelengths_nm.size());
  parallel_tasks(wavelengths_nm.size(), [&](std::size_t band) {
    tracers[band] =
        std::make_unique<GhostTracer>(lens, wavelengths_nm[band], losses, options.sensor, options.clip);
  });
  return tracers;
}

/// Those of four reflections by their light close to the axis, where most of them never get to the sensor.
std::vector<GhostPair> ways_of(const GhostTracer& tracer, const GhostLightOptions& options) {
  std::vector<GhostPair> ways = tracer.pairs();
  if (options.reflections == 2) return ways;
  const auto on_axis = [&](const GhostPair& way) {
    constexpr double tiny_mm = 1e-6;
    Ray ray;
    ray.point_mm = {0, tiny_mm, 0};
    ray.direction = {0, 0, 1};
    return tracer.follow(ray, way).share;
  };
  double brightest = 0;
  for (const GhostPair& way : ways) brightest = std::max(brightest, on_axis(way));
  for (const GhostPair& way : tracer.double_pairs())
    if (on_axis(way) > options.neglected_share * brightest) ways.push_back(way);
  return ways;
}

/// Adds the light of bundles to a band, stripe by stripe.
void add_light(std::span<const GhostTask> tasks, double irradiance, const SensorGeometry& frame,
               std::span<float> pixels) {
  constexpr int stripe_rows = 32;
  const int stripes = (frame.rows + stripe_rows - 1) / stripe_rows;
  const double pixel_mm = frame.pitch_um * mm_per_um;
  const double scale = irradiance / (pixel_mm * pixel_mm);
  parallel_tasks(static_cast<std::size_t>(stripes), [&](std::size_t stripe) {
    const int from = static_cast<int>(stripe) * stripe_rows, to = std::min(frame.rows, from + stripe_rows);
    std::vector<double> flux(static_cast<std::size_t>(to - from) * static_cast<std::size_t>(frame.columns));
    for (const GhostTask& task : tasks) deposit_facets(task.bundle.facets, {frame.columns, from, to, flux});
    float* out = pixels.data() + static_cast<std::size_t>(from) * static_cast<std::size_t>(frame.columns);
    for (std::size_t i = 0; i < flux.size(); ++i)
      out[i] += static_cast<float>(std::max(flux[i], 0.0) * scale);
  });
}

/// The faintest ways that together stay below the share; the others stay in their order.
void leave_out_faint(double share, std::vector<GhostTask>& tasks, GhostLightReport& report) {
  std::vector<std::size_t> order(tasks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order,
                           [&](std::size_t a, std::size_t b) { return tasks[a].most_w < tasks[b].most_w; });
  const double all = std::accumulate(tasks.begin(), tasks.end(), 0.0,
                                     [](double sum, const GhostTask& task) { return sum + task.most_w; });
  double left_out = 0;
  for (const std::size_t i : order) {
    if (!tasks[i].box) continue;
    if (left_out + tasks[i].most_w > share * all) break;
    left_out += tasks[i].most_w;
    tasks[i].box.reset();
    ++report.neglected;
  }
  report.neglected_share = all > 0 ? left_out / all : 0;
}

void check_light(const SensorGeometry& frame, const std::vector<double>& wavelengths_nm,
                 std::span<const BrightSource> sources, const GhostLightOptions& options) {
  SpectralImage::check(frame.columns, frame.rows, wavelengths_nm, frame.pitch_um);
  for (const BrightSource& source : sources) source.validate(wavelengths_nm.size());
  options.validate();
}

/// Follows ways of which the boxes are known, source by source and band by band, and adds their light.
SpectralImage followed_light(const std::vector<std::unique_ptr<GhostTracer>>& tracers,
                             const SensorGeometry& frame, const std::vector<double>& wavelengths_nm,
                             std::span<const BrightSource> sources, const GhostLightOptions& options,
                             std::vector<GhostTask>& tasks, const ProgressCallback& progress) {
  SpectralImage light(frame.columns, frame.rows, wavelengths_nm, frame.pitch_um);
  for (std::size_t begin = 0, end = 0; begin < tasks.size(); begin = end) {
    const GhostTask& head = tasks[begin];
    while (end < tasks.size() && tasks[end].source == head.source && tasks[end].band == head.band) ++end;
    const std::span<GhostTask> here(tasks.data() + begin, end - begin);
    const BrightSource& source = sources[head.source];
    const GhostTracer& tracer = *tracers[head.band];
    parallel_tasks(here.size(), [&](std::size_t i) {
      GhostTask& task = here[i];
      if (!task.box) return;
      const auto start = std::chrono::steady_clock::now();
      task.bundle = trace_bundle(tracer, task.pair, source, *task.box, frame, options.bundle);
      task.seconds += since(start);
    });
    add_light(here, source.irradiance[head.band], frame, light.band(static_cast<int>(head.band)));
    for (GhostTask& task : here) task.bundle.facets = {};
    if (progress) progress(static_cast<double>(end) / static_cast<double>(tasks.size()), "ghosts");
  }
  return light;
}

std::vector<GhostPairReport> by_pair(std::span<const GhostTask> tasks,
                                     std::span<const BrightSource> sources) {
  std::vector<GhostPairReport> pairs;
  for (const GhostTask& task : tasks) {
    auto at = std::ranges::find(pairs, task.pair, &GhostPairReport::pair);
    if (at == pairs.end()) at = pairs.insert(pairs.end(), {task.pair});
    at->flux_w += task.bundle.flux_mm2 * square_metres_per_mm2 * sources[task.source].irradiance[task.band];
    at->rays += task.bundle.rays + (task.box ? task.box->rays : 0);
    at->seconds += task.seconds;
  }
  std::ranges::stable_sort(pairs, [](const auto& a, const auto& b) { return a.flux_w > b.flux_w; });
  return pairs;
}

}  // namespace

void GhostLightOptions::validate() const {
  bundle.validate();
  if (reflections != 2 && reflections != 4)
    throw InputError(fmt::format("`ghost_reflections` is {}; 2 or 4 would be right", reflections));
  if (!(neglected_share >= 0 && neglected_share < 1))
    throw InputError(
        fmt::format("`ghost_neglect` is {:g}; 0 to less than 1 would be right", neglected_share));
}

SpectralImage ghost_light(const Lens& lens, const SensorGeometry& frame,
                          const std::vector<double>& wavelengths_nm, std::span<const BrightSource> sources,
                          const GhostLightOptions& options, const ProgressCallback& progress,
                          GhostLightReport* report) {
  check_light(frame, wavelengths_nm, sources, options);
  const auto tracers = tracers_of(lens, wavelengths_nm, options.losses, options);
  std::vector<std::vector<GhostPair>> ways(wavelengths_nm.size());
  parallel_tasks(ways.size(), [&](std::size_t band) { ways[band] = ways_of(*tracers[band], options); });
  std::vector<GhostTask> tasks;
  for (std::size_t source = 0; source < sources.size(); ++source)
    for (std::size_t band = 0; band < wavelengths_nm.size(); ++band)
      for (const GhostPair& pair : ways[band]) tasks.push_back({source, band, pair});
  parallel_for(tasks.size(), [&](std::size_t i) {
    GhostTask& task = tasks[i];
    const double irradiance = sources[task.source].irradiance[task.band];
    if (irradiance == 0) return;
    const auto start = std::chrono::steady_clock::now();
    task.box = find_pupil_box(*tracers[task.band], task.pair, SourceBeam(sources[task.source]), frame);
    if (task.box) task.most_w = task.box->most_mm2 * square_metres_per_mm2 * irradiance;
    task.seconds = since(start);
  });
  GhostLightReport unwanted;
  GhostLightReport& says = report ? *report : unwanted;
  says = {};
  leave_out_faint(options.neglected_share, tasks, says);
  SpectralImage light = followed_light(tracers, frame, wavelengths_nm, sources, options, tasks, progress);
  says.pairs = by_pair(tasks, sources);
  for (const GhostTask& task : tasks) says.followed += task.box ? 1 : 0;
  for (const GhostPairReport& pair : says.pairs) says.ghost_flux_w += pair.flux_w;
  const double pixel_m = frame.pitch_um * 1e-6;
  for (const float value : light.values()) says.frame_flux_w += double(value) * pixel_m * pixel_m;
  return light;
}

Losses losses_of_picture(const Lens& lens, double wavelength_nm, const Losses& given) {
  Losses losses = given.of(lens);
  if (losses.fresnel) return losses;
  double before = 1;
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
    const double after = lens.medium_behind(i).index(wavelength_nm);
    if (!lens.surfaces[i].mirror && !losses.coating(i, before, after))
      losses.surfaces[i] = Coating::constant(0);
    before = after;
  }
  return losses;
}

SpectralImage straight_light(const Lens& lens, const SensorGeometry& frame,
                             const std::vector<double>& wavelengths_nm, std::span<const BrightSource> sources,
                             const GhostLightOptions& options, const ProgressCallback& progress) {
  check_light(frame, wavelengths_nm, sources, options);
  const Losses losses = losses_of_picture(lens, wavelengths_nm.front(), options.losses);
  const auto tracers = tracers_of(lens, wavelengths_nm, losses, options);
  std::vector<GhostTask> tasks;
  for (std::size_t source = 0; source < sources.size(); ++source)
    for (std::size_t band = 0; band < wavelengths_nm.size(); ++band)
      tasks.push_back({source, band, GhostPair::straight()});
  parallel_for(tasks.size(), [&](std::size_t i) {
    GhostTask& task = tasks[i];
    if (sources[task.source].irradiance[task.band] == 0) return;
    task.box = find_pupil_box(*tracers[task.band], task.pair, SourceBeam(sources[task.source]), frame);
  });
  return followed_light(tracers, frame, wavelengths_nm, sources, options, tasks, progress);
}

}  // namespace petzval
