// SPDX-License-Identifier: BSD-3-Clause
// The loop of METHODS closed with a real lens: g_source and the PSFs, which trace forwards from object
// points, must give a uniform wall the illumination that g_sensor, traced backwards from image points, says.
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <petzval/imaging/field_of_view.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/lens/lens_file.h>
#include <petzval/optics/build.h>

#include <cmath>

namespace petzval {
namespace {

TEST(LensWall, ComesOutAsTheBackwardTraceSays) {
  const Lens lens = read_lens("edmund-54852").lens;
  const SensorGeometry sensor{768, 576, 6.25};
  constexpr double half_diagonal_mm = 3;  // 480 pixels of 6.25 µm
  TableOptions table_options;
  table_options.wavelengths_nm = {587.5618};
  table_options.max_image_height_mm = half_diagonal_mm;
  const LensDataTable table = build_lens_data_table(lens, table_options);
  Scene wall(64, 48, {587.5618}, 90, *object_to_sensor_mm(table) / mm_per_m);
  std::fill(wall.band(0).begin(), wall.band(0).end(), 1.0F);
  const SpectralImage image = form_image(wall, table, sensor, {});

  const RadialProfile profile = RadialProfiles(table).at_wavelength(587.5618);
  constexpr double ring_mm = 0.1;
  std::vector<double> ratio_sums(31), counts(31);
  for (int row = 0; row < sensor.rows; ++row)
    for (int column = 0; column < sensor.columns; ++column) {
      const double height = std::hypot(sensor.x_mm(column + 0.5), sensor.y_mm(row + 0.5));
      const auto ring = static_cast<std::size_t>(height / ring_mm);
      ratio_sums[ring] += double(image.at(0, row, column)) / profile.g_sensor_sr(height);
      counts[ring] += 1;
    }
  // The bound that the project promises; the vignetted zone from 2.5 mm on, where 21 fields follow the PSF
  // least well, keeps it too.
  for (std::size_t ring = 0; ring < 30; ++ring)
    EXPECT_NEAR(ratio_sums[ring] / counts[ring], 1, 1e-3) << double(ring) * ring_mm << " mm";
}

}  // namespace
}  // namespace petzval
