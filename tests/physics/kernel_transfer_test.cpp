// SPDX-License-Identifier: BSD-3-Clause
// The sharpness of an image is that of the lens: kernels, made of the PSFs of a table on cells as fine as λN
// and coarser, against the autocorrelation of the pupil, which knows neither tables nor cells.
#include <gtest/gtest.h>
#include <petzval/analysis/mtf.h>
#include <petzval/base/units.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/imaging/psf_kernel.h>
#include <petzval/lens/lens_file.h>
#include <petzval/optics/build.h>

#include <cmath>

namespace petzval {
namespace {

struct Case {
  const char* lens;
  double f_number, cell_um;
};

class KernelTransfer : public ::testing::TestWithParam<Case> {};

TEST_P(KernelTransfer, IsThatOfThePupilTimesTheWindow) {
  const auto [name, f_number, cell_um] = GetParam();
  MountedLens camera(read_lens(name).lens);
  camera.focus_at_m({});
  camera.set_f_number(f_number);
  TableOptions options;
  options.wavelengths_nm = {550};
  options.max_image_height_mm = 2;
  options.field_count = 9;
  const LensDataTable table = build_lens_data_table(camera.lens(), options);
  const PsfField psfs(table, 550, cell_um);
  for (const std::size_t field : {std::size_t{0}, std::size_t{3}, std::size_t{6}}) {
    const std::size_t entry = table.index(field, 0);
    const Kernel kernel = psfs.kernel_at(0, std::abs(table.real_image_height_mm[entry]));
    FieldTableRequest request{Fields::Kind::angle_deg, {table.fields[field]}, {550}};
    MtfOptions mtf;
    for (const double per_cell : {0.1, 0.2, 0.3, 0.4})
      mtf.frequencies_cpmm.push_back(per_cell / (cell_um * mm_per_um));
    for (const MtfRow& row : mtf_table(camera.lens(), request, mtf)) {
      const double per_cell = row.frequency_cpmm * cell_um * mm_per_um;
      double tangential_cosine = 0, tangential_sine = 0, sagittal = 0;
      for (int i = -kernel.radius; i <= kernel.radius; ++i)
        for (int j = -kernel.radius; j <= kernel.radius; ++j) {
          tangential_cosine += kernel.at(i, j) * std::cos(2 * pi * per_cell * i);
          tangential_sine += kernel.at(i, j) * std::sin(2 * pi * per_cell * i);
          sagittal += kernel.at(i, j) * std::cos(2 * pi * per_cell * j);
        }
      // A Gaussian of 0.65 cells.
      const double window = std::exp(-2 * std::pow(pi * 0.65 * per_cell, 2)),
                   captured = table.psf[entry].captured;
      // The hundredth of the light that the window of a PSF lost is modulated by less than half; 2e-3 for
      // splines between the steps of a lattice.
      const double allowed = 0.5 * (1 - captured) + 2e-3;
      EXPECT_NEAR(captured * std::hypot(tangential_cosine, tangential_sine), row.tangential * window, allowed)
          << name << " field " << field << ", " << per_cell << " cycles a cell";
      EXPECT_NEAR(captured * std::abs(sagittal), row.sagittal * window, allowed)
          << name << " field " << field << ", " << per_cell << " cycles a cell";
    }
  }
}

// The cut-off 1/λN lies within half a cycle a cell, so that cells fold nothing: λN is 4.4, 8.8, 3.1 and 12.1
// µm.
INSTANTIATE_TEST_SUITE_P(Lenses, KernelTransfer,
                         ::testing::Values(Case{"edmund-54852", 8, 2}, Case{"edmund-54852", 16, 4},
                                           Case{"dgauss-50mm", 5.6, 1.5}, Case{"cooke-triplet", 22, 3}),
                         [](const auto& info) { return "number" + std::to_string(info.index); });

}  // namespace
}  // namespace petzval
