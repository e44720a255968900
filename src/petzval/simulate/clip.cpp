// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/simulate/clip_light.h>
#include <petzval/simulate/prepared_exposure.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

constexpr int most_frames = 1 << 20;
constexpr double fastest_fps = 1e6;

/// Instants between which no more time passes than this.
std::vector<double> finer(const std::vector<double>& instants, double step_s) {
  std::vector<double> at{instants.front()};
  for (std::size_t k = 1; k < instants.size(); ++k) {
    const double a = instants[k - 1], b = instants[k], steps = std::ceil((b - a) / step_s);
    for (double i = 1; i < steps; ++i) at.push_back(a + (b - a) * i / steps);
    at.push_back(b);
  }
  return at;
}

/// Work that tells nothing of its own.
Context quiet(const Context& context) {
  Context inner;
  inner.threads = context.threads;
  inner.seed = context.seed;
  return inner;
}

}  // namespace

void ClipOptions::validate() const {
  if (frames < 1 || frames > most_frames)
    throw InputError(fmt::format("a clip of {} frames; 1 to {} would be right", frames, most_frames));
  if (!(fps > 0 && fps <= fastest_fps))
    throw InputError(
        fmt::format("{:g} frames a second; above 0 and up to {:g} would be right", fps, fastest_fps));
  constexpr double finest_px = 1e-3, coarsest_px = 16;
  if (!(step_px >= finest_px && step_px <= coarsest_px))
    throw InputError(
        fmt::format("steps of {:g} pixels; {:g} to {:g} would be right", step_px, finest_px, coarsest_px));
  constexpr int most_instants = 1 << 16;
  if (instants < 1 || instants > most_instants)
    throw InputError(fmt::format("{} instants an exposure; 1 to {} would be right", instants, most_instants));
  if (expose.frames != 1)
    throw InputError("frames of a clip are single exposures; averages of them would be made afterwards");
}

/// What is settled of a clip.
struct Clip::Impl {
  Impl(std::unique_ptr<const ClipLight> of_clip, const Sensor& sensor, const ClipOptions& asked,
       const Context& context)
      : light(std::move(of_clip)),
        options(asked),
        seed(context.seed),
        shutter(options.shutter.value_or(sensor.electronics->shutter)),
        exposure(light->first(context), sensor, options.expose, context) {
    const double readout_s = shutter.row_delay_s(light->rows());
    if (readout_s > options.frame_s() * (1 + rounding))
      throw InputError(
          fmt::format("the rolling shutter reads {} rows in {:.4g} s, which is longer than a frame at {:g} "
                      "frames a second; "
                      "a lower `fps`, or fewer rows, would be right",
                      light->rows(), readout_s, options.fps));
    const double whole_s = staggered_s(options.expose.bracket_ev.size());
    if (whole_s <= options.frame_s() * (1 + rounding)) return;
    if (options.expose.exposure.kind != Exposure::Kind::automatic)
      throw InputError(
          fmt::format("an exposure of {:.4g} s is longer than a frame at {:g} frames a second, {:.4g} s; a "
                      "shorter one, or "
                      "a lower `fps`, would be right",
                      whole_s, options.fps, options.frame_s()));
    exposure.set_seconds(exposure.seconds() * options.frame_s() / whole_s);
    send_note(context,
              fmt::format("automatic exposure would take {:.4g} s; a frame lasts {:.4g} s, and so does "
                          "the exposure",
                          whole_s, options.frame_s()));
  }

  static constexpr double rounding = 1e-9;

  double exposed_s(std::size_t index) const {
    const std::vector<double>& ev = options.expose.bracket_ev;
    return exposure.seconds() * (ev.empty() ? 1 : std::exp2(ev[index]));
  }
  /// All exposures before this one.
  double staggered_s(std::size_t index) const {
    if (options.expose.bracket_ev.empty()) return exposure.seconds();
    double sum = 0;
    for (std::size_t i = 0; i < index; ++i) sum += exposed_s(i);
    return sum;
  }
  FrameTiming timing(int frame, std::size_t index) const {
    const double after = options.expose.bracket_ev.empty() ? 0 : staggered_s(index);
    return {frame * options.frame_s() + after, exposed_s(index), shutter};
  }
  std::vector<double> instants(const FrameTiming& timing) const {
    return light->instants(timing.start_s, timing.end_s(light->rows()), timing.exposure_s);
  }

  /// Walks through instants with the current at each. \param rows_of  that are wanted of an instant.
  template <typename See>
  void walk(const std::vector<double>& instants, const ClipLight::RowsOf& rows_of, const See& see) const {
    std::shared_ptr<const PhotoCurrent> current(std::shared_ptr<const PhotoCurrent>(),
                                                &exposure.first_current());
    light->walk(instants, rows_of, [&](std::size_t k, const SpectralImage* image) {
      if (image) current = std::make_shared<const PhotoCurrent>(exposure.current(*image));
      see(k, current);
    });
  }

  /// What each instant gives to an exposure whose rows are all open at the same time.
  std::vector<InstantShare> shares_of(const TimedExposure& timed, const std::vector<double>& at,
                                      double exposure_s) const {
    std::vector<InstantShare> result;
    for (const double t_s : at) result.push_back({t_s, 0});
    for (std::size_t k = 1; k < at.size(); ++k) {
      const TimedExposure::Shares shares = timed.shares(0, at[k - 1], at[k]);
      result[k - 1].share += shares.of_t0 / exposure_s;
      result[k].share += shares.of_t1 / exposure_s;
    }
    return result;
  }

  /// Of an exposure, over its time. \param tell  is told how much of it is done.
  PhotoCurrent mean_current(const FrameTiming& timing, const std::function<void(double)>& tell) const {
    const int rows = light->rows();
    const std::vector<double> at = instants(timing);
    TimedExposure timed(timing, options.flicker);
    if (timing.shutter.row_delay_s(rows) == 0)
      if (const std::optional<SpectralImage> sum = light->sum(shares_of(timed, at, timing.exposure_s)))
        return exposure.current(*sum);
    // Beside the rows that are open between two instants, those that crosstalk reaches.
    const auto open_rows = [&](std::size_t k) {
      const double before_s = at[k > 0 ? k - 1 : k], after_s = at[k + 1 < at.size() ? k + 1 : k];
      RowRange open{rows, 0};
      for (int row = 0; row < rows; ++row) {
        const double from_s = timing.row_start_s(row);
        if (from_s > after_s || from_s + timing.exposure_s < before_s) continue;
        open = {std::min(open.first, row), row + 1};
      }
      return RowRange{std::max(0, open.first - 1), std::min(rows, open.end + 1)};
    };
    std::shared_ptr<const PhotoCurrent> before;
    walk(at, open_rows, [&](std::size_t k, const std::shared_ptr<const PhotoCurrent>& now) {
      if (k > 0) timed.add(at[k - 1], *before, at[k], *now);
      before = now;
      tell(double(k + 1) / double(at.size()));
    });
    return timed.mean_current();
  }

  std::unique_ptr<const ClipLight> light;
  ClipOptions options;
  std::uint64_t seed;
  Shutter shutter;
  PreparedExposure exposure;
};

ImagePlan plan_clip(const SceneRequest& scene, Optics optics, const ImageOptions& options,
                    const MotionPath& motion, const Context& context) {
  ImagePlan plan = plan_image(scene, optics, options, context);
  if (plan.scene.is_panorama() || !fills_frame(scene, optics, options)) return plan;
  const double half = plan.scene.columns() / 2.0, high = plan.scene.rows() / 2.0;
  double widening = 1;
  for (const MotionPath::Key& key : motion.keys()) {
    key.aim.check(plan.scene);
    const AimedPlane aimed(key.aim, plan.scene);
    for (const double right : {-half, half})
      for (const double down : {-high, high}) {
        const AimedPlane::Place corner = aimed.at(right, down);
        if (std::isnan(corner.right))
          throw InputError("the camera turns away from the plane of the scene; a panorama would be right");
        widening = std::max({widening, std::abs(corner.right) / half, std::abs(corner.down) / high});
      }
  }
  if (widening == 1) return plan;
  constexpr double room = 5e-3;  // of a wider plane the sides are seen a little farther out
  const double angle_deg =
      degrees(2 * std::atan((widening + room) * std::tan(radians(plan.scene.horizontal_angle_deg()) / 2)));
  send_note(context, fmt::format("the scene is {:.4g} degrees wide, so that it fills the frame all the way",
                                 angle_deg));
  SceneRequest wider = scene;
  wider.options.horizontal_angle_deg = angle_deg;
  return plan_image(wider, std::move(optics), options, quiet(context));
}

Clip::Clip(ImagePlan plan, const Sensor& sensor, const ClipOptions& options, const Context& context) {
  options.validate();
  sensor.require_electronics();
  for (const MotionPath::Key& key : options.motion.keys()) key.aim.check(plan.scene);
  impl_ = result_within(context, [&](const ProgressCallback&) {
    return std::make_unique<Impl>(light_of_plan(std::move(plan), options), sensor, options, context);
  });
}

Clip::Clip(const RenderRequest& scene, const Sensor& sensor, const ClipOptions& options,
           const Context& context) {
  options.validate();
  sensor.require_electronics();
  if (!options.motion.is_rest())
    throw InputError(
        "a scene in three dimensions has its motion in its file, and its camera's (ActiveTransform); neither "
        "turning nor a path would be right");
  impl_ = result_within(context, [&](const ProgressCallback&) {
    return std::make_unique<Impl>(rendered_light(scene, options, context), sensor, options, context);
  });
}

Clip::~Clip() = default;

double Clip::exposure_s() const {
  return impl_->exposure.seconds();
}

const Shutter& Clip::shutter() const {
  return impl_->shutter;
}

FrameTiming Clip::timing(int frame, std::size_t exposure) const {
  return impl_->timing(frame, exposure);
}

std::size_t Clip::instants(int frame) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < std::max<std::size_t>(1, impl_->options.expose.bracket_ev.size()); ++i) {
    count += impl_->instants(impl_->timing(frame, i)).size();
  }
  return count;
}

RawImage Clip::frame(int index, const Context& context) const {
  if (index < 0 || index >= impl_->options.frames)
    throw InputError(fmt::format("frame {} of a clip of {}; 0 to {} would be right", index,
                                 impl_->options.frames, impl_->options.frames - 1));
  return result_within(context, [&](const ProgressCallback& progress) {
    std::vector<PhotoCurrent> currents;
    const std::size_t exposures = std::max<std::size_t>(1, impl_->options.expose.bracket_ev.size());
    for (std::size_t i = 0; i < exposures; ++i) {
      currents.push_back(impl_->mean_current(impl_->timing(index, i), [&](double share) {
        if (progress) progress((double(i) + share) / double(exposures), "frame");
      }));
    }
    RawImage raw = impl_->exposure.raw(currents, impl_->seed, index);
    if (raw.date_time) raw.date_time = later(*raw.date_time, impl_->timing(index, 0).start_s);
    return raw;
  });
}

void Clip::events(const EventCameraOptions& options, const TakeEvents& take, const Context& context) const {
  run_within(context, [&](const ProgressCallback& progress) {
    const LampFlicker& flicker = impl_->options.flicker;
    const double end_s = impl_->options.duration_s();
    EventCamera camera(options);
    std::vector<double> at = impl_->light->instants(0, end_s, impl_->exposure.seconds());
    if (!flicker.is_steady()) at = finer(at, 1 / (flicker.frequency_hz() * flicker_steps));
    const auto all_rows = [](std::size_t) { return RowRange(); };
    impl_->walk(at, all_rows, [&](std::size_t k, const std::shared_ptr<const PhotoCurrent>& now) {
      PhotoCurrent lit = *now;
      if (!flicker.is_steady())
        for (float& value : lit.e_per_s) value *= static_cast<float>(flicker.at(at[k]));
      if (const std::vector<Event> events = camera.see(at[k], lit); !events.empty()) take(events);
      if (progress) progress(at[k] / end_s, "events");
    });
  });
}

void shoot(const ImagePlan& plan, const Sensor& sensor, const ClipOptions& options,
           const std::function<void(int, const RawImage&)>& take, const Context& context) {
  const Clip clip(plan, sensor, options, context);
  for (int frame = 0; frame < options.frames; ++frame) take(frame, clip.frame(frame, context));
}

}  // namespace petzval
