// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/best_focus.h>
#include <petzval/base/error.h>
#include <petzval/base/isolated.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/units.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/colour/display.h>
#include <petzval/colour/observer.h>
#include <petzval/focus/focus_scan.h>
#include <petzval/focus/golden_search_2006.h>
#include <petzval/lens/first_order.h>
#include <petzval/simulate/depth_of_field.h>
#include <petzval/simulate/prepared_world.h>
#include <petzval/simulate/scene_depth.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// How far from the focus of infinity the film may go, in focal lengths: as far as for an object eight focal
/// lengths away.
constexpr double extension = 0.15;
/// Where golden section ends, in depths of focus.
constexpr double share_of_depth = 0.05;
/// How far the film may go beyond the focus of infinity, in depths of focus: a peak there has two flanks.
constexpr double depths_beyond = 4;
/// A measure whose noise is a larger share of its peak is ragged: the peak is uncertain by a quarter of a
/// depth of focus.
constexpr double ragged = 0.1;
/// How often the samples are made four times as many for a ragged measure.
constexpr int more_samples_times = 2;

/// Where the film stands for an object at infinity: at the paraxial focus, or where the spot on the axis is
/// smallest, whichever is nearer to the lens (spherical aberration parts them).
double infinity_focus_mm(const Lens& lens) {
  MountedLens camera(lens);
  camera.focus_at_m({});
  FieldTableRequest axis = FieldTableRequest::of(camera.lens());
  axis.field_kind = Fields::Kind::angle_deg, axis.fields = {0};
  const double film_mm = camera.lens().image_distance_mm();
  return std::min(paraxial_image_distance_mm(lens, {}, lens.reference_wavelength_nm),
                  film_mm + best_spot_focus(camera.lens(), axis).shift_mm);
}

render::PixelWindow window_of(const FocusZone& zone, const SensorGeometry& film) {
  const auto at = [](double share, int pixels) {
    return std::clamp(static_cast<int>(std::lround(share * pixels)), 0, pixels);
  };
  const render::PixelWindow window{at(zone.left, film.columns), at(zone.top, film.rows),
                                   at(zone.right, film.columns), at(zone.bottom, film.rows)};
  if (window.columns() < 4 || window.rows() < 4)
    throw InputError(
        fmt::format("the zone {:g} {:g} {:g} {:g} has {} x {} pixels; at least 4 x 4 would be right",
                    zone.left, zone.right, zone.top, zone.bottom, window.columns(), window.rows()));
  return window;
}

/// max(R, G, B) of every pixel.
GreyPicture brightest_component(const SpectralImage& image) {
  const std::vector<Xyz> weights = Observer::cie_1931().weights(image.wavelengths_nm());
  GreyPicture grey{image.columns(), image.rows(), std::vector<double>(image.band_size())};
  for (std::size_t i = 0; i < image.band_size(); ++i) {
    Xyz sum;
    for (int band = 0; band < image.bands(); ++band)
      sum = sum + static_cast<double>(image.band(band)[i]) * weights[static_cast<std::size_t>(band)];
    const LinearRgb rgb = linear_srgb(sum);
    grey.values[i] = std::max({rgb.r, rgb.g, rgb.b});
  }
  return grey;
}

/// Eight wavelengths, which one path serves.
std::vector<double> eight_wavelengths_nm() {
  return {430, 465, 500, 535, 570, 605, 640, 675};
}

/// Renders the zones of a scene, and counts the camera rays.
class ZoneRenderer {
 public:
  ZoneRenderer(const PreparedScene& scene, const render::World& world, std::vector<FocusZone> zones,
               const Context& context)
      : scene_(scene),
        world_(world),
        zones_(std::move(zones)),
        context_(context),
        samples_(scene.request.autofocus.samples_per_pixel) {}

  std::vector<ZonePicture> at(double film_distance_mm) {
    const render::SceneCamera moved = scene_camera(scene_).with_film_distance_mm(film_distance_mm);
    const auto camera = moved.make(world_.groups);
    std::vector<ZonePicture> pictures;
    for (const FocusZone& zone : zones_) {
      const render::PixelWindow window = window_of(zone, moved.film);
      GreyPicture first = picture(moved, *camera, window, 2 * context_.seed);
      pictures.push_back({std::move(first), picture(moved, *camera, window, 2 * context_.seed + 1)});
    }
    return pictures;
  }
  const std::vector<FocusZone>& zones() const { return zones_; }
  std::uint64_t rays() const { return rays_; }
  int samples() const { return samples_; }
  void take_more_samples() { samples_ *= 4; }

 private:
  GreyPicture picture(const render::SceneCamera& set_up, const render::FilmCamera& camera,
                      const render::PixelWindow& window, std::uint64_t seed) {
    render::RenderOptions options = render_options(scene_);
    options.samples_per_pixel = std::max(1, samples_ / 2);
    options.window = window;
    options.seed = seed;
    const render::Rendering rendered =
        render_picture(world_, camera, set_up.world_from_camera, set_up.film, options);
    rays_ += rendered.rays;
    return brightest_component(rendered.irradiance);
  }

  const PreparedScene& scene_;
  const render::World& world_;
  std::vector<FocusZone> zones_;
  const Context& context_;
  int samples_;
  std::uint64_t rays_ = 0;
};

std::vector<FocusZone> zones_or_middle(const AutofocusOptions& options) {
  return options.zones.empty() ? std::vector<FocusZone>{{1.0 / 3, 2.0 / 3, 1.0 / 3, 2.0 / 3}} : options.zones;
}

/// Film distances to search, and the depth of focus.
struct FocusRange {
  double from_mm, to_mm, depth_mm;
};

FocusRange range_of(const PreparedScene& scene) {
  const AutofocusOptions& wanted = scene.request.autofocus;
  const FirstOrder first = first_order(*scene.lens);
  const double depth_mm = wanted.depth_mm.value_or(first.f_number * scene.film.pitch_um * mm_per_um);
  const double infinity_mm = infinity_focus_mm(*scene.lens);
  return {wanted.from_mm.value_or(std::max(infinity_mm - depths_beyond * depth_mm, infinity_mm / 2)),
          wanted.to_mm.value_or(infinity_mm + extension * first.efl_mm), depth_mm};
}

FocusResult searched(const AutofocusOptions& wanted, const PicturesAt& pictures,
                     const std::vector<FocusZone>& zones, const FocusRange& range) {
  if (wanted.search == AutofocusOptions::Search::golden_2006) {
    GoldenSearchOptions options;
    options.measure = wanted.measure;
    options.nearest_mm = range.from_mm, options.farthest_mm = range.to_mm;
    options.tolerance_mm = share_of_depth * range.depth_mm;
    options.most_evaluations = wanted.most_evaluations;
    return find_focus_2006(pictures, zones, options);
  }
  if (wanted.search == AutofocusOptions::Search::scan)
    return scan_focus(pictures, zones, wanted.measure, range.from_mm, range.to_mm,
                      wanted.most_evaluations.value_or(AutofocusOptions::usual_evaluations));
  FocusSearchOptions options;
  options.measure = wanted.measure;
  options.nearest_mm = range.from_mm, options.farthest_mm = range.to_mm;
  options.depth_mm = range.depth_mm;
  options.most_evaluations = wanted.most_evaluations.value_or(AutofocusOptions::usual_evaluations);
  return find_focus(pictures, zones, options);
}

/// \throws InputError for a measure that tells nothing of focus.
void require_a_peak(const FocusResult& result, int samples) {
  if (result.noise_share() > ragged)
    throw InputError(
        fmt::format("the focus measure is ragged: with {} paths a pixel its noise is {:.0f} % of its peak; a "
                    "larger zone (`zones`), one with more detail, or more paths (`focus_spp`) would be right",
                    samples, 100 * result.noise_share()));
  if (result.at_the_end)
    throw InputError(fmt::format(
        "the sharpest of the film distances searched, {:.4f} mm, is the last of them; a range that "
        "reaches beyond it (`autofocus.from_mm`, `autofocus.to_mm`), or a zone that can be sharp "
        "within it (`zones`), would be right",
        result.film_distance_mm));
}

FocusRun search(const PreparedScene& scene, const render::World& world, const Context& context,
                const ProgressCallback& progress) {
  const AutofocusOptions& wanted = scene.request.autofocus;
  ZoneRenderer zones(scene, world, zones_or_middle(wanted), context);
  int asked = 0;
  const int usual = wanted.most_evaluations.value_or(AutofocusOptions::usual_evaluations);
  const PicturesAt pictures = [&](double film_distance_mm) {
    progress(std::min(1.0, asked++ / static_cast<double>(std::max(1, usual))), "focus");
    return zones.at(film_distance_mm);
  };
  const FocusRange range = range_of(scene);
  FocusRun run;
  run.lens = scene.lens->name;
  for (const FocusZone& zone : zones.zones())
    run.zones +=
        fmt::format(", zone {:.3g} {:.3g} {:.3g} {:.3g}", zone.left, zone.right, zone.top, zone.bottom);
  run.depth_mm = range.depth_mm;
  run.result = searched(wanted, pictures, zones.zones(), range);
  for (int more = 0; more < more_samples_times && run.result.noise_share() > ragged; ++more) {
    zones.take_more_samples();
    asked = 0;
    run.result = searched(wanted, pictures, zones.zones(), range);
  }
  require_a_peak(run.result, zones.samples());
  run.samples_per_pixel = zones.samples();
  run.camera_rays = zones.rays();
  return run;
}

/// By which the sensor stands behind the paraxial image where the spot on the axis is smallest.
double best_spot_shift_mm(const Lens& lens) {
  Lens sharp = lens;
  const double distance_mm = distance_in_focus_m(lens) * mm_per_m - lens.total_track_mm();
  sharp.object_distance_mm = std::isfinite(distance_mm) ? std::optional(distance_mm) : std::nullopt;
  sharp.set_image_distance_mm(
      paraxial_image_distance_mm(sharp, sharp.object_distance_mm, lens.reference_wavelength_nm));
  FieldTableRequest axis = FieldTableRequest::of(sharp);
  axis.field_kind = Fields::Kind::angle_deg, axis.fields = {0};
  if (sharp.object_distance_mm) axis.field_kind = Fields::Kind::object_height_mm;
  return best_spot_focus(sharp, axis).shift_mm;
}

/// A note for every zone in which two things stand, one behind the other.
void note_two_depths(const PreparedScene& scene, const FocusRun& run, const Context& context) {
  Lens lens = *scene.lens;
  const double object_mm = run.distance_m * mm_per_m - lens.total_track_mm();
  if (!std::isfinite(object_mm)) return;
  lens.object_distance_mm = object_mm;
  const DepthOfField sharp = geometric_depth_of_field(lens, scene.film.pitch_um * mm_per_um);
  for (const FocusZone& zone : zones_or_middle(scene.request.autofocus)) {
    const auto parted =
        parted_depths(depths_seen_m(scene, window_of(zone, scene.film)), sharp.far_m - sharp.near_m);
    if (parted)
      send_note(
          context,
          fmt::format(
              "two things stand in the zone {:g} {:g} {:g} {:g}, {:.3g} m and {:.3g} m away; {:.3g} m "
              "is sharp (`focus` {:.3g}m is the other)",
              zone.left, zone.right, zone.top, zone.bottom, parted->near_m, parted->far_m, run.distance_m,
              std::abs(run.distance_m - parted->near_m) > std::abs(run.distance_m - parted->far_m)
                  ? parted->near_m
                  : parted->far_m));
  }
}

}  // namespace

AutofocusOptions::Search autofocus_search_of(std::string_view name) {
  if (name == "brent") return AutofocusOptions::Search::brent;
  if (name == "golden-2006") return AutofocusOptions::Search::golden_2006;
  if (name == "scan") return AutofocusOptions::Search::scan;
  throw InputError(
      fmt::format("`focus_search` {}: brent, golden-2006 or scan would be right", quotable(name)));
}

const render::World& world_for_focus(const PreparedScene& scene) {
  if (!scene.request.wavelengths_nm.empty()) return *scene.world->world;
  WorldForFocus& kept = *scene.world->for_focus;
  std::call_once(kept.once, [&] {
    run_isolated([&] {
      render::Unsupported unsupported(true);  // what it finds has been reported
      kept.world =
          build_world_at(*scene.world->description, scene.request, eight_wavelengths_nm(), unsupported);
    });
  });
  return *kept.world;
}

const FocusRun& autofocus(PreparedScene& scene, const Context& context) {
  if (!scene.lens) throw InputError("an ideal camera has nothing to focus; `lens` names a lens");
  if (scene.request.camera.image_distance_mm)
    throw InputError("`image_distance_mm` and autofocus both place the sensor; one of them would be right");
  FocusRun run = result_within(context, [&](const ProgressCallback& progress) {
    return search(scene, world_for_focus(scene), context, progress);
  });
  scene.lens = scene_camera(scene).with_film_distance_mm(run.result.film_distance_mm).lens;
  run.distance_m = distance_in_focus_m(*scene.lens, best_spot_shift_mm(*scene.lens));
  note_two_depths(scene, run, context);
  scene.focus = std::move(run);
  return *scene.focus;
}

std::vector<PictureFrame> frames_of_zones(const PreparedScene& scene) {
  std::vector<PictureFrame> frames;
  for (const FocusZone& zone : zones_or_middle(scene.request.autofocus)) {
    const render::PixelWindow window = window_of(zone, scene.film);
    frames.push_back({window.left, window.top, window.right, window.bottom});
  }
  return frames;
}

FocusRun autofocus(RenderRequest request, const Context& context) {
  if (request.wavelengths_nm.empty()) request.wavelengths_nm = eight_wavelengths_nm();
  PreparedScene scene = prepare_scene(request, context);
  return autofocus(scene, context);
}

}  // namespace petzval
