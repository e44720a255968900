// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/analysis/encircled_energy.h>
#include <petzval/analysis/pupil_rays.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>

#include <cmath>

#include "analysis/stigmatic_lens.h"

namespace petzval {
namespace {

Psf uniform(int size, double spacing_um) {
  Psf psf;
  psf.size = size;
  psf.spacing_um = spacing_um;
  psf.values.assign(static_cast<std::size_t>(size * size), 1.0F / static_cast<float>(size * size));
  return psf;
}

TEST(EncircledEnergy, OfAnEvenSquareIsTheAreaOfTheCircle) {
  const Psf psf = uniform(41, 0.5);
  const double side = 41 * 0.5, radii[] = {0, 0.2, 1, 5, 9.9};
  for (const auto& [s, t] : {std::pair{0.0, 0.0}, {0.21, -0.13}}) {
    const std::vector<double> shares = encircled_energy(psf, radii, s, t);
    for (std::size_t i = 0; i < shares.size(); ++i)
      // Cells on the edge are cut into 32 strips.
      EXPECT_NEAR(shares[i], pi * radii[i] * radii[i] / (side * side), 2e-5) << radii[i];
  }
  const double outside[] = {10.3};
  EXPECT_TRUE(std::isnan(encircled_energy(psf, outside)[0]));
  const double negative[] = {-1.0};
  EXPECT_THROW(encircled_energy(psf, negative), InputError);
}

TEST(EncircledEnergy, OfAStigmaticLensIsRayleighs) {
  FieldTableRequest request;
  request.fields = {0};
  request.wavelengths_nm = {550};
  EncircledEnergyOptions options;
  const double lambda_n_um = 0.55 * 10;
  for (const double share : {0.3, 0.61, 1.22, 2.233, 5.0, 12.0})
    options.radii_um.push_back(share * lambda_n_um);
  const std::vector<EncircledEnergyRow> rows = encircled_energy_table(stigmatic_lens(2), request, options);
  ASSERT_EQ(rows.size(), options.radii_um.size());
  // 83.8 % in the first dark ring, 91.0 % in the second (Rayleigh).
  EXPECT_NEAR(rows[2].airy, 0.838, 1e-3);
  EXPECT_NEAR(rows[3].airy, 0.910, 1e-3);
  for (const EncircledEnergyRow& row : rows)
    // Cells of 0.15 λN spread the light by as much; the pupil of this lens is 2 NA² = 0.5 % from even.
    EXPECT_NEAR(row.encircled_energy, row.airy, 0.006) << row.radius_um;
}

TEST(EncircledEnergy, TendsToThatOfTheRaysForWideSpots) {
  const Lens lens = read_lens("dgauss-50mm").lens;
  FieldTableRequest request;
  request.fields = {14};
  request.wavelengths_nm = {550};
  EncircledEnergyOptions options;
  options.radii_um = {20, 40, 60};
  const std::vector<EncircledEnergyRow> rows = encircled_energy_table(lens, request, options);
  FieldTracer tracer(lens, 550);
  const std::vector<PupilRay> rays = pupil_rays(tracer, *tracer.chief_ray(14));
  double weight = 0, mean = 0;
  for (const PupilRay& ray : rays) {
    weight += ray.entrance_measure;
    mean += ray.entrance_measure * ray.y_mm;
  }
  for (const EncircledEnergyRow& row : rows) {
    double inside = 0;
    for (const PupilRay& ray : rays)
      if (std::hypot(ray.x_mm, ray.y_mm - mean / weight) * um_per_mm < row.radius_um)
        inside += ray.entrance_measure / weight;
    // Diffraction takes 2λN/(π² r), 1 % at 20 µm, and rays are counted whole.
    EXPECT_NEAR(row.encircled_energy, inside, 0.03) << row.radius_um;
    EXPECT_LT(row.encircled_energy, row.airy);
  }
}

TEST(EncircledEnergy, RefusesAbsurdRadii) {
  FieldTableRequest request = FieldTableRequest::of(stigmatic_lens(2));
  for (const double radius : {-1.0, 1e6, std::nan("")}) {
    EncircledEnergyOptions options;
    options.radii_um = {radius};
    EXPECT_THROW(encircled_energy_table(stigmatic_lens(2), request, options), InputError);
  }
}

}  // namespace
}  // namespace petzval
