// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/field_rows.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/surface_shape.h>
#include <petzval/optimise/lens_objective.h>

#include <algorithm>

namespace petzval {

namespace {

/// What a relative error of the focal length of 1, and a rim that is 1 mm too thin, cost in units of the
/// merit [µm]; of wavefronts [nm] fifty times as much, about as spots of a slow lens compare with its waves.
constexpr double efl_cost_um = 5e3, rim_cost_um = 1e3, nm_of_wave_per_um = 50;
/// A per cent of distortion too much costs as much as so many µm of spot, or per cent of MTF.
constexpr double distortion_cost_um = 100;
/// Of differences that are smooth and cost nothing: a third of the digits.
constexpr double difference_share = 1e-6;

double sag_mm(const Surface& surface, double height_mm) {
  return surface_point(shape_of(surface), 0, height_mm).sag;
}

/// Of the largest of its azimuths; of a lens that is not round about where field 0 lands, along the field.
double distortion_percent(const Lens& lens, double object_field, const std::vector<double>& azimuths_deg) {
  const double nm = lens.reference_wavelength_nm, ideal = ideal_image_height_mm(lens, object_field, nm);
  double largest = 0;
  for (const double azimuth : azimuths_deg) {
    FieldTracer tracer(lens, nm, Tracer::Clip::none, azimuth);
    const std::optional<ChiefRay> chief = tracer.chief_ray(object_field);
    const bool centred = tracer.tracer().is_centred();
    const std::optional<ChiefRay> middle = centred ? std::nullopt : tracer.chief_ray(0);
    if (!chief || (!centred && !middle)) return lost_ray;
    const double height = chief->image_height_mm - (middle ? middle->image_height_mm : 0);
    largest = std::max(largest, 100 * std::abs(height / ideal - 1));
  }
  return largest;
}

/// A coefficient that bends the rim by a hundredth of a millimetre.
double power_scale(const Lens& lens, const LensNumber& number) {
  const double rim = lens.surfaces[number.surface].semi_diameter_mm.value_or(0.1 * std::abs(efl_of(lens)));
  return 0.01 / std::pow(rim, number.power);
}

}  // namespace

double efl_of(const Lens& lens) {
  return first_order(lens, lens.reference_wavelength_nm).efl_mm;
}

std::optional<double> glass_rim_mm(const Lens& lens, std::size_t surface) {
  const Surface& front = lens.surfaces[surface];
  if (front.material.is_air() || surface + 1 >= lens.surfaces.size()) return {};
  const Surface& back = lens.surfaces[surface + 1];
  if (!front.semi_diameter_mm || !back.semi_diameter_mm) return {};
  const double height = std::min(*front.semi_diameter_mm, *back.semi_diameter_mm);
  return front.thickness_mm + sag_mm(back, height) - sag_mm(front, height);
}

VariableMapping::VariableMapping(const Lens& lens, const std::vector<LensVariable>& variables)
    : variables_(variables) {
  for (const LensVariable& variable : variables) {
    const double value = value_of(lens, variable.number);
    double scale = std::abs(value);
    if (variable.number.kind == LensNumber::Kind::curvature_per_mm) scale = std::max(scale, 1 / efl_of(lens));
    if (variable.number.kind == LensNumber::Kind::conic) scale = 1;
    if (variable.number.kind == LensNumber::Kind::power) scale = power_scale(lens, variable.number);
    if (variable.number.is_pose()) scale = 1;  // a mm or a degree
    scales_.push_back(scale > 0 && std::isfinite(scale) ? scale : 1);
  }
}

Lens VariableMapping::lens_at(Lens lens, const Eigen::VectorXd& x) const {
  for (std::size_t i = 0; i < variables_.size(); ++i)
    lens = with_value(std::move(lens), variables_[i].number, value(i, x[static_cast<Eigen::Index>(i)]));
  return lens;
}

Eigen::VectorXd VariableMapping::at(const Lens& lens) const {
  Eigen::VectorXd x(static_cast<Eigen::Index>(variables_.size()));
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    const LensVariable& variable = variables_[i];
    const double now = value_of(lens, variable.number);
    // Off the limits themselves, where the sine stands still.
    constexpr double edge = 1 - 1e-3;
    x[static_cast<Eigen::Index>(i)] =
        variable.is_bounded() ? std::asin(std::clamp((now - middle(variable)) / half(variable), -edge, edge))
                              : now / scales_[i];
  }
  return x;
}

LensObjective::LensObjective(RayMerit rays, const Lens& lens, const OptimiseRequest& request,
                             const VariableMapping& mapping, const Targets& targets,
                             const std::function<void()>& check_stop)
    : DenseFunctor<double>(static_cast<int>(request.variables.size()),
                           static_cast<int>(rays.rows()) + static_cast<int>(targets.count())),
      rays_(std::move(rays)),
      lens_(lens),
      mapping_(mapping),
      targets_(targets),
      check_stop_(check_stop),
      cost_(request.merit == OptimiseMerit::wavefront ? nm_of_wave_per_um : 1) {}

int LensObjective::df(const InputType& x, JacobianType& slopes) const {
  ValueType values(this->values());
  evaluate(mapping_.lens_at(lens_, x), values, &slopes);
  for (Eigen::Index i = 0; i < x.size(); ++i)
    slopes.col(i) *= mapping_.slope(static_cast<std::size_t>(i), x[i]);
  return 0;
}

Eigen::VectorXd LensObjective::others(const Lens& lens) const {
  Eigen::VectorXd values(static_cast<Eigen::Index>(targets_.count()));
  values[0] = cost_ * efl_cost_um * (efl_of(lens) / targets_.efl_mm - 1);
  for (std::size_t i = 0; i < targets_.rims.size(); ++i) {
    const auto& [surface, least] = targets_.rims[i];
    const double rim = glass_rim_mm(lens, surface).value_or(least);
    values[1 + static_cast<Eigen::Index>(i)] = cost_ * rim_cost_um * std::max(0.0, least - rim);
  }
  if (targets_.fields.empty()) return values;
  for (std::size_t i = 0; i < targets_.fields.size(); ++i)
    values[1 + static_cast<Eigen::Index>(targets_.rims.size() + i)] =
        cost_ * distortion_cost_um *
        std::max(0.0, distortion_percent(lens, targets_.fields[i], targets_.azimuths_deg) -
                          targets_.most_distortion_percent);
  return values;
}

void LensObjective::evaluate(const Lens& lens, ValueType& values, JacobianType* slopes) const {
  check_stop_();
  Eigen::MatrixXd ray_slopes;
  const auto rows = rays_.rows();
  const auto residuals = rays_.residuals(lens, slopes ? &ray_slopes : nullptr);
  const Eigen::VectorXd rest = others(lens);
  if (!residuals || !rest.allFinite()) {
    values.setConstant(lost_ray);
    if (slopes) slopes->setZero();
    return;
  }
  values << *residuals, rest;
  if (!slopes) return;
  slopes->topRows(rows) = ray_slopes;
  for (std::size_t i = 0; i < mapping_.variables().size(); ++i) {
    const LensNumber& number = mapping_.variables()[i].number;
    const double now = value_of(lens, number);
    const double step = difference_share * std::max(std::abs(now), std::abs(mapping_.slope(i, 0)));
    slopes->col(static_cast<Eigen::Index>(i)).tail(rest.size()) =
        (others(with_value(lens, number, now + step)) - others(with_value(lens, number, now - step))) /
        (2 * step);
  }
}

}  // namespace petzval
