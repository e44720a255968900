// SPDX-License-Identifier: BSD-3-Clause
// Lens data tables made by formula, so that tests know what each number should do.
#pragma once

#include <petzval/base/units.h>
#include <petzval/imaging/cell_plane.h>
#include <petzval/optics/lens_data_table.h>
#include <petzval/scene/scene.h>

#include <cmath>
#include <functional>
#include <numeric>
#include <random>

namespace petzval::testing {

/// A spot of light: a Gaussian at (s, t) [µm].
struct Spot {
  double s_um = 0, t_um = 0, sigma_s_um = 1, sigma_t_um = 1, weight = 1;
};

inline Psf psf_of_spots(const std::vector<Spot>& spots, int size, double spacing_um) {
  Psf psf;
  psf.size = size;
  psf.spacing_um = spacing_um;
  std::vector<double> values;
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) {
      double value = 0;
      for (const Spot& spot : spots) {
        const double s = ((j - size / 2) * spacing_um - spot.s_um) / spot.sigma_s_um;
        const double t = ((i - size / 2) * spacing_um - spot.t_um) / spot.sigma_t_um;
        value += spot.weight / (spot.sigma_s_um * spot.sigma_t_um) * std::exp(-(s * s + t * t) / 2);
      }
      values.push_back(value);
    }
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  for (const double value : values) psf.values.push_back(static_cast<float>(value / sum));
  return psf;
}

/// Describes a table; every entry is a formula of the field.
struct TableRecipe {
  std::vector<double> fields{0, 5, 10, 15, 20};
  std::vector<double> wavelengths_nm{550};
  std::optional<double> object_distance_mm;
  double vertex_to_sensor_mm = 10;
  std::function<double(double field, double nm)> height_mm = [](double field, double) {
    return 6 * std::tan(radians(field));
  };
  std::function<double(double field)> g_source_sr = [](double) { return 0.25; };
  std::function<Psf(double field, double nm)> psf = [](double, double) {
    return psf_of_spots({{0, 0, 2, 2, 1}}, 65, 0.5);
  };
};

inline LensDataTable make_table(const TableRecipe& recipe) {
  LensDataTable table;
  table.lens_name = "made by formula";
  table.fields = recipe.fields;
  table.wavelengths_nm = recipe.wavelengths_nm;
  table.object_distance_mm = recipe.object_distance_mm;
  table.vertex_to_sensor_mm = recipe.vertex_to_sensor_mm;
  for (const double field : recipe.fields)
    for (const double nm : recipe.wavelengths_nm) {
      table.real_image_height_mm.push_back(recipe.height_mm(field, nm));
      table.g_source_sr.push_back(recipe.g_source_sr(field));
      table.g_sensor_sr.push_back(recipe.g_source_sr(field));
      table.psf.push_back(recipe.psf(field, nm));
    }
  return table;
}

/// A comatic PSF that grows with the field: a bright head and a tail away from the axis. `lean` puts the tail
/// to one side of the tangential plane, which no centred lens does, so that nothing is symmetric by accident.
inline Psf comatic_psf(double field_share, double lean = 0) {
  const double tail_um = 12 * field_share;
  return psf_of_spots({{0, 0, 1.5, 1.5, 1},
                       {lean * tail_um / 2, tail_um / 2, 1.5 + 2 * field_share, 1.5 + 2 * field_share, 0.8},
                       {lean * tail_um, tail_um, 1.5 + 4 * field_share, 1.5 + 3 * field_share, 0.5}},
                      129, 0.5);
}

inline TableRecipe comatic_recipe(double lean = 0) {
  TableRecipe recipe;
  recipe.psf = [lean](double field, double) { return comatic_psf(field / 20, lean); };
  return recipe;
}

/// Adds a Gaussian star about the centre of a sample.
inline void add_star(Scene& scene, int band, int column, int row, double sigma_samples) {
  for (int i = 0; i < scene.rows(); ++i)
    for (int j = 0; j < scene.columns(); ++j) {
      const double square =
          std::pow((i - row) / sigma_samples, 2) + std::pow((j - column) / sigma_samples, 2);
      if (square < 60)
        scene.band(band)[static_cast<std::size_t>(i * scene.columns() + j)] +=
            static_cast<float>(std::exp(-square / 2));
    }
}

inline double sum_of(const CellPlane& plane) {
  return std::accumulate(plane.values.begin(), plane.values.end(), 0.0);
}

/// Light at random on every cell, and a few points far brighter than the rest.
inline CellPlane random_plane(const SensorGeometry& grid) {
  CellPlane plane(grid);
  std::mt19937 random(1840);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (float& value : plane.values) {
    value = static_cast<float>(uniform(random));
    if (uniform(random) < 0.01) value *= 30;
  }
  return plane;
}

/// Every cell from black to white at random, as fine as a texture can be.
inline CellPlane texture(const SensorGeometry& grid) {
  CellPlane plane(grid);
  std::mt19937 random(1857);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (float& value : plane.values) value = uniform(random);
  return plane;
}

inline CellPlane tilted_checkerboard(const SensorGeometry& grid) {
  CellPlane plane(grid);
  for (std::size_t row = 0; row < plane.rows(); ++row)
    for (std::size_t column = 0; column < plane.columns(); ++column) {
      const double u = 0.97 * double(column) - 0.25 * double(row),
                   v = 0.25 * double(column) + 0.97 * double(row);
      plane.row(row)[column] = (std::lround(u / 9) + std::lround(v / 9)) % 2 == 0 ? 1.0F : 0.02F;
    }
  return plane;
}

/// √Σ(a − b)² / √Σb².
inline double relative_l2(const CellPlane& a, const CellPlane& b) {
  double difference = 0, total = 0;
  for (std::size_t i = 0; i < b.values.size(); ++i) {
    difference += std::pow(double(a.values[i]) - double(b.values[i]), 2);
    total += std::pow(double(b.values[i]), 2);
  }
  return std::sqrt(difference / total);
}

/// Centre of gravity in cells: column, row (centres at half-integers).
struct Centroid {
  double column, row;
};

inline Centroid centroid(const CellPlane& plane) {
  double column = 0, row = 0;
  for (std::size_t i = 0; i < plane.rows(); ++i)
    for (std::size_t j = 0; j < plane.columns(); ++j) {
      column += (double(j) + 0.5) * double(plane.row(i)[j]);
      row += (double(i) + 0.5) * double(plane.row(i)[j]);
    }
  const double total = sum_of(plane);
  return {column / total, row / total};
}

}  // namespace petzval::testing
