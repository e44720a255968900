// SPDX-License-Identifier: BSD-3-Clause
// Files of measured materials made from a metal of facets whose BRDF is known, for tests.
#pragma once

#include <petzval/base/units.h>
#include <petzval/render/materials/density_table.h>
#include <petzval/render/materials/fresnel.h>
#include <petzval/render/materials/microfacets.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace petzval::render {

/// A metal of facets of Trowbridge and Reitz, whose index rises with the wavelength.
struct FacetMetal {
  double alpha_x = 0.3, alpha_y = 0.3;

  Microfacets facets() const { return {alpha_x, alpha_y}; }
  double value(Vector3 wo, Vector3 wi, double nm) const {
    const Vector3 m = normalised(wo + wi);
    const auto reflectance = static_cast<double>(
        conductor_reflectance(static_cast<float>(dot(wo, m)), static_cast<float>(nm / 1000), 3.0f));
    return reflectance * facets().density(m) * facets().shown(wo, wi) / (4 * wo.z * wi.z);
  }
};

/// Puts fields into the container; see TensorFile.
class TensorWriter {
 public:
  void add(const std::string& name, const std::vector<std::size_t>& shape, const std::vector<float>& values) {
    std::string bytes;
    for (const float each : values) put(bytes, std::bit_cast<std::uint32_t>(each), 4);
    fields_.push_back({name, shape, 10, bytes});
  }
  void add_bytes(const std::string& name, const std::string& bytes) {
    fields_.push_back({name, {bytes.size()}, 1, bytes});
  }
  std::string file() const {
    std::size_t offset = 18;
    for (const Field& field : fields_) offset += 2 + field.name.size() + 3 + 8 + 8 * field.shape.size();
    std::string head("tensor_file\0\1\0", 14), values;
    put(head, fields_.size(), 4);
    for (const Field& field : fields_) {
      put(head, field.name.size(), 2);
      head += field.name;
      put(head, field.shape.size(), 2);
      put(head, field.type, 1);
      put(head, offset + values.size(), 8);
      for (const std::size_t each : field.shape) put(head, each, 8);
      values += field.bytes;
    }
    return head + values;
  }

 private:
  struct Field {
    std::string name;
    std::vector<std::size_t> shape;
    std::uint64_t type;
    std::string bytes;
  };
  static void put(std::string& bytes, std::uint64_t number, int size) {
    for (int i = 0; i < size; ++i) bytes += static_cast<char>(number >> (8 * i) & 0xff);
  }
  std::vector<Field> fields_;
};

/// How finely a metal is measured.
struct MeasuredGrid {
  std::size_t thetas = 12, phis = 1, facets = 64, spectra = 32;
  std::vector<float> wavelengths_nm{400, 500, 600, 700};
};

/// The metal as a .bsdf file: exact at the nodes of the grid.
class MeasuredFile {
 public:
  MeasuredFile(const FacetMetal& metal, const MeasuredGrid& grid) : metal_(metal), grid_(grid) {
    const bool turns = grid.phis > 2;
    for (std::size_t i = 0; i < grid.thetas; ++i)
      theta_.push_back(static_cast<float>(1.5 * share(i, grid.thetas)));
    for (std::size_t i = 0; i < grid.phis; ++i)
      phi_.push_back(turns ? static_cast<float>((2 * share(i, grid.phis) - 1) * pi) : 0);
    const std::size_t side = grid.facets;
    std::vector<float> ndf, sigma, vndf;
    for (std::size_t k = 0; k < side * side; ++k) {
      const Vector3 m = direction(node(k, side));
      ndf.push_back(static_cast<float>(facets_.density(m)));
      sigma.push_back(static_cast<float>(std::max(m.z, 1e-9) * (1 + facets_.lambda(m))));
    }
    for (const Vector3 wo : places())
      for (std::size_t k = 0; k < side * side; ++k) {
        const SquarePoint at = node(k, side);
        const Vector3 m = facet(at, wo);
        const double area = 2 * pi * pi * at.x * std::sin(at.x * at.x * pi / 2);
        vndf.push_back(static_cast<float>(std::max(0.0, dot(wo, m)) * facets_.density(m) * area));
      }
    const std::size_t n = grid.spectra;
    writer_.add("theta_i", {grid.thetas}, theta_);
    writer_.add("phi_i", {grid.phis}, phi_);
    writer_.add("ndf", {side, side}, ndf);
    writer_.add("sigma", {side, side}, sigma);
    writer_.add("vndf", {grid.phis, grid.thetas, side, side}, vndf);
    add_spectra(DensityTables(vndf, side, side));
    writer_.add("luminance", {grid.phis, grid.thetas, n, n}, luminance_);
    writer_.add("spectra", {grid.phis, grid.thetas, grid.wavelengths_nm.size(), n, n}, spectra_);
    writer_.add("wavelengths", {grid.wavelengths_nm.size()}, grid.wavelengths_nm);
    writer_.add_bytes("jacobian", std::string(1, '\1'));
    writer_.add_bytes("description", "a metal of facets");
  }
  std::string bytes() const { return writer_.file(); }

 private:
  static double share(std::size_t i, std::size_t n) {
    return n > 1 ? static_cast<double>(i) / static_cast<double>(n - 1) : 0;
  }
  static SquarePoint node(std::size_t k, std::size_t side) {
    return {share(k % side, side), share(k / side, side)};
  }
  static Vector3 direction(SquarePoint at, double turned = 0) {
    const double theta = at.x * at.x * pi / 2, phi = (2 * at.y - 1) * pi + turned;
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  }
  Vector3 facet(SquarePoint at, Vector3 wo) const {
    return direction(at, phi_.size() > 2 ? 0 : std::atan2(wo.y, wo.x));
  }
  std::vector<Vector3> places() const {
    std::vector<Vector3> result;
    for (const float phi : phi_)
      for (const float theta : theta_) {
        const double sin = std::sin(static_cast<double>(theta)), azimuth = static_cast<double>(phi);
        result.push_back(
            {sin * std::cos(azimuth), sin * std::sin(azimuth), std::cos(static_cast<double>(theta))});
      }
    return result;
  }
  /// f cos θi 4σ/D where light that is seen in evenly drawn facets comes from.
  void add_spectra(const DensityTables& seen) {
    const std::size_t n = grid_.spectra;
    std::size_t table = 0;
    for (const Vector3 wo : places()) {
      TableBlend blend;
      blend.table[0] = table++;
      const double area = wo.z * (1 + facets_.lambda(wo));
      std::vector<double> mean(n * n);
      for (const float nm : grid_.wavelengths_nm)
        for (std::size_t k = 0; k < n * n; ++k) {
          const Vector3 m = facet(seen.drawn(blend, node(k, n)), wo), wi = reflected(wo, m);
          const double f = wi.z > 0 ? metal_.value(wo, wi, static_cast<double>(nm)) : 0;
          spectra_.push_back(static_cast<float>(f * wi.z * 4 * area / facets_.density(m)));
          mean[k] += static_cast<double>(spectra_.back());
        }
      for (const double each : mean) luminance_.push_back(static_cast<float>(each));
    }
  }

  FacetMetal metal_;
  MeasuredGrid grid_;
  Microfacets facets_ = metal_.facets();
  std::vector<float> theta_, phi_, luminance_, spectra_;
  TensorWriter writer_;
};

}  // namespace petzval::render
