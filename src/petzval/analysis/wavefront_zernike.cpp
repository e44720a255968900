// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/round_stop.h>
#include <petzval/analysis/stop_aim.h>
#include <petzval/analysis/wavefront.h>
#include <petzval/analysis/wavefront_zernike.h>

#include <limits>

namespace petzval {

namespace {

/// Enough for any 37 terms and the aberrations that they do not hold.
constexpr PupilSampling sampling{24, 128};

/// The whole of a pupil: rays that stand for their mirror images, on both sides.
struct StopSamples {
  std::vector<double> x, y, waves, area;

  StopSamples(const FieldTracer& tracer, const ChiefRay& chief, const std::vector<PupilRay>& rays) {
    const std::vector<double> opd = opd_waves(tracer, chief, rays);
    const double radius = tracer.tracer().stop_radius_mm();
    for (std::size_t i = 0; i < rays.size(); ++i)
      for (const double side : {1.0, -1.0}) {
        if (rays[i].stop_area_mm2 == 0 || (side < 0 && !rays[i].mirrored)) continue;
        x.push_back(side * rays[i].stop_x_mm / radius);
        y.push_back(rays[i].stop_y_mm / radius);
        waves.push_back(opd[i]);
        area.push_back((rays[i].mirrored ? 0.5 : 1.0) * rays[i].stop_area_mm2);
      }
  }
};

}  // namespace

std::vector<WavefrontZernikeRow> zernike_table(const Lens& lens, const FieldTableRequest& request,
                                               ZernikeOrder order, int terms) {
  require_round_stop(lens, "Zernike terms belong to round ones");
  zernike_term(order, terms);  // refuses before the work
  return field_rows<WavefrontZernikeRow>(
      lens, request,
      [&](const FieldTracer& tracer, const ChiefRay& chief) -> std::optional<WavefrontZernikeRow> {
        const std::vector<PupilRay> rays = pupil_rays(tracer, chief, sampling);
        if (rays.empty()) return {};
        const StopSamples samples(tracer, chief, rays);
        ZernikeFit fit = fit_zernike(order, terms, samples.x, samples.y, samples.waves, samples.area);
        WavefrontZernikeRow row;
        row.real_image_height_mm = chief.image_height_mm;
        row.coefficients = std::move(fit.coefficients);
        row.rms_residual_waves = fit.rms_residual;
        return row;
      });
}

std::vector<WavefrontMap> wavefront_maps(const Lens& lens, const FieldTableRequest& request, int size) {
  require_round_stop(lens, "wavefronts are mapped over round ones");
  if (size < 3 || size > 1025)
    throw InputError(fmt::format("a wavefront map of {0} x {0} samples; 3 to 1025 would be right", size));
  return field_rows<WavefrontMap>(
      lens, request, [&](const FieldTracer& tracer, const ChiefRay& chief) -> std::optional<WavefrontMap> {
        std::optional<StopAim> aim = StopAim::of(tracer, chief);
        if (!aim) return {};
        WavefrontMap map;
        map.size = size;
        map.waves.assign(static_cast<std::size_t>(size) * static_cast<std::size_t>(size),
                         std::numeric_limits<double>::quiet_NaN());
        const auto at = [&](int i) { return 2.0 * i / (size - 1) - 1; };
        // Of a centred lens only the half x ≤ 0 is traced, the other is its mirror image.
        const bool halves = tracer.tracer().is_centred();
        const int columns = halves ? (size - 1) / 2 + 1 : size;
        for (int i = 0; i < size; ++i)
          for (int k = 0; k < columns; ++k) {
            // The rim lets the corners go.
            if (at(i) * at(i) + at(k) * at(k) > 1 + 1e-12) continue;
            const std::optional<PupilRay> ray = aim->ray(at(k), at(i));
            if (!ray) continue;
            const double waves = opd_waves(tracer, chief, {*ray}).front();
            for (const int column : {k, halves ? size - 1 - k : k})
              map.waves[static_cast<std::size_t>(i) * static_cast<std::size_t>(size) +
                        static_cast<std::size_t>(column)] = waves;
          }
        return map;
      });
}

}  // namespace petzval
