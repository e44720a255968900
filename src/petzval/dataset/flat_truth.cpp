// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/dataset/flat_truth.h>
#include <petzval/imaging/depth_layers.h>
#include <petzval/numeric/lattice_spline.h>
#include <petzval/optics/table_interpolation.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace petzval {

namespace {

constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();

struct Direction {
  double along_x, along_y;  ///< tangents, turned as FramePlaces has it
};

/// Calls place(row, column, x′, y′) for every pixel's centre.
template <typename Place>
void for_each_pixel(const SensorGeometry& frame, const Place& place) {
  const double pitch_mm = frame.pitch_um / 1000;
  parallel_for(static_cast<std::size_t>(frame.rows), [&](std::size_t index) {
    const auto row = static_cast<int>(index);
    for (int column = 0; column < frame.columns; ++column)
      place(row, column, -(column + 0.5 - frame.columns / 2.0) * pitch_mm,
            (row + 0.5 - frame.rows / 2.0) * pitch_mm);
  });
}

std::function<Direction(double, double)> directions_by_height(const LensDataTable& table, std::size_t band) {
  const RadialProfile profile = RadialProfiles(table).at_wavelength(table.wavelengths_nm[band]);
  return [&table, profile](double x, double y) {
    const double r = std::hypot(x, y);
    if (r > profile.max_height_mm()) return Direction{nowhere, nowhere};
    if (r == 0) return Direction{0, 0};
    const double tangent = table.field_tangent(profile.object_field(r));
    return Direction{tangent * x / r, tangent * y / r};
  };
}

std::function<Direction(double, double)> directions_over_frame(const LensDataTable& table, std::size_t band) {
  const FramePlaces& frame = *table.frame;
  std::vector<double> x, y;
  for (std::size_t place = 0; place < frame.count(); ++place) {
    const std::size_t at = table.index(place, band);
    const double field = std::hypot(frame.object_x[at], frame.object_y[at]);
    const double scale = field > 0 ? table.field_tangent(field) / field : 0;
    x.push_back(scale * frame.object_x[at]);
    y.push_back(scale * frame.object_y[at]);
  }
  const LatticeSpline along_x(frame.x_mm, frame.y_mm, std::move(x)),
      along_y(frame.x_mm, frame.y_mm, std::move(y));
  return [along_x, along_y](double at_x, double at_y) {
    return Direction{along_x(at_x, at_y), along_y(at_x, at_y)};
  };
}

}  // namespace

std::size_t reference_band(const LensDataTable& table) {
  const double wanted = table.first_order.wavelength_nm;
  std::size_t best = 0;
  for (std::size_t i = 1; i < table.wavelengths_nm.size(); ++i)
    if (std::abs(table.wavelengths_nm[i] - wanted) < std::abs(table.wavelengths_nm[best] - wanted)) best = i;
  return best;
}

std::vector<float> pixel_rays(const LensDataTable& table, const SensorGeometry& frame) {
  const std::size_t band = reference_band(table);
  const auto direction = table.frame ? directions_over_frame(table, band) : directions_by_height(table, band);
  std::vector<float> rays(2 * static_cast<std::size_t>(frame.columns) * static_cast<std::size_t>(frame.rows));
  for_each_pixel(frame, [&](int row, int column, double x, double y) {
    const Direction seen = direction(x, y);
    const std::size_t at = 2 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(frame.columns) +
                                static_cast<std::size_t>(column));
    rays[at] = static_cast<float>(-seen.along_x);
    rays[at + 1] = static_cast<float>(seen.along_y);
  });
  return rays;
}

namespace {

/// A place on the sensor from its middle [pixels], and the tangent and the direction of what it sees.
struct Sight {
  double column, row, tangent, right, down;
};

std::vector<Sight> sights(const std::vector<float>& rays, const SensorGeometry& frame) {
  std::vector<Sight> all;
  for (int row = 0; row < frame.rows; ++row)
    for (int column = 0; column < frame.columns; ++column) {
      const std::size_t at = 2 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(frame.columns) +
                                  static_cast<std::size_t>(column));
      const double right = static_cast<double>(rays[at]), down = static_cast<double>(rays[at + 1]);
      const double tangent = std::hypot(right, down);
      if (!std::isfinite(tangent)) continue;
      const double scale = tangent > 0 ? 1 / tangent : 0;
      all.push_back({column + 0.5 - frame.columns / 2.0, row + 0.5 - frame.rows / 2.0, tangent, right * scale,
                     down * scale});
    }
  return all;
}

/// Fits r = f(a + f k₁ a³ + …) and the principal point. \param terms  odd powers of the angle or tangent.
Intrinsics fit_model(const std::vector<Sight>& all, const SensorGeometry& frame, bool fisheye) {
  const int terms = fisheye ? 5 : 4;
  const auto powers = [&](double tangent) {
    Eigen::VectorXd each(terms);
    const double a = fisheye ? std::atan(tangent) : tangent;
    double power = a;
    for (int i = 0; i < terms; ++i, power *= a * a) each[i] = power;
    return each;
  };
  const int unknowns = terms + 2;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(unknowns, unknowns);
  Eigen::VectorXd right_side = Eigen::VectorXd::Zero(unknowns), line(unknowns);
  for (const Sight& sight : all) {
    const Eigen::VectorXd each = powers(sight.tangent);
    line << sight.right * each, 1, 0;
    normal += line * line.transpose(), right_side += line * sight.column;
    line << sight.down * each, 0, 1;
    normal += line * line.transpose(), right_side += line * sight.row;
  }
  const Eigen::VectorXd found = normal.completeOrthogonalDecomposition().solve(right_side);
  Intrinsics result;
  result.fisheye = fisheye;
  result.focal_px = found[0];
  result.centre_x = frame.columns / 2.0 - 0.5 + found[terms];
  result.centre_y = frame.rows / 2.0 - 0.5 + found[terms + 1];
  for (int i = 1; i < terms; ++i) result.radial.push_back(found[i] / found[0]);
  double squares = 0;
  for (const Sight& sight : all) {
    const double radius = powers(sight.tangent).dot(found.head(terms));
    const double off = std::hypot(sight.right * radius + found[terms] - sight.column,
                                  sight.down * radius + found[terms + 1] - sight.row);
    squares += off * off, result.worst_px = std::max(result.worst_px, off);
  }
  result.rms_px = std::sqrt(squares / static_cast<double>(all.size()));
  return result;
}

}  // namespace

std::optional<Intrinsics> fit_intrinsics(const std::vector<float>& rays, const SensorGeometry& frame) {
  const std::vector<Sight> all = sights(rays, frame);
  if (all.size() < 10) return {};
  const Intrinsics pinhole = fit_model(all, frame, false), fisheye = fit_model(all, frame, true);
  return fisheye.worst_px < pinhole.worst_px / 2 ? fisheye : pinhole;
}

std::vector<float> pixel_depths(const Scene& scene, const std::vector<float>& rays,
                                double pupil_to_sensor_mm) {
  std::vector<float> depths(rays.size() / 2, std::numeric_limits<float>::infinity());
  if (scene.depth_m.empty()) {
    if (scene.distance_m()) std::fill(depths.begin(), depths.end(), static_cast<float>(*scene.distance_m()));
    return depths;
  }
  const std::vector<double> axial = axial_depths_m(scene, pupil_to_sensor_mm);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const double column =
        static_cast<double>(rays[2 * i]) / scene.tangent_per_sample() + scene.columns() / 2.0;
    const double row = static_cast<double>(rays[2 * i + 1]) / scene.tangent_per_sample() + scene.rows() / 2.0;
    if (!(column >= 0 && row >= 0 && column < scene.columns() && row < scene.rows())) continue;
    depths[i] =
        static_cast<float>(axial[static_cast<std::size_t>(row) * static_cast<std::size_t>(scene.columns()) +
                                 static_cast<std::size_t>(column)]);
  }
  return depths;
}

}  // namespace petzval
