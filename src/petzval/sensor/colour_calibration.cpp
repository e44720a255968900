// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/colour/cielab.h>
#include <petzval/colour/display.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/spectra_files.h>
#include <petzval/sensor/colour_calibration.h>
#include <petzval/sensor/photo_current.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Light reflected by a surface, at the wavelengths of both.
Spectrum reflected(const Spectrum& light, const Spectrum& reflectance) {
  std::vector<double> nm = light.wavelengths_nm();
  nm.insert(nm.end(), reflectance.wavelengths_nm().begin(), reflectance.wavelengths_nm().end());
  std::sort(nm.begin(), nm.end());
  nm.erase(std::unique(nm.begin(), nm.end()), nm.end());
  std::vector<double> kept, values;
  for (const double at : nm) {
    if (at < light.front_nm() || at > light.back_nm()) continue;
    kept.push_back(at);
    values.push_back(light.at(at) * reflectance.at_extended(at));
  }
  return {kept, values};
}

/// The patches as the sensor and as the eye see them; white has response `neutral` and Y = 1.
struct Patches {
  VectorXd neutral;
  Xyz white;
  MatrixXd camera, xyz;  ///< channels × patches, 3 × patches
};

Patches patches_under(const Sensor& sensor, const Spectrum& light) {
  const SpectrumSet chart = read_spectrum_set("colorchecker_reflectance");
  const Observer& eye = Observer::cie_1931();
  const auto response = [&](const Spectrum& spectrum) {
    const std::vector<double> currents = channel_currents(sensor, spectrum);
    return VectorXd(Eigen::Map<const VectorXd>(currents.data(), static_cast<Eigen::Index>(currents.size())));
  };
  Patches patches;
  const VectorXd white = response(light);
  const double most = white.maxCoeff(), y = eye.xyz(light).y;
  if (!(white.minCoeff() > 0 && y > 0))
    throw InputError("colours need light that the eye and every channel of the sensor see");
  patches.neutral = white / most;
  patches.white = (1 / y) * eye.xyz(light);
  patches.camera.resize(white.size(), static_cast<Eigen::Index>(chart.spectra.size()));
  patches.xyz.resize(3, static_cast<Eigen::Index>(chart.spectra.size()));
  for (std::size_t i = 0; i < chart.spectra.size(); ++i) {
    const Spectrum seen = reflected(light, chart.spectra[i].spectrum);
    const auto column = static_cast<Eigen::Index>(i);
    patches.camera.col(column) = response(seen) / most;
    const Xyz xyz = (1 / y) * eye.xyz(seen);
    patches.xyz.col(column) << xyz.x, xyz.y, xyz.z;
  }
  return patches;
}

/// X with A·X = B, of which B has more rows. Here alone, for each kind of solver costs seconds to compile.
MatrixXd least_squares(const MatrixXd& a, const MatrixXd& b) {
  return a.colPivHouseholderQr().solve(b);
}

MatrixXd product(const MatrixXd& a, const MatrixXd& b) {
  return a * b;
}

Xyz as_xyz(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

/// All maps that keep white: white · neutralᵀ/|neutral|² + parameters · free, with free · neutral = 0.
class WhiteKeepingMap {
 public:
  explicit WhiteKeepingMap(const Patches& patches) {
    const Eigen::Index channels = patches.neutral.size();
    const Eigen::Vector3d white(patches.white.x, patches.white.y, patches.white.z);
    base_ = white * patches.neutral.transpose() / patches.neutral.squaredNorm();
    const MatrixXd q = Eigen::ColPivHouseholderQR<MatrixXd>(patches.neutral).householderQ();
    free_ = q.rightCols(channels - 1).transpose();
  }
  Eigen::Index count() const { return 3 * free_.rows(); }
  MatrixXd matrix(const VectorXd& parameters) const {
    return base_ + product(Eigen::Map<const MatrixXd>(parameters.data(), 3, free_.rows()), free_);
  }
  /// Least squares in XYZ.
  VectorXd start(const Patches& patches) const {
    const MatrixXd seen = product(free_, patches.camera),
                   wanted = patches.xyz - product(base_, patches.camera),
                   solved = least_squares(seen.transpose(), wanted.transpose()).transpose();
    return Eigen::Map<const VectorXd>(solved.data(), solved.size());
  }

 private:
  MatrixXd base_, free_;
};

VectorXd lab_residuals(const Patches& patches, const MatrixXd& xyz_from_camera) {
  const MatrixXd seen = product(xyz_from_camera, patches.camera);
  VectorXd residuals(3 * seen.cols());
  for (Eigen::Index i = 0; i < seen.cols(); ++i) {
    const Lab a = cielab(as_xyz(seen.col(i)), patches.white),
              b = cielab(as_xyz(patches.xyz.col(i)), patches.white);
    residuals.segment<3>(3 * i) << a.l - b.l, a.a - b.a, a.b - b.b;
  }
  return residuals;
}

/// CIELAB about a colour: the change with X, Y and Z.
Eigen::Matrix3d lab_slopes(const Xyz& colour, const Xyz& white) {
  Eigen::Matrix3d slopes;
  const double step = 1e-6;
  const auto lab = [&](const Xyz& at) {
    const Lab value = cielab(at, white);
    return Eigen::Vector3d(value.l, value.a, value.b);
  };
  slopes.col(0) = lab({colour.x + step, colour.y, colour.z}) - lab({colour.x - step, colour.y, colour.z});
  slopes.col(1) = lab({colour.x, colour.y + step, colour.z}) - lab({colour.x, colour.y - step, colour.z});
  slopes.col(2) = lab({colour.x, colour.y, colour.z + step}) - lab({colour.x, colour.y, colour.z - step});
  return slopes / (2 * step);
}

/// What the noise of photons in each channel becomes in CIELAB: one deviation a patch, channel and
/// coordinate, about the colours that are wanted.
VectorXd noise_residuals(const Patches& patches, const MatrixXd& xyz_from_camera, double white_e) {
  const Eigen::Index channels = patches.camera.rows();
  VectorXd residuals(3 * channels * patches.camera.cols());
  for (Eigen::Index i = 0; i < patches.camera.cols(); ++i) {
    const Eigen::Matrix3d slopes = lab_slopes(as_xyz(patches.xyz.col(i)), patches.white);
    for (Eigen::Index c = 0; c < channels; ++c)
      residuals.segment<3>(3 * (i * channels + c)) =
          std::sqrt(std::max(0.0, patches.camera(c, i)) / white_e) * (slopes * xyz_from_camera.col(c));
  }
  return residuals;
}

VectorXd all_residuals(const Patches& patches, const MatrixXd& xyz_from_camera,
                       std::optional<double> white_e) {
  const VectorXd colours = lab_residuals(patches, xyz_from_camera);
  if (!white_e) return colours;
  const VectorXd noise = noise_residuals(patches, xyz_from_camera, *white_e);
  VectorXd both(colours.size() + noise.size());
  both << colours, noise;
  return both;
}

VectorXd refine(const WhiteKeepingMap& map, const Patches& patches, std::optional<double> white_e,
                VectorXd parameters) {
  const auto residuals_of = [&](const VectorXd& at) {
    return all_residuals(patches, map.matrix(at), white_e);
  };
  double damping = 1e-3;
  VectorXd residuals = residuals_of(parameters);
  constexpr int most_steps = 60;
  constexpr double step = 1e-6;
  for (int iteration = 0; iteration < most_steps; ++iteration) {
    MatrixXd jacobian(residuals.size(), map.count());
    for (Eigen::Index p = 0; p < map.count(); ++p) {
      VectorXd moved = parameters;
      moved(p) += step;
      jacobian.col(p) = (residuals_of(moved) - residuals) / step;
    }
    const MatrixXd transposed = jacobian.transpose();
    MatrixXd normal = product(transposed, jacobian);
    normal.diagonal() *= 1 + damping;
    const VectorXd trial = parameters - least_squares(normal, product(transposed, residuals));
    const VectorXd trial_residuals = residuals_of(trial);
    const double gain = residuals.squaredNorm() - trial_residuals.squaredNorm();
    damping *= gain > 0 ? 0.2 : 10;
    if (gain <= 0) continue;
    parameters = trial;
    residuals = trial_residuals;
    if (gain < 1e-10 * residuals.squaredNorm()) break;
  }
  return parameters;
}

/// Row by row.
std::vector<double> flat(const MatrixXd& matrix) {
  std::vector<double> values;
  for (Eigen::Index r = 0; r < matrix.rows(); ++r)
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) values.push_back(matrix(r, c));
  return values;
}

/// Channels from XYZ: the inverse, or for more channels than three the least squares over the patches.
MatrixXd inverse_map(const Patches& patches, const MatrixXd& xyz_from_camera) {
  if (xyz_from_camera.cols() == 3) return Eigen::Matrix3d(xyz_from_camera).inverse();
  return least_squares(patches.xyz.transpose(), patches.camera.transpose()).transpose();
}

}  // namespace

ColourFit fit_colour(const Sensor& sensor, const Spectrum& light, std::optional<double> white_e) {
  constexpr std::size_t least_channels = 3;
  if (sensor.require_electronics().channels.size() < least_channels)
    throw InputError(fmt::format("sensor {} has {} channels; colours need three", sensor.name,
                                 sensor.electronics->channels.size()));
  const Patches patches = patches_under(sensor, light);
  const WhiteKeepingMap map(patches);
  const MatrixXd fitted = map.matrix(refine(map, patches, white_e, map.start(patches)));

  ColourFit fit{flat(patches.neutral), flat(fitted), flat(inverse_map(patches, fitted)), 0, 0, 0};
  fit.noise_delta_e_ab = std::sqrt(noise_residuals(patches, fitted, noisy_white_e).squaredNorm() /
                                   static_cast<double>(patches.camera.cols()));
  const MatrixXd seen = product(fitted, patches.camera);
  for (Eigen::Index i = 0; i < seen.cols(); ++i) {
    const double difference = delta_e_2000(cielab(as_xyz(seen.col(i)), patches.white),
                                           cielab(as_xyz(patches.xyz.col(i)), patches.white));
    fit.mean_delta_e_2000 += difference / static_cast<double>(seen.cols());
    fit.max_delta_e_2000 = std::max(fit.max_delta_e_2000, difference);
  }
  return fit;
}

ColourCalibration calibration(const Sensor& sensor, const Spectrum& light, int exif_light_source,
                              double temperature_k) {
  constexpr double well_exposed = 0.8;
  const SensorElectronics& electronics = sensor.require_electronics();
  const double white_e = well_exposed * electronics.saturation_e(electronics.gain_mode(""), 1);
  const ColourFit fit = fit_colour(sensor, light, white_e);
  const Observer& eye = Observer::cie_1931();
  const Xyz white = eye.xyz(light), d50 = xyz_of(Chromaticity{0.34567, 0.35850});
  const ColourMatrix adapt = bradford_adaptation((1 / white.y) * white, d50);
  ColourCalibration calibration{exif_light_source, temperature_k, fit.camera_from_xyz, {}};
  const std::size_t channels = fit.neutral.size();
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < channels; ++c) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) sum += adapt[r][k] * fit.xyz_from_camera[k * channels + c];
      calibration.pcs_from_balanced.push_back(sum * fit.neutral[c]);
    }
  return calibration;
}

std::vector<ColourCalibration> standard_calibrations(const Sensor& sensor) {
  if (sensor.require_electronics().channels.size() < 3) return {};
  constexpr int exif_a = 17, exif_d65 = 21;
  constexpr double a_k = 2856, d65_k = 6504;
  return {calibration(sensor, illuminant("A"), exif_a, a_k),
          calibration(sensor, illuminant("D65"), exif_d65, d65_k)};
}

std::vector<double> neutral_of(const Sensor& sensor, const Spectrum& light) {
  std::vector<double> neutral = channel_currents(sensor, light);
  const double most = *std::max_element(neutral.begin(), neutral.end());
  for (double& value : neutral) {
    if (!(value > 0)) throw InputError("a white balance needs light that every channel of the sensor sees");
    value /= most;
  }
  return neutral;
}

}  // namespace petzval
