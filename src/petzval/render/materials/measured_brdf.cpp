// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/render/materials/measured_brdf.h>
#include <petzval/render/materials/tensor_file.h>

#include <algorithm>

namespace petzval::render {

namespace {

SquarePoint square_of(double theta, double phi) {
  const double y = phi / (2 * pi) + 0.5;
  return {std::sqrt(std::min(1.0, theta * 2 / pi)), y - std::floor(y)};
}

double theta_of(Vector3 w) {
  return std::atan2(std::hypot(w.x, w.y), w.z);
}
double phi_of(Vector3 w) {
  return std::atan2(w.y, w.x);
}

std::vector<float> read_axis(const TensorFile& file, const char* field, const std::string& name) {
  std::vector<float> axis = file.floats(field, 1).values;
  if (std::adjacent_find(axis.begin(), axis.end(), std::greater_equal<>()) != axis.end())
    throw InputError(name, fmt::format("field \"{}\" does not rise", field));
  return axis;
}

}  // namespace

/// The normal of a facet that reflects, in the square.
struct MeasuredBrdf::Facet {
  SquarePoint at;
  double sin = 0, cos_seen = 0;  ///< of its elevation; between it and wo
};

MeasuredBrdf::MeasuredBrdf(std::string_view bytes, const std::string& name, const WavelengthGroups& groups)
    : MeasuredBrdf(TensorFile(bytes, name), name, groups) {}

MeasuredBrdf::MeasuredBrdf(const TensorFile& file, const std::string& name, const WavelengthGroups& groups)
    : name_(name),
      theta_(read_axis(file, "theta_i", name)),
      phi_(read_axis(file, "phi_i", name)),
      isotropic_(phi_.size() <= 2),
      facets_(read_map(file, "ndf")),
      area_(read_map(file, "sigma")),
      seen_(read_densities(file, "vndf")),
      bright_(read_densities(file, "luminance")) {
  const double turn = static_cast<double>(phi_.back() - phi_.front());
  if (!isotropic_ && std::abs(turn - 2 * pi) > 0.01)
    throw InputError(name,
                     "is measured over a part of the azimuths only; phi_i over a full turn would be right");
  read_spectra(file, groups);
  find_albedo(groups.count());
}

MeasuredBrdf::Map MeasuredBrdf::read_map(const TensorFile& file, const char* field) const {
  FloatTensor read = file.floats(field, 2);
  require_shape(read, 0, field);
  return {read.shape[0], read.shape[1], std::move(read.values)};
}

DensityTables MeasuredBrdf::read_densities(const TensorFile& file, const char* field) const {
  FloatTensor read = file.floats(field, 4);
  require_shape(read, 2, field);
  for (float& each : read.values) each = std::max(each, 0.0f);
  return {std::move(read.values), read.shape[2], read.shape[3]};
}

/// Those at phi_i and theta_i come first, the rows and columns of a table last.
void MeasuredBrdf::require_shape(const FloatTensor& read, std::size_t tables, const char* field) const {
  const std::size_t n = read.shape.size();
  if (tables > 0 && (read.shape[0] != phi_.size() || read.shape[1] != theta_.size()))
    throw InputError(name_,
                     fmt::format("field \"{}\" has {} x {} tables; {} x {}, as phi_i and theta_i have, would "
                                 "be right",
                                 field, read.shape[0], read.shape[1], phi_.size(), theta_.size()));
  if (read.shape[n - 2] < 2 || read.shape[n - 1] < 2)
    throw InputError(name_, fmt::format("field \"{}\" has tables of {} x {}; 2 x 2 or more would be right",
                                        field, read.shape[n - 2], read.shape[n - 1]));
}

void MeasuredBrdf::read_spectra(const TensorFile& file, const WavelengthGroups& groups) {
  if (!file.has("spectra") && file.has("rgb"))
    throw InputError(name_, "holds colours (rgb); a file with spectra would be right");
  const std::vector<float> wavelengths = read_axis(file, "wavelengths", name_);
  const FloatTensor read = file.floats("spectra", 5);
  require_shape(read, 2, "spectra");
  if (read.shape[2] != wavelengths.size())
    throw InputError(name_, fmt::format("field \"spectra\" has {} wavelengths, \"wavelengths\" has {}",
                                        read.shape[2], wavelengths.size()));
  rows_ = read.shape[3], columns_ = read.shape[4];
  const std::size_t size = rows_ * columns_, tables = phi_.size() * theta_.size();
  spectra_.assign(static_cast<std::size_t>(groups.count()), BandSpectrum(tables * size));
  for (std::size_t group = 0; group < spectra_.size(); ++group)
    for (int lane = 0; lane < lane_count; ++lane) {
      const AxisPlace at = place_on(wavelengths, groups.wavelength_nm(static_cast<int>(group), lane));
      const std::size_t next = std::min(at.first + 1, wavelengths.size() - 1);
      const auto part = static_cast<float>(at.part);
      for (std::size_t table = 0; table < tables; ++table) {
        const float* first = &read.values[(table * wavelengths.size() + at.first) * size];
        const float* second = &read.values[(table * wavelengths.size() + next) * size];
        for (std::size_t i = 0; i < size; ++i)
          spectra_[group][table * size + i][lane] = std::max(0.0f, (1 - part) * first[i] + part * second[i]);
      }
    }
}

void MeasuredBrdf::find_albedo(int groups) {
  constexpr int side = 32;  // of a grid of samples
  albedo_.assign(static_cast<std::size_t>(groups), Lanes::all(0));
  for (int group = 0; group < groups; ++group)
    for (int i = 0; i < side * side; ++i) {
      const auto chosen = sample({0, 0, 1}, (i % side + 0.5) / side, (i / side + 0.5) / side, group);
      if (chosen) albedo_[static_cast<std::size_t>(group)] += 1.0 / (side * side) * chosen->weight;
    }
}

double MeasuredBrdf::Map::at(SquarePoint point) const {
  const TableCell cell(point, rows, columns);
  const std::array<double, 4> corner = cell.corners();
  const float* first = &values[cell.row * columns + cell.column];
  return corner[0] * static_cast<double>(first[0]) + corner[1] * static_cast<double>(first[1]) +
         corner[2] * static_cast<double>(first[columns]) +
         corner[3] * static_cast<double>(first[columns + 1]);
}

/// The tables for a direction from which the surface is seen.
TableBlend MeasuredBrdf::seen_from(Vector3 wo) const {
  const AxisPlace theta = place_on(theta_, theta_of(wo));
  const AxisPlace phi = isotropic_ ? AxisPlace{} : place_on(phi_, phi_of(wo));
  TableBlend blend{0, {}, {}};
  for (const auto& [i, phi_weight] : {std::pair{phi.first, 1 - phi.part}, {phi.first + 1, phi.part}})
    for (const auto& [j, weight] : {std::pair{theta.first, 1 - theta.part}, {theta.first + 1, theta.part}}) {
      if (phi_weight * weight == 0) continue;
      blend.table[blend.count] = i * theta_.size() + j;
      blend.weight[blend.count++] = phi_weight * weight;
    }
  return blend;
}

MeasuredBrdf::Facet MeasuredBrdf::facet(Vector3 wo, Vector3 wi) const {
  const Vector3 m = normalised(wo + wi);
  return {square_of(theta_of(m), phi_of(m) - (isotropic_ ? phi_of(wo) : 0)), std::hypot(m.x, m.y),
          dot(wo, m)};
}

/// Of directions [1/sr]: of the two drawn one after the other, over the square, over facets, over the
/// mirrored.
double MeasuredBrdf::density(const TableBlend& blend, const Facet& facet, SquarePoint even) const {
  const double area = 2 * pi * pi * facet.at.x * facet.sin * 4 * facet.cos_seen;
  return area > 0 ? bright_.density(blend, even) * seen_.density(blend, facet.at) / area : 0;
}

Lanes MeasuredBrdf::spectrum(const TableBlend& blend, SquarePoint even, int group) const {
  const TableCell cell(even, rows_, columns_);
  const std::array<double, 4> corner = cell.corners();
  const BandSpectrum& spectra = spectra_[static_cast<std::size_t>(group)];
  Lanes sum = Lanes::all(0);
  for (std::size_t i = 0; i < blend.count; ++i) {
    const Lanes* first = &spectra[(blend.table[i] * rows_ + cell.row) * columns_ + cell.column];
    sum += blend.weight[i] * corner[0] * first[0];
    sum += blend.weight[i] * corner[1] * first[1];
    sum += blend.weight[i] * corner[2] * first[columns_];
    sum += blend.weight[i] * corner[3] * first[columns_ + 1];
  }
  return sum;
}

/// f cos θi.
Lanes MeasuredBrdf::reflected_light(const TableBlend& blend, Vector3 wo, const Facet& facet, SquarePoint even,
                                    int group) const {
  const double area = area_.at(square_of(theta_of(wo), phi_of(wo)));
  const double facets = facets_.at(facet.at);
  return area > 0 && facets > 0 ? facets / (4 * area) * spectrum(blend, even, group) : Lanes::all(0);
}

Lanes MeasuredBrdf::value(Vector3 wo, Vector3 wi, int group) const {
  if (!(wo.z * wi.z > 0)) return Lanes::all(0);
  if (wo.z < 0) wo = -wo, wi = -wi;
  const TableBlend blend = seen_from(wo);
  const Facet lit = facet(wo, wi);
  return 1 / wi.z * reflected_light(blend, wo, lit, seen_.undone(blend, lit.at), group);
}

double MeasuredBrdf::pdf(Vector3 wo, Vector3 wi) const {
  if (!(wo.z * wi.z > 0)) return 0;
  if (wo.z < 0) wo = -wo, wi = -wi;
  const TableBlend blend = seen_from(wo);
  const Facet lit = facet(wo, wi);
  return density(blend, lit, seen_.undone(blend, lit.at));
}

std::optional<BsdfSample> MeasuredBrdf::sample(Vector3 wo, double u, double v, int group) const {
  const bool below = wo.z < 0;
  if (below) wo = -wo;
  const TableBlend blend = seen_from(wo);
  const SquarePoint even = bright_.drawn(blend, {u, v});
  const SquarePoint at = seen_.drawn(blend, even);
  const double theta = at.x * at.x * pi / 2, phi = (2 * at.y - 1) * pi + (isotropic_ ? phi_of(wo) : 0);
  const double sin = std::sin(theta);
  const Vector3 m{sin * std::cos(phi), sin * std::sin(phi), std::cos(theta)};
  BsdfSample result;
  result.wi = reflected(wo, m);
  const Facet lit{at, sin, dot(wo, m)};
  result.pdf = density(blend, lit, even);
  if (!(result.wi.z > 0 && result.pdf > 0)) return {};
  result.weight = 1 / result.pdf * reflected_light(blend, wo, lit, even, group);
  if (below) result.wi = -result.wi;
  return result;
}

}  // namespace petzval::render
