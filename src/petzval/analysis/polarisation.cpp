// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/polarisation.h>
#include <petzval/base/units.h>
#include <petzval/trace/losses.h>

#include <Eigen/Core>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <complex>

namespace petzval {

namespace {

constexpr int radial_nodes = 12, azimuths = 96;

using Matrix = Eigen::Matrix2cd;

Matrix matrix_of(const Jones& jones) {
  Matrix matrix;
  matrix << jones[0][0], jones[0][1], jones[1][0], jones[1][1];
  return matrix;
}

/// Sums over the light of a pupil.
class PolarisedLight {
 public:
  explicit PolarisedLight(double wavelength_nm) : wavelength_nm_(wavelength_nm) {}

  void add(const Matrix& jones, double weight) {
    const Eigen::JacobiSVD<Matrix> parts(jones, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double best = std::pow(parts.singularValues()[0], 2),
                 worst = std::pow(parts.singularValues()[1], 2);
    if (!(best > 0)) return;
    const double diattenuation = (best - worst) / (best + worst);
    // What is left without it turns the two polarisations by opposite phases, and both by one.
    const Matrix unitary = parts.matrixU() * parts.matrixV().adjoint();
    const double half_turn = std::acos(std::min(1.0, std::abs(unitary.trace()) / 2));
    const double retardance_nm = half_turn / pi * wavelength_nm_;
    const double light = weight * 0.5 * jones.squaredNorm();
    weight_ += weight;
    light_ += light;
    // What both polarisations are late by is wavefront, most of which goes with a new focus: not counted.
    mean_ += weight * std::polar(1.0, -std::arg(unitary.trace())) * jones;
    diattenuation_ += light * diattenuation;
    retardance_sq_ += light * retardance_nm * retardance_nm;
    row_.largest_diattenuation = std::max(row_.largest_diattenuation, diattenuation);
    row_.largest_retardance_nm = std::max(row_.largest_retardance_nm, retardance_nm);
  }
  bool any() const { return light_ > 0; }
  PolarisationRow row() const {
    PolarisationRow row = row_;
    row.transmittance = light_ / weight_;
    row.diattenuation = diattenuation_ / light_;
    row.rms_retardance_nm = std::sqrt(retardance_sq_ / light_);
    row.strehl = 0.5 * mean_.squaredNorm() / (weight_ * light_);
    return row;
  }

 private:
  double wavelength_nm_, weight_ = 0, light_ = 0, diattenuation_ = 0, retardance_sq_ = 0;
  Matrix mean_ = Matrix::Zero();
  PolarisationRow row_;
};

std::optional<PolarisationRow> polarisation(const FieldTracer& tracer, const ChiefRay& chief,
                                            const LensTransmittance& transmittance) {
  const std::optional<PupilBoundary> pupil = tracer.object_pupil(chief, azimuths);
  if (!pupil) return {};
  const Pencil pencil = Pencil::from_object(tracer.lens(), chief.object_field);
  PolarisedLight light(tracer.tracer().wavelength_nm());
  std::vector<Intersection> path;
  for (const PupilNode& node : pupil_nodes(*pupil, radial_nodes))
    for (const double side : {1.0, -1.0}) {
      if (side < 0 && !pupil->mirrored()) continue;
      const std::optional<Ray> launched = pencil.ray(side * node.u, node.v);
      path.clear();
      if (!launched || tracer.tracer().trace(*launched, Tracer::Clip::none, &path).status != RayStatus::ok)
        continue;
      light.add(matrix_of(transmittance.jones(*launched, path)), node.weight);
    }
  if (!light.any()) return {};
  PolarisationRow row = light.row();
  row.real_image_height_mm = chief.image_height_mm;
  return row;
}

}  // namespace

std::vector<PolarisationRow> polarisation_table(const Lens& lens, const FieldTableRequest& request) {
  Losses losses = request.losses;
  if (!losses.of(lens).any()) losses.fresnel = true;
  return field_rows<PolarisationRow>(lens, request, [&](const FieldTracer& tracer, const ChiefRay& chief) {
    return polarisation(tracer, chief, LensTransmittance(lens, tracer.tracer().wavelength_nm(), losses));
  });
}

}  // namespace petzval
