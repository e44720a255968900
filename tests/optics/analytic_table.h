// SPDX-License-Identifier: BSD-3-Clause
// A lens data table whose entries are known in closed form.
#pragma once

#include <petzval/base/units.h>
#include <petzval/optics/lens_data_table.h>

#include <cmath>

namespace petzval::testing {

/// A lens of 6 mm focal length with barrel distortion, −10 % at the edge of its 30° half field, and cos⁴
/// falloff from π/16 sr (f/2); 1 % smaller pictures and 2 % more light at each 100 nm above 500.
struct AnalyticLens {
  double focal_mm = 6, edge_distortion = -0.10, edge_deg = 30;

  double height_mm(double field_deg, double wavelength_nm = 500) const {
    const double t = std::tan(radians(field_deg)), edge = std::tan(radians(edge_deg));
    return focal_mm * (1 - 0.01 * (wavelength_nm - 500) / 100) * t *
           (1 + edge_distortion * t * t / (edge * edge));
  }
  double g_sr(double field_deg, double wavelength_nm = 500) const {
    return pi / 16 * (1 + 0.02 * (wavelength_nm - 500) / 100) * std::pow(std::cos(radians(field_deg)), 4);
  }
};

/// A lopsided PSF, different for each seed, that sums to 1.
inline Psf comatic_psf(int size, int seed, double spacing_um) {
  Psf psf;
  psf.size = size;
  psf.spacing_um = spacing_um;
  psf.captured = 1 - 0.001 * seed;
  double sum = 0;
  std::vector<double> values;
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) {
      const double t = i - size / 2, s = j - size / 2;
      values.push_back(std::exp(-(s * s + t * t) / (2.0 + seed)) * (1.5 + std::tanh(0.3 * t + 0.1 * s)));
      sum += values.back();
    }
  for (const double value : values) psf.values.push_back(static_cast<float>(value / sum));
  return psf;
}

/// The analytic lens at evenly spaced fields. PSF sizes differ from entry to entry, odd and even.
inline LensDataTable analytic_table(int field_count = 21, std::vector<double> wavelengths_nm = {500, 600}) {
  const AnalyticLens lens;
  LensDataTable table;
  table.lens_name = "analytic";
  table.provenance = "closed form";
  table.lens_json = "{\"name\": \"analytic, ƒ = 6 mm\"}";
  table.vertex_to_sensor_mm = 6.25;
  table.first_order.wavelength_nm = 500;
  table.first_order.efl_mm = 6;
  table.first_order.f_number = 2;
  table.first_order.petzval_radius_mm = -INFINITY;
  table.first_order.exit_pupil = {-6, 3};
  table.wavelengths_nm = std::move(wavelengths_nm);
  for (int f = 0; f < field_count; ++f) {
    table.fields.push_back(f == 0 ? 0 : lens.edge_deg * f / (field_count - 1));
    for (const double wavelength : table.wavelengths_nm) {
      table.real_image_height_mm.push_back(lens.height_mm(table.fields.back(), wavelength));
      table.g_source_sr.push_back(lens.g_sr(table.fields.back(), wavelength));
      table.g_sensor_sr.push_back(0.99 * lens.g_sr(table.fields.back(), wavelength));
      const int seed = static_cast<int>(table.psf.size());
      table.psf.push_back(comatic_psf(5 + seed % 7, seed, 0.25 + 0.01 * seed));
    }
  }
  return table;
}

}  // namespace petzval::testing
