// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/exit_pupil.h>
#include <petzval/analysis/wavefront.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {

namespace {

/// Rays of samples() stand at every so-many-th azimuth of the outline.
constexpr std::size_t azimuth_stride = 4;
/// Distance to neighbouring rays per pupil radius, for the Jacobian.
constexpr double nudge_per_radius = 1e-4;
/// The aim is good when the direction is met to this share of the pupil: what is left is put right by the
/// slope of the phase, and errs by the square.
constexpr double aim_tolerance = 1e-6;
constexpr int aim_steps = 12;

}  // namespace

OutlineEdges::OutlineEdges(const std::vector<double>& at) {
  const auto [low, high] = std::minmax_element(at.begin(), at.end());
  low_ = *low;
  const std::size_t bands = at.size();
  per_band_ = (*high - *low) / static_cast<double>(bands);
  if (!(per_band_ > 0)) return;
  std::vector<std::vector<std::size_t>> of(bands);
  const auto band = [&](double value) {
    return std::min(static_cast<std::size_t>((value - low_) / per_band_), bands - 1);
  };
  for (std::size_t i = 1; i < at.size(); ++i)
    for (std::size_t b = band(std::min(at[i - 1], at[i])); b <= band(std::max(at[i - 1], at[i])); ++b)
      of[b].push_back(i);
  first_ = {0};
  for (const std::vector<std::size_t>& edges : of) {
    edges_.insert(edges_.end(), edges.begin(), edges.end());
    first_.push_back(edges_.size());
  }
}

std::span<const std::size_t> OutlineEdges::near(double value) const {
  const double band = (value - low_) / per_band_;
  if (first_.empty() || !(band >= 0)) return {};
  const std::size_t at = std::min(static_cast<std::size_t>(std::min(band, 1e9)), first_.size() - 2);
  return std::span(edges_).subspan(first_[at], first_[at + 1] - first_[at]);
}

ExitPupil::ExitPupil(const FieldTracer& tracer, const ChiefRay& chief, const PupilDetail& detail)
    : tracer_(&tracer),
      chief_(chief),
      detail_(detail),
      pencil_(Pencil::from_object(tracer.lens(), chief.object_field)),
      sphere_radius_mm_(reference_sphere_radius_mm(tracer, chief)),
      pupil_position_mm_(first_order(tracer.lens()).exit_pupil.position_mm) {}

ExitPupil::Probe ExitPupil::at_sensor(const Ray& traced) const {
  Probe probe{traced.direction[0], traced.direction[1], 0, traced.point_mm[0] - chief_.image_x_mm,
              traced.point_mm[1] - chief_.image_height_mm};
  const double lambda_mm = tracer_->tracer().wavelength_nm() * mm_per_nm;
  const double to_foot_mm = -probe.x_mm * probe.alpha - probe.y_mm * probe.beta;
  probe.phase_waves =
      (traced.opl_mm - chief_.at_image.opl_mm + tracer_->tracer().image_index() * to_foot_mm) / lambda_mm;
  return probe;
}

std::optional<ExitPupil::Probe> ExitPupil::probe(double u, double v) const {
  const std::optional<Ray> launched = pencil_.ray(u, v);
  if (!launched) return {};
  const Ray ray = tracer_->tracer().trace(*launched, Tracer::Clip::none);
  if (ray.status != RayStatus::ok) return {};
  return at_sensor(ray);
}

std::vector<std::optional<ExitPupil::Probe>> ExitPupil::probe(
    const std::vector<std::array<double, 2>>& places) const {
  RayBatch rays;
  std::vector<std::size_t> launched;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::optional<Ray> ray = pencil_.ray(places[i][0], places[i][1]);
    if (!ray) continue;
    const auto& [x, y, z] = ray->point_mm;
    const auto& [l, m, n] = ray->direction;
    rays.push_back(x, y, z, l, m, n, ray->opl_mm);
    launched.push_back(i);
  }
  tracer_->tracer().trace(rays, Tracer::Clip::none);
  std::vector<std::optional<Probe>> probes(places.size());
  for (std::size_t i = 0; i < launched.size(); ++i)
    if (rays.status[i] == RayStatus::ok)
      probes[launched[i]] = at_sensor(
          {{rays.x_mm[i], rays.y_mm[i], rays.z_mm[i]}, {rays.l[i], rays.m[i], rays.n[i]}, rays.opl_mm[i]});
  return probes;
}

std::optional<ExitPupil> ExitPupil::of(const FieldTracer& tracer, const ChiefRay& chief,
                                       const PupilDetail& detail) {
  const std::optional<PupilBoundary> pupil = tracer.round_object_pupil(chief, detail.outline_azimuths);
  if (!pupil) return {};
  ExitPupil exit(tracer, chief, detail);
  if (!exit.find_outline(*pupil)) return {};
  if (tracer.tracer().stop_blades().count > 0) {
    const std::optional<PupilBoundary> bladed = tracer.object_pupil(chief, detail.outline_azimuths);
    if (!bladed) return {};
    exit.take_whole_outline(*bladed);
  }
  // Every fourth azimuth from the second on: mirror symmetric like the whole.
  exit.boundary_ = *pupil;
  exit.boundary_.radius.clear();
  for (std::size_t i = 0; i < pupil->radius.size() / azimuth_stride; ++i)
    exit.boundary_.radius.push_back(
        0.5 * (pupil->radius[azimuth_stride * i + 1] + pupil->radius[azimuth_stride * i + 2]));
  exit.boundary_.turns.clear(), exit.boundary_.turn_weights.clear();
  if (pupil->mirrored()) return exit;
  const std::size_t own = exit.boundary_.radius.size();
  for (std::size_t i = 0; i < own; ++i)
    exit.boundary_.turns.push_back(2 * pi * (static_cast<double>(i) + 0.5) / static_cast<double>(own));
  exit.boundary_.turn_weights.assign(own, 2 * pi / static_cast<double>(own));
  if (exit.whole_outline_.empty()) exit.take_whole_outline(*pupil);
  return exit;
}

std::vector<ExitPupil::Sample> ExitPupil::samples(const PupilModel& model,
                                                  const std::vector<double>& sensor_shifts_mm) const {
  const std::array<double, 3> chief = chief_.at_image.direction;
  const double index = tracer_->tracer().image_index();
  const double lambda_mm = tracer_->tracer().wavelength_nm() * mm_per_nm;
  const double chief_slope = chief[1] / chief[2], chief_slope_x = mirrored() ? 0 : chief[0] / chief[2];
  const auto on_sensor = [&](const Probe& at, double shift_mm) {
    const double gamma = std::sqrt(1 - at.alpha * at.alpha - at.beta * at.beta);
    OnSensor sensor{at.phase_waves, at.x_mm + shift_mm * (at.alpha / gamma - chief_slope_x),
                    at.y_mm + shift_mm * (at.beta / gamma - chief_slope)};
    double more_mm = shift_mm * (at.alpha * chief_slope_x + at.beta * chief_slope + gamma - 1 / chief[2]);
    if (model.phase == PupilModel::Phase::reference_sphere) {
      const double height_mm = chief_.image_height_mm + shift_mm * chief_slope,
                   aside_mm = chief_.image_x_mm + shift_mm * chief_slope_x,
                   pupil_mm = pupil_position_mm_ - shift_mm;
      const double radius_mm =
          std::copysign(std::hypot(pupil_mm, std::hypot(height_mm, aside_mm)), -pupil_mm);
      more_mm -= sphere_behind_foot_mm(sensor.x_mm, sensor.y_mm, at.alpha, at.beta, radius_mm);
    }
    sensor.phase_waves += index * more_mm / lambda_mm;
    return sensor;
  };
  std::vector<std::array<double, 2>> places;
  for (const PupilNode& node : pupil_nodes(boundary_, detail_.sample_radii))
    places.push_back({node.u, node.v});
  for (std::size_t i = 0; i < boundary_.own(); ++i) places.push_back(boundary_.rim(i));
  const std::vector<std::optional<Probe>> probes = probe(places);
  std::vector<std::optional<Probe>> right, above;
  const bool as_bright = model.amplitude == PupilModel::Amplitude::light;
  if (as_bright) {
    std::vector<std::array<double, 2>> beside = places;
    for (auto& [u, v] : beside) u += nudge_;
    right = probe(beside);
    for (auto& [u, v] : places) v += nudge_;
    above = probe(places);
  }
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const std::optional<Probe>& at = probes[i];
    if (!at || (as_bright && (!right[i] || !above[i]))) continue;
    Sample sample{mirrored() ? std::abs(at->alpha) : at->alpha, at->beta, 1};
    if (as_bright) {
      const double jacobian = ((right[i]->alpha - at->alpha) * (above[i]->beta - at->beta) -
                               (above[i]->alpha - at->alpha) * (right[i]->beta - at->beta)) /
                              (nudge_ * nudge_);
      sample.amplitude = 1 / std::sqrt(std::abs(jacobian));
    }
    for (const double shift_mm : sensor_shifts_mm) sample.sensors.push_back(on_sensor(*at, shift_mm));
    samples.push_back(std::move(sample));
  }
  return samples;
}

bool ExitPupil::find_outline(const PupilBoundary& pupil) {
  nudge_ = nudge_per_radius * *std::max_element(pupil.radius.begin(), pupil.radius.end());
  double low_v = pupil.centre_v, high_v = pupil.centre_v;
  std::vector<std::array<double, 2>> places;
  for (std::size_t i = 0; i < pupil.own(); ++i) places.push_back(pupil.rim(i));
  const std::vector<std::optional<Probe>> rims = probe(places);
  for (std::size_t i = 0; i < rims.size(); ++i) {
    const std::optional<Probe>& rim = rims[i];
    if (!rim) continue;
    const double v = places[i][1];
    outline_alpha_.push_back(std::abs(rim->alpha));
    outline_beta_.push_back(rim->beta);
    transverse_mm_ = std::max(transverse_mm_, std::hypot(rim->x_mm, rim->y_mm));
    low_v = std::min(low_v, v);
    high_v = std::max(high_v, v);
  }
  if (outline_beta_.size() < 8) return false;
  outline_alpha_.insert(outline_alpha_.begin(), 0);
  outline_beta_.insert(outline_beta_.begin(), outline_beta_.front());
  outline_alpha_.push_back(0);
  outline_beta_.push_back(outline_beta_.back());
  across_alpha_ = OutlineEdges(outline_alpha_);
  across_beta_ = OutlineEdges(outline_beta_);
  alpha_max_ = *std::max_element(outline_alpha_.begin(), outline_alpha_.end());
  const auto [low, high] = std::minmax_element(outline_beta_.begin(), outline_beta_.end());
  beta_range_ = {*low, *high};
  middle_beta_ = 0.5 * (*low + *high);
  middle_u_ = pupil.centre_u;
  middle_v_ = 0.5 * (low_v + high_v);
  // β may fall as v rises, and α as u: the signs of the map at the middle.
  const std::optional<Probe> middle = probe(middle_u_, middle_v_),
                             right = probe(middle_u_ + nudge_, middle_v_),
                             above = probe(middle_u_, middle_v_ + nudge_);
  if (!middle || !right || !above) return false;
  u_per_alpha_ = nudge_ / (right->alpha - middle->alpha);
  v_per_beta_ = nudge_ / (above->beta - middle->beta);
  middle_alpha_ = pupil.mirrored() ? 0 : middle->alpha;
  middle_beta_ = middle->beta;
  return alpha_max_ > 0 && beta_range_.length() > 0 && std::isfinite(u_per_alpha_) &&
         std::isfinite(v_per_beta_);
}

void ExitPupil::take_whole_outline(const PupilBoundary& pupil) {
  std::vector<std::array<double, 2>> places;
  for (std::size_t i = 0; i < pupil.radius.size(); ++i) places.push_back(pupil.rim(i));
  for (const std::optional<Probe>& rim : probe(places))
    if (rim) whole_outline_.push_back({rim->alpha, rim->beta});
}

ExitPupil::Chord ExitPupil::along_beta(double alpha) const {
  Chord chord{beta_range_.high, beta_range_.low};
  for (const std::size_t i : across_alpha_.near(alpha)) {
    const double a = outline_alpha_[i - 1], b = outline_alpha_[i];
    if (a == b || (a <= alpha) == (b <= alpha)) continue;
    const double beta =
        outline_beta_[i - 1] + (alpha - a) / (b - a) * (outline_beta_[i] - outline_beta_[i - 1]);
    chord = {std::min(chord.low, beta), std::max(chord.high, beta)};
  }
  return chord.low <= chord.high ? chord : Chord{};
}

ExitPupil::Chord ExitPupil::along_alpha(double beta) const {
  double widest = 0;
  for (const std::size_t i : across_beta_.near(beta)) {
    const double a = outline_beta_[i - 1], b = outline_beta_[i];
    if (a == b || (a < beta) == (b < beta)) continue;
    widest = std::max(
        widest, outline_alpha_[i - 1] + (beta - a) / (b - a) * (outline_alpha_[i] - outline_alpha_[i - 1]));
  }
  return {-widest, widest};
}

std::complex<double> ExitPupil::wave(double alpha, double beta, const PupilModel& model) const {
  double u = middle_u_ + u_per_alpha_ * (alpha - middle_alpha_),
         v = middle_v_ + v_per_beta_ * (beta - middle_beta_);
  for (int step = 0; step < aim_steps; ++step) {
    const std::optional<Probe> at = probe(u, v), right = probe(u + nudge_, v), above = probe(u, v + nudge_);
    if (!at || !right || !above) return 0;
    const double alpha_u = (right->alpha - at->alpha) / nudge_, beta_u = (right->beta - at->beta) / nudge_;
    const double alpha_v = (above->alpha - at->alpha) / nudge_, beta_v = (above->beta - at->beta) / nudge_;
    const double jacobian = alpha_u * beta_v - alpha_v * beta_u;
    const double miss_alpha = alpha - at->alpha, miss_beta = beta - at->beta;
    if (std::hypot(miss_alpha, miss_beta) < aim_tolerance * widest()) {
      const double lambda_mm = tracer_->tracer().wavelength_nm() * mm_per_nm;
      // ∂φ/∂(α, β) is the transverse ray: −n'(x, y)/λ.
      double rest_mm = -(at->x_mm * miss_alpha + at->y_mm * miss_beta);
      if (model.phase == PupilModel::Phase::reference_sphere)
        rest_mm -= sphere_behind_foot_mm(at->x_mm, at->y_mm, at->alpha, at->beta, sphere_radius_mm_);
      const double phase = at->phase_waves + tracer_->tracer().image_index() * rest_mm / lambda_mm;
      const bool uniform = model.amplitude == PupilModel::Amplitude::uniform;
      return std::polar(uniform ? 1 : 1 / std::sqrt(std::abs(jacobian)), 2 * pi * phase);
    }
    u += (miss_alpha * beta_v - miss_beta * alpha_v) / jacobian;
    v += (miss_beta * alpha_u - miss_alpha * beta_u) / jacobian;
  }
  return 0;
}

}  // namespace petzval
