// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/round_stop.h>
#include <petzval/analysis/wavefront.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace petzval {

namespace {

/// Sums over the stop. Those of x are zero where rays stand for their mirror images.
struct StopMoments {
  double area = 0, w = 0, ww = 0, y = 0, yy = 0, wy = 0, x = 0, xx = 0, wx = 0, xy = 0;

  void add(double waves, const PupilRay& ray) {
    const double weight = ray.stop_area_mm2, height = ray.stop_y_mm;
    area += weight;
    w += weight * waves;
    ww += weight * waves * waves;
    y += weight * height;
    yy += weight * height * height;
    wy += weight * waves * height;
    if (ray.mirrored) return;
    x += weight * ray.stop_x_mm;
    xx += weight * ray.stop_x_mm * ray.stop_x_mm;
    wx += weight * waves * ray.stop_x_mm;
    xy += weight * ray.stop_x_mm * height;
  }
  double variance() const { return std::max(0.0, ww / area - w * w / (area * area)); }
  /// The part of the variance that the best tilt explains.
  double tilt_variance() const {
    const double covariance = wy / area - w * y / (area * area);
    const double spread = yy / area - y * y / (area * area);
    if (xx == 0) return spread > 0 ? covariance * covariance / spread : 0;
    const double covariance_x = wx / area - w * x / (area * area);
    const double spread_x = xx / area - x * x / (area * area), both = xy / area - x * y / (area * area);
    const double determinant = spread * spread_x - both * both;
    if (!(determinant > 0)) return 0;
    return (covariance * covariance * spread_x - 2 * covariance * covariance_x * both +
            covariance_x * covariance_x * spread) /
           determinant;
  }
};

}  // namespace

double reference_sphere_radius_mm(const FieldTracer& tracer, const ChiefRay& chief) {
  const double pupil_mm = first_order(tracer.lens()).exit_pupil.position_mm;
  return std::copysign(std::hypot(pupil_mm, std::hypot(chief.image_height_mm, chief.image_x_mm)), -pupil_mm);
}

double sphere_behind_foot_mm(double x_mm, double y_mm, double alpha, double beta, double radius_mm) {
  if (std::isinf(radius_mm)) return 0;
  // |D − t d| = R for the ray D − t d; with q = (D·d)² − D² no digits are lost for a distant pupil.
  const double along = x_mm * alpha + y_mm * beta;
  const double q = along * along - x_mm * x_mm - y_mm * y_mm;
  const double size = std::abs(radius_mm), past = q / (std::sqrt(size * size + q) + size);
  return radius_mm > 0 ? past : -past;
}

std::vector<double> opd_waves(const FieldTracer& tracer, const ChiefRay& chief,
                              const std::vector<PupilRay>& rays) {
  const double radius = reference_sphere_radius_mm(tracer, chief), index = tracer.tracer().image_index();
  const double lambda_mm = tracer.tracer().wavelength_nm() * mm_per_nm;
  std::vector<double> waves;
  for (const PupilRay& ray : rays) {
    const double back_mm = ray.x_mm * ray.alpha + ray.y_mm * ray.beta +
                           sphere_behind_foot_mm(ray.x_mm, ray.y_mm, ray.alpha, ray.beta, radius);
    waves.push_back((index * back_mm - ray.path_mm) / lambda_mm);
    if (!std::isfinite(waves.back()))
      throw InputError(
          fmt::format("{}: the exit pupil lies {:g} mm from the image and rays miss the reference "
                      "sphere there; a wavefront needs a pupil away from the image",
                      tracer.lens().name, std::abs(radius)));
  }
  return waves;
}

std::optional<WavefrontRow> wavefront(const FieldTracer& tracer, const ChiefRay& chief,
                                      const PupilSampling& sampling) {
  const std::vector<PupilRay> rays = pupil_rays(tracer, chief, sampling);
  if (rays.empty()) return {};
  const std::vector<double> waves = opd_waves(tracer, chief, rays);
  StopMoments moments;
  std::complex<double> amplitude = 0;
  double solid_angle = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    moments.add(waves[i], rays[i]);
    amplitude += std::polar(rays[i].exit_solid_angle_sr, 2 * pi * waves[i]);
    solid_angle += rays[i].exit_solid_angle_sr;
  }
  const auto [lowest, highest] = std::minmax_element(waves.begin(), waves.end());
  WavefrontRow row;
  row.real_image_height_mm = chief.image_height_mm;
  row.rms_waves = std::sqrt(moments.variance());
  row.rms_without_tilt_waves = std::sqrt(std::max(0.0, moments.variance() - moments.tilt_variance()));
  row.pv_waves = *highest - *lowest;
  row.strehl = std::norm(amplitude) / (solid_angle * solid_angle);
  row.reference_sphere_radius_mm = std::abs(reference_sphere_radius_mm(tracer, chief));
  return row;
}

std::vector<WavefrontRow> wavefront_table(const Lens& lens, const FieldTableRequest& request) {
  require_round_stop(lens, "wavefronts are measured over round ones");
  return field_rows<WavefrontRow>(lens, request, [](const FieldTracer& tracer, const ChiefRay& chief) {
    return wavefront(tracer, chief);
  });
}

}  // namespace petzval
