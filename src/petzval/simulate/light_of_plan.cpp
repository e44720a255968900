// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/simulate/clip_light.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

/// How far the picture moves between two aims, at most [pixels].
double moved_px(const SceneAim& a, const SceneAim& b, const ImagePlan& plan) {
  const FirstOrder& lens = plan.table.first_order;
  const double turn = radians(std::hypot(b.pan_deg - a.pan_deg, b.pitch_deg - a.pitch_deg));
  // Of a plane that is drawn by central projection, towards the corners more than in the middle.
  const double corner = plan.frame.half_diagonal_mm() / std::abs(lens.efl_mm);
  const double way_mm = mm_per_m * std::hypot(b.right_m - a.right_m, b.up_m - a.up_m);
  return (turn * std::abs(lens.efl_mm) * (1 + corner * corner) + way_mm * std::abs(lens.magnification)) /
         (plan.frame.pitch_um * mm_per_um);
}

class LightOfPlan : public ClipLight {
 public:
  LightOfPlan(ImagePlan plan, const ClipOptions& options)
      : plan_(std::move(plan)),
        motion_(options.motion),
        step_px_(options.step_px),
        series_(series_of(plan_)) {}

  int rows() const override { return plan_.frame.rows; }

  SpectralImage first(const Context& context) const override {
    const AimedLight first{{{first_aim()}}};
    ImagingReport report;
    SpectralImage light = std::move(form(std::span(&first, 1), &report).front());
    for (const std::string& line : report.notes) send_note(context, line);
    light.provenance = fmt::format("{} through {}", plan_.scene.name, plan_.table.lens_name);
    return light;
  }

  /// From one instant to the next the picture moves by no more than a step.
  std::vector<double> instants(double from_s, double to_s, double) const override {
    std::vector<double> corners{from_s};
    for (const MotionPath::Key& key : motion_.keys())
      if (key.t_s > from_s && key.t_s < to_s) corners.push_back(key.t_s);
    corners.push_back(to_s);
    std::vector<double> at{from_s};
    constexpr double rounding = 1e-9;
    constexpr double most_steps = 1 << 24;  // would take days
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
      const double a = corners[i], b = corners[i + 1];
      const double steps =
          std::max(1.0, std::ceil(moved_px(motion_.at(a), motion_.at(b), plan_) / step_px_ - rounding));
      if (!(double(at.size()) + steps <= most_steps))
        throw InputError(fmt::format(
            "the picture moves by {:g} pixels in {:g} s, which takes {:g} steps; a slower motion or "
            "larger steps would be right",
            steps * step_px_, b - a, steps));
      for (double k = 1; k <= steps; ++k) at.push_back(k == steps ? b : a + (b - a) * k / steps);
    }
    return at;
  }

  void walk(const std::vector<double>& instants, const RowsOf& rows_of, const See& see) const override {
    constexpr double most_bytes = 5e8;
    constexpr std::size_t most = 64;
    const double bytes =
        double(plan_.frame.columns) * double(plan_.frame.rows) * plan_.scene.bands() * sizeof(float);
    const auto at_once = static_cast<std::size_t>(std::clamp(most_bytes / bytes, 1.0, double(most)));
    SceneAim current_aim = first_aim();
    for (std::size_t from = 0; from < instants.size();) {
      // Instants of one aim share one light.
      std::vector<AimedLight> lights;
      std::size_t to = from;
      for (; to < instants.size(); ++to) {
        const SceneAim aim = motion_.at(instants[to]);
        const SceneAim& last = lights.empty() ? current_aim : lights.back().shares.front().aim;
        const RowRange rows = rows_of(to);
        if (last != aim) {
          if (lights.size() == at_once) break;
          lights.push_back({{{aim}}, rows});
        } else if (!lights.empty()) {
          RowRange& wanted = lights.back().rows;
          wanted = {std::min(wanted.first, rows.first), std::max(wanted.end, rows.end)};
        }
      }
      const std::vector<SpectralImage> images = lights.empty() ? std::vector<SpectralImage>() : form(lights);
      std::size_t next = 0;
      for (; from < to; ++from) {
        const SceneAim aim = motion_.at(instants[from]);
        const bool moved = current_aim != aim;
        see(from, moved ? &images[next++] : nullptr);
        current_aim = aim;
      }
    }
  }

  /// Light is added up before it is blurred.
  std::optional<SpectralImage> sum(std::span<const InstantShare> shares) const override {
    AimedLight light{{}, {}};
    for (const InstantShare& each : shares) {
      const SceneAim aim = motion_.at(each.t_s);
      if (light.shares.empty() || light.shares.back().aim != aim) light.shares.push_back({aim, 0});
      light.shares.back().weight += each.share;
    }
    if (light.shares.size() < 2) return {};
    return std::move(form(std::span(&light, 1)).front());
  }

 private:
  static std::unique_ptr<ImageSeries> series_of(const ImagePlan& plan) {
    if (plan.depth) return nullptr;
    return std::make_unique<ImageSeries>(plan.scene, plan.table, plan.frame, plan.options.imaging);
  }
  SceneAim first_aim() const { return motion_.at(0); }
  std::vector<SpectralImage> form(std::span<const AimedLight> lights, ImagingReport* report = nullptr) const {
    if (plan_.depth) {  // which is at rest
      ImageReport whole;
      SpectralImage light = image(plan_, {}, &whole);
      if (report) *report = std::move(whole.imaging);
      std::vector<SpectralImage> lights_of_all;
      lights_of_all.push_back(std::move(light));
      return lights_of_all;
    }
    return series_->form(lights, report);
  }

  ImagePlan plan_;
  MotionPath motion_;
  double step_px_;
  std::unique_ptr<ImageSeries> series_;  ///< of the plan's scene; none of one with depth
};

}  // namespace

std::unique_ptr<ClipLight> light_of_plan(ImagePlan plan, const ClipOptions& options) {
  return std::make_unique<LightOfPlan>(std::move(plan), options);
}

}  // namespace petzval
