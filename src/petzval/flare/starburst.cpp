// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/flare/polygon_transform.h>
#include <petzval/flare/starburst.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace petzval {

namespace {

/// Sums for a linear fit of (α, β) to (1, x, y).
struct LinearFit {
  double count = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  std::array<double, 2> sum{}, by_x{}, by_y{};

  void add(double px, double py, const std::array<double, 2>& value) {
    count += 1, x += px, y += py, xx += px * px, xy += px * py, yy += py * py;
    for (std::size_t i = 0; i < 2; ++i)
      sum[i] += value[i], by_x[i] += px * value[i], by_y[i] += py * value[i];
  }
  /// Slopes of component i; zero where the places lie on a line.
  std::array<double, 2> slopes(std::size_t i) const {
    const double sxx = xx - x * x / count, sxy = xy - x * y / count, syy = yy - y * y / count;
    const double sx = by_x[i] - x * sum[i] / count, sy = by_y[i] - y * sum[i] / count;
    const double determinant = sxx * syy - sxy * sxy;
    if (!(determinant > 1e-12 * sxx * syy)) return {0, 0};
    return {(sx * syy - sy * sxy) / determinant, (sy * sxx - sx * sxy) / determinant};
  }
};

using Places = std::vector<std::array<double, 3>>;

/// Of the light that ends there, in the axes of the sensor.
std::array<double, 2> cosines_at_sensor(const Tracer& tracer, const Places& places) {
  const auto& last = places[places.size() - 1];
  const auto& before = places[places.size() - 2];
  const double dx = last[0] - before[0], dy = last[1] - before[1], dz = last[2] - before[2];
  const double length = std::sqrt(dx * dx + dy * dy + dz * dz);
  if (!tracer.sensor_posed()) return {dx / length, dy / length};
  const Frame::Vector own = tracer.sensor_frame().from_lens({dx / length, dy / length, dz / length});
  return {own[0], own[1]};
}

/// In the stop's own axes.
std::array<double, 3> place_at_stop(const Tracer& tracer, const Places& places) {
  const std::size_t stop = tracer.stop_index();
  const Tracer::PreparedSurface& surface = tracer.surfaces()[stop];
  return surface.posed ? surface.frame.point_from_lens(places[stop], surface.vertex_z_mm) : places[stop];
}

}  // namespace

double StarPupil::area() const {
  return corners.empty() ? pi * radius * radius : polygon_area(corners);
}

std::optional<StarPupil> star_pupil(const GhostTracer& tracer, const BrightSource& source,
                                    const SensorGeometry& frame) {
  const SourceBeam beam(source);
  const std::optional<PupilBox> box = find_pupil_box(tracer, GhostPair::straight(), beam, frame);
  if (!box) return {};
  LinearFit fit;
  StarPupil pupil;
  constexpr int side = 24;
  const double cell_mm2 = (box->right - box->left) * (box->high - box->low) / (side * side);
  std::vector<std::array<double, 3>> places;
  std::vector<std::array<double, 2>> ends;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const double x = box->left + (box->right - box->left) * (i + 0.5) / side,
                   y = box->low + (box->high - box->low) * (j + 0.5) / side;
      places.clear();
      const GhostLanding end = tracer.follow(beam.ray(x, y), GhostPair::straight(), &places);
      if (!end.arrives || end.clearance > 0) continue;
      const std::array<double, 2> cosines = cosines_at_sensor(tracer.tracer(), places);
      const auto stop = place_at_stop(tracer.tracer(), places);
      fit.add(stop[0], stop[1], cosines);
      pupil.x_mm += end.x_mm, pupil.y_mm += end.y_mm;
      ends.push_back({end.x_mm, end.y_mm});
      pupil.flux_mm2 += end.share * beam.weight(x, y) * cell_mm2;
    }
  if (fit.count < 6) return {};
  pupil.x_mm /= fit.count, pupil.y_mm /= fit.count;
  const std::array<double, 2> a = fit.slopes(0), b = fit.slopes(1);
  const double turn = a[0] * b[1] - a[1] * b[0];
  if (turn == 0) return {};
  const double stop_mm = tracer.tracer().stop_radius_mm();
  const StopBlades& blades = tracer.tracer().stop_blades();
  for (int k = 0; k < blades.count; ++k) {
    // The first corner at the top, anticlockwise as seen from the film (docs/CONVENTIONS.md).
    const double angle = 2 * pi * k / blades.count + radians(blades.rotation_deg);
    const double x = -stop_mm * std::sin(angle), y = stop_mm * std::cos(angle);
    pupil.corners.push_back({a[0] * x + a[1] * y, b[0] * x + b[1] * y});
  }
  if (polygon_area(pupil.corners) < 0) std::ranges::reverse(pupil.corners);
  pupil.radius = stop_mm * std::sqrt(std::abs(turn) * blades.area_share());
  const double pixel_mm = frame.pitch_um * mm_per_um;
  if (source.radius_rad > 0) {
    const auto end = [&](std::array<double, 2> across) {
      return tracer.follow(SourceBeam(source, across).ray(box->middle_x, box->middle_y),
                           GhostPair::straight());
    };
    const GhostLanding middle = end({0, 0}), rim = end({1, 0});
    if (middle.arrives && rim.arrives)
      pupil.source_mm = std::hypot(rim.x_mm - middle.x_mm, rim.y_mm - middle.y_mm);
  }
  for (const auto& [x, y] : ends)
    pupil.core_mm = std::max(pupil.core_mm, std::hypot(x - pupil.x_mm, y - pupil.y_mm));
  pupil.core_mm += pupil.source_mm + 2.5 * pixel_mm;  // nearer, pixels are too coarse for the star
  return pupil;
}

double star_irradiance(const StarPupil& pupil, double wavelength_nm, double x_mm, double y_mm,
                       double blur_mm) {
  const double square = x_mm * x_mm + y_mm * y_mm, lambda_mm = wavelength_nm * mm_per_nm;
  if (pupil.corners.empty()) {
    // 4 J₁²(v)/v² with J₁² = 1/(πv) on average, v = 2π r NA/λ.
    const double v = 2 * pi / lambda_mm * std::sqrt(square) * pupil.radius;
    return pupil.area() / (lambda_mm * lambda_mm) * 4 / (pi * v * v * v);
  }
  double sum = 0;
  for (std::size_t i = 0; i < pupil.corners.size(); ++i) {
    const auto& [x0, y0] = pupil.corners[i];
    const auto& [x1, y1] = pupil.corners[(i + 1) % pupil.corners.size()];
    const double ex = x1 - x0, ey = y1 - y0, length_sq = ex * ex + ey * ey;
    // Distances across and along the edge, times its length.
    const double across = x_mm * ey - y_mm * ex, along = x_mm * ex + y_mm * ey;
    const double per = 2 * pi / lambda_mm;  // 2u = k t L
    const double spread = blur_mm * std::sqrt(length_sq);
    const double mean =
        (std::atan(per * (along + spread)) - std::atan(per * (along - spread))) / (per * spread);
    sum += across * across * mean;
  }
  return sum / (4 * pi * pi * pupil.area() * square * square);
}

double star_share_beyond(const StarPupil& pupil, double wavelength_nm, double from_mm, double blur_mm) {
  // Over r = from/ρ, ρ from 1 to 0: the light per ρ is even where spikes are narrow, and falls off beyond.
  constexpr int radii = 64;
  const int turns = pupil.corners.empty() ? 1 : 1440;  // a circle's star is round
  double share = 0;
  for (int i = 0; i < radii; ++i) {
    const double rho = (i + 0.5) / radii, r = from_mm / rho;
    double ring = 0;
    for (int k = 0; k < turns; ++k) {
      const double angle = 2 * pi * (k + 0.5) / turns;
      // As blurred as the ring's samples are apart, so that none slips between them.
      const double blur = std::max(blur_mm, r * pi / turns);
      ring += star_irradiance(pupil, wavelength_nm, r * std::cos(angle), r * std::sin(angle), blur);
    }
    share += ring / turns * 2 * pi * r * r / rho / radii;
  }
  return share;
}

SpectralImage starburst_light(const Lens& lens, const SensorGeometry& frame,
                              const std::vector<double>& wavelengths_nm,
                              std::span<const BrightSource> sources, const GhostLightOptions& options,
                              double core_mm) {
  SpectralImage light(frame.columns, frame.rows, wavelengths_nm, frame.pitch_um);
  const double pixel_mm = frame.pitch_um * mm_per_um;
  struct Star {
    std::optional<StarPupil> pupil;
    double from_mm = 0, blur_mm = 0;
    double share = 0;  ///< of its light, farther out
  };
  std::vector<std::unique_ptr<GhostTracer>> tracers;
  for (const double nm : wavelengths_nm)
    tracers.push_back(std::make_unique<GhostTracer>(lens, nm, losses_of_picture(lens, nm, options.losses), 0,
                                                    options.clip));
  const std::size_t bands = wavelengths_nm.size();
  std::vector<Star> stars(bands * sources.size());  // [source][band]
  parallel_tasks(stars.size(), [&](std::size_t i) {
    Star& star = stars[i];
    star.pupil = star_pupil(*tracers[i % bands], sources[i / bands], frame);
    if (!star.pupil) return;
    star.from_mm = std::max(star.pupil->core_mm, core_mm);
    star.blur_mm = star.pupil->source_mm + pixel_mm / 2;
    star.share = star_share_beyond(*star.pupil, wavelengths_nm[i % bands], star.from_mm, star.blur_mm);
  });
  for (std::size_t i = 0; i < stars.size(); ++i) {
    const Star& star = stars[i];
    if (!star.pupil) continue;
    const std::size_t band = i % bands;
    const double all = sources[i / bands].irradiance[band] * star.pupil->flux_mm2;
    const std::span<float> pixels = light.band(static_cast<int>(band));
    parallel_for(static_cast<std::size_t>(frame.rows), [&](std::size_t row) {
      const double y_mm = frame.y_mm(static_cast<double>(row) + 0.5) - star.pupil->y_mm;
      float* const out = pixels.data() + row * static_cast<std::size_t>(frame.columns);
      for (int column = 0; column < frame.columns; ++column) {
        const double x_mm = frame.x_mm(column + 0.5) - star.pupil->x_mm;
        if (x_mm * x_mm + y_mm * y_mm < star.from_mm * star.from_mm) continue;
        out[column] += static_cast<float>(
            all * star_irradiance(*star.pupil, wavelengths_nm[band], x_mm, y_mm, star.blur_mm));
      }
    });
  }
  // What the stars have is taken from their cores.
  std::vector<BrightSource> cores(sources.begin(), sources.end());
  for (std::size_t i = 0; i < stars.size(); ++i) cores[i / bands].irradiance[i % bands] *= stars[i].share;
  const SpectralImage taken = straight_light(lens, frame, wavelengths_nm, cores, options);
  for (std::size_t band = 0; band < bands; ++band) {
    const std::span<float> pixels = light.band(static_cast<int>(band));
    const std::span<const float> less = taken.band(static_cast<int>(band));
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] -= less[i];
  }
  return light;
}

}  // namespace petzval
