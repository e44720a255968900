// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/colour/display_primaries.h>
#include <petzval/colour/rec2100.h>
#include <petzval/isp/colour_rendering.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {

namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

Xyz d50() {
  return xyz_of(Chromaticity{0.34567, 0.35850});
}

Matrix3d as_eigen(const ColourMatrix& m) {
  Matrix3d result;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) result(r, c) = m[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
  return result;
}

MatrixXd as_matrix(const std::vector<double>& values, Eigen::Index rows) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(values.data(), rows, static_cast<Eigen::Index>(values.size()) / rows);
}

/// Share of the first calibration at a temperature: linear in its inverse, held beyond the two.
double share_of_first(const RawImage& raw, double temperature_k) {
  if (raw.calibrations.size() < 2) return 1;
  const double a = 1 / raw.calibrations[0].temperature_k, b = 1 / raw.calibrations[1].temperature_k;
  if (a == b) return 1;
  return std::clamp((1 / temperature_k - b) / (a - b), 0.0, 1.0);
}

MatrixXd camera_from_xyz(const RawImage& raw, double temperature_k) {
  const auto channels = static_cast<Eigen::Index>(raw.channels.size());
  const MatrixXd first = as_matrix(raw.calibrations[0].camera_from_xyz, channels);
  if (raw.calibrations.size() < 2) return first;
  const double share = share_of_first(raw, temperature_k);
  return share * first + (1 - share) * as_matrix(raw.calibrations[1].camera_from_xyz, channels);
}

void require_calibration(const RawImage& raw) {
  if (raw.calibrations.empty())
    throw InputError("the raw image has no colour matrix; `matrix` none would show its channels as they are");
}

VectorXd as_vector(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// The white whose image the neutral is, and its temperature.
std::pair<Xyz, double> white_of(const RawImage& raw, const std::vector<double>& neutral) {
  double temperature = 5000;
  Xyz white = d50();
  constexpr int rounds = 30;
  for (int i = 0; i < rounds; ++i) {
    const VectorXd xyz = camera_from_xyz(raw, temperature).colPivHouseholderQr().solve(as_vector(neutral));
    if (!(xyz(1) > 0 && xyz(0) > 0 && xyz(2) > 0) || !xyz.allFinite()) break;  // no white: stay where we are
    white = {xyz(0) / xyz(1), 1, xyz(2) / xyz(1)};
    // Half the way each time: the two may otherwise throw each other back and forth.
    temperature = (temperature + correlated_temperature_k(chromaticity(white))) / 2;
  }
  return {white, temperature};
}

MatrixXd forward_matrix(const RawImage& raw, double temperature_k) {
  const double share = share_of_first(raw, temperature_k);
  MatrixXd forward = as_matrix(raw.calibrations[0].pcs_from_balanced, 3);
  if (raw.calibrations.size() > 1 && !raw.calibrations[1].pcs_from_balanced.empty())
    forward = share * forward + (1 - share) * as_matrix(raw.calibrations[1].pcs_from_balanced, 3);
  return forward;
}

}  // namespace

DisplaySpace display_space(const std::string& name) {
  if (name == "srgb") return DisplaySpace::srgb;
  if (name == "display-p3") return DisplaySpace::display_p3;
  if (name == "rec2100-pq") return DisplaySpace::rec2100_pq;
  throw InputError(fmt::format("no display space \"{}\"; srgb, display-p3 and rec2100-pq are known", name));
}

ColourMatrix display_from_xyz(DisplaySpace space) {
  if (space == DisplaySpace::srgb) return srgb_from_xyz();
  if (space == DisplaySpace::rec2100_pq) return inverse(xyz_from_rec2020());
  return inverse(xyz_from_primaries({{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}}}));
}

double correlated_temperature_k(Chromaticity chromaticity) {
  const double n = (chromaticity.x - 0.3320) / (0.1858 - chromaticity.y);
  const double kelvin = 449 * n * n * n + 3525 * n * n + 6823.3 * n + 5520.33;
  return std::isfinite(kelvin) ? std::clamp(kelvin, 2000.0, 25000.0) : 5000;
}

CameraMatrix camera_matrix(const RawImage& raw, const std::vector<double>& neutral) {
  require_calibration(raw);
  const auto [white, temperature] = white_of(raw, neutral);
  MatrixXd forward;
  if (!raw.calibrations[0].pcs_from_balanced.empty()) {
    forward = forward_matrix(raw, temperature);
  } else {
    const MatrixXd inverse =
        camera_from_xyz(raw, temperature).completeOrthogonalDecomposition().pseudoInverse();
    forward = as_eigen(bradford_adaptation(white, d50())) * inverse * as_vector(neutral).asDiagonal();
    const double y = forward.row(1).sum();
    if (y > 0) forward /= y;
  }
  CameraMatrix result{{}, temperature};
  for (Eigen::Index r = 0; r < 3; ++r)
    for (Eigen::Index c = 0; c < forward.cols(); ++c) result.pcs_from_balanced.push_back(forward(r, c));
  return result;
}

std::vector<double> neutral_of_white(const RawImage& raw, Xyz white) {
  require_calibration(raw);
  const double temperature = correlated_temperature_k(chromaticity(white));
  const VectorXd response = camera_from_xyz(raw, temperature) * Vector3d(white.x, white.y, white.z);
  const double most = response.maxCoeff();
  std::vector<double> neutral;
  for (Eigen::Index i = 0; i < response.size(); ++i) {
    if (!(response(i) > 0)) throw InputError("this light gives no white in the sensor's channels");
    neutral.push_back(response(i) / most);
  }
  return neutral;
}

Planes rendered(Planes balanced, const CameraMatrix& matrix, DisplaySpace space) {
  const std::size_t channels = balanced.values.size();
  if (channels == 1)
    return {balanced.columns, balanced.rows, {balanced.values[0], balanced.values[0], balanced.values[0]}};
  if (matrix.pcs_from_balanced.size() != 3 * channels)
    throw InputError(fmt::format("a colour matrix of {} numbers for {} channels",
                                 matrix.pcs_from_balanced.size(), channels));
  const MatrixXd display = as_eigen(display_from_xyz(space)) *
                           as_eigen(bradford_adaptation(d50(), display_white())) *
                           as_matrix(matrix.pcs_from_balanced, 3);
  // In place: a picture of 12 megapixels has 150 MB, and the first touch of memory takes longer than the
  // sums.
  if (channels < 3) balanced.values.resize(3, std::vector<float>(balanced.values[0].size()));
  const auto columns = static_cast<std::size_t>(balanced.columns);
  parallel_for(static_cast<std::size_t>(balanced.rows), [&](std::size_t row) {
    std::array<std::vector<float>, 3> out;
    for (std::size_t k = 0; k < 3; ++k) {
      out[k].assign(columns, 0);
      for (std::size_t channel = 0; channel < channels; ++channel) {
        const auto weight =
            static_cast<float>(display(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(channel)));
        const float* in = balanced.values[channel].data() + row * columns;
        for (std::size_t c = 0; c < columns; ++c) out[k][c] += weight * in[c];
      }
    }
    for (std::size_t k = 0; k < 3; ++k)
      std::copy(out[k].begin(), out[k].end(),
                balanced.values[k].begin() + static_cast<std::ptrdiff_t>(row * columns));
  });
  balanced.values.resize(3);
  return balanced;
}

}  // namespace petzval
