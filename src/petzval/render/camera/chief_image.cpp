// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/base/error.h>
#include <petzval/render/camera/chief_image.h>

#include <cmath>

namespace petzval::render {

namespace {

constexpr int heights = 48;
/// Of the first, as a share of the reach: it stands for the axis, where a chief ray crosses it nowhere.
constexpr double first_height = 1e-3;
constexpr int most_steps = 30;
constexpr double angle_tolerance = 1e-11;

}  // namespace

ChiefImage::ChiefImage(const Lens& lens, double wavelength_nm, Tracer::Clip clip, double reach_mm) {
  Lens distant = lens;
  distant.object_distance_mm.reset();
  FieldTracer tracer(distant, wavelength_nm, clip);
  std::vector<double> angle{0}, crossing{0}, height{0};
  for (int i = 0; i <= heights; ++i) {
    const double wanted = reach_mm * (i == 0 ? first_height : static_cast<double>(i) / heights);
    const std::optional<double> field = tracer.object_field_at_image_height(wanted);
    const std::optional<ChiefRay> chief = field ? tracer.chief_ray(*field) : std::nullopt;
    if (!chief) break;
    const std::optional<Ray> ray = Pencil::from_object(distant, *field).ray(0, chief->v);
    if (!ray) break;
    const double m = ray->direction[1], n = ray->direction[2];
    const double theta = std::atan2(std::abs(m), n);
    if (!(theta > angle.back())) break;
    angle.push_back(theta);
    crossing.push_back(ray->point_mm[2] - ray->point_mm[1] * n / m);
    // A line that comes down from a positive y has a negative m.
    height.push_back(m < 0 ? chief->image_height_mm : -chief->image_height_mm);
  }
  if (angle.size() < 3)
    throw InputError(fmt::format("{}: no chief rays reach the film, which diffraction needs", lens.name));
  pupil_z_mm_ = crossing[0] = crossing[1];
  crossing_ = MonotoneCubic(angle, std::move(crossing), MonotoneCubic::Start::even);
  height_ = MonotoneCubic(std::move(angle), std::move(height), MonotoneCubic::Start::odd);
}

std::optional<double> ChiefImage::angle_of(double radius_mm, double z_mm) const {
  double angle = std::atan2(radius_mm, pupil_z_mm_ - z_mm);
  for (int i = 0; i < most_steps; ++i) {
    const double next = std::atan2(radius_mm, crossing_(angle) - z_mm);
    const bool done = std::abs(next - angle) < angle_tolerance;
    angle = next;
    if (done) break;
  }
  if (!(pupil_z_mm_ > z_mm) || angle > height_.back()) return {};
  return angle;
}

std::optional<double> ChiefImage::angle_of_direction(double across, double along) const {
  const double angle = std::atan2(across, along);
  return angle > height_.back() ? std::nullopt : std::optional(angle);
}

double ChiefImage::last_height_mm() const {
  return std::abs(height_(height_.back()));
}

double ChiefImage::angle_at(double height_mm) const {
  const double sign = height_(height_.back()) < 0 ? -1 : 1;
  return height_.inverse(sign * std::min(height_mm, last_height_mm()));
}

double ChiefImage::radius_mm(double angle, double z_mm) const {
  return std::tan(angle) * (crossing_(angle) - z_mm);
}

}  // namespace petzval::render
