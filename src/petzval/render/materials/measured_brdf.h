// SPDX-License-Identifier: BSD-3-Clause
// Measured reflection, as tables that follow the facets of the surface.
#pragma once

#include <petzval/render/materials/bsdf.h>
#include <petzval/render/materials/density_table.h>
#include <petzval/render/spectra/wavelength_groups.h>

#include <memory>
#include <string_view>

namespace petzval::render {

class TensorFile;
struct FloatTensor;

/// A BRDF in the adaptive parameterisation of Dupuy and Jakob (An adaptive parameterization for efficient
/// material acquisition and rendering, ACM TOG 37 (2018) 274): the density of facets D and their projected
/// area σ, found by power iterations, and f cos θi 4σ/D measured where the facets that are seen lie. Facets
/// and directions are placed by (√(2θ/π), φ/2π + 1/2).
class MeasuredBrdf {
 public:
  /// Reads a .bsdf file with the fields theta_i, phi_i, ndf, sigma, vndf, luminance, spectra and wavelengths.
  /// One or two phi_i mean an isotropic surface. Spectra are linear between wavelengths, and beyond them as
  /// at the nearest. \throws InputError "<name>: …" for a damaged file, and one in RGB alone.
  MeasuredBrdf(std::string_view bytes, const std::string& name, const WavelengthGroups& groups);

  /// As of Bsdf, each side of the surface alike.
  Lanes value(Vector3 wo, Vector3 wi, int group) const;
  double pdf(Vector3 wo, Vector3 wi) const;
  std::optional<BsdfSample> sample(Vector3 wo, double u, double v, int group) const;
  /// Share of the light from straight above that is reflected.
  const Lanes& albedo(int group) const { return albedo_[static_cast<std::size_t>(group)]; }

 private:
  /// A table of single values over the square.
  struct Map {
    std::size_t rows = 0, columns = 0;
    std::vector<float> values;

    double at(SquarePoint point) const;
  };
  struct Facet;

  MeasuredBrdf(const TensorFile& file, const std::string& name, const WavelengthGroups& groups);
  void require_shape(const FloatTensor& read, std::size_t tables, const char* field) const;
  Map read_map(const TensorFile& file, const char* field) const;
  DensityTables read_densities(const TensorFile& file, const char* field) const;
  void read_spectra(const TensorFile& file, const WavelengthGroups& groups);
  void find_albedo(int groups);
  TableBlend seen_from(Vector3 wo) const;
  Facet facet(Vector3 wo, Vector3 wi) const;
  double density(const TableBlend& blend, const Facet& facet, SquarePoint even) const;
  Lanes reflected_light(const TableBlend& blend, Vector3 wo, const Facet& facet, SquarePoint even,
                        int group) const;
  Lanes spectrum(const TableBlend& blend, SquarePoint even, int group) const;

  std::string name_;
  std::vector<float> theta_, phi_;
  bool isotropic_;
  Map facets_, area_;
  DensityTables seen_, bright_;
  std::size_t rows_ = 0, columns_ = 0;  ///< of the spectra
  std::vector<BandSpectrum> spectra_;   ///< [group][table, row, column]
  BandSpectrum albedo_;
};

}  // namespace petzval::render
