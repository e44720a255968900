// SPDX-License-Identifier: BSD-3-Clause
// First-order data against programs that are not ours.
#include "sample_lenses.h"

#include <petzval/base/whole_file.h>
#include <petzval/lens/first_order.h>

#include <nlohmann/json.hpp>

namespace petzval {
namespace {

using namespace testing;

/// Asked for by the project; both programs work in double precision and differ by some 1e-14.
constexpr double reference_precision = 1e-9;

/// An independent double-precision tracer; the definitions are in the files.
class IndependentTracer : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(IndependentTracer, AgreesOnFirstOrderData) {
  const auto [name, file] = GetParam();
  const Lens lens = read_lens(name).lens;
  const auto reference = nlohmann::json::parse(read_whole_file(std::string(PETZVAL_TEST_DATA "/") + file));
  const auto& figures = reference["first_order_primary"];
  const FirstOrder data = first_order(lens);
  const auto expect = [&](double value, const char* key) {
    SCOPED_TRACE(key);
    expect_relative(value, figures[key], reference_precision);
  };
  expect(data.efl_mm, "EFL");
  expect(data.bfl_mm, "BFL");
  expect(data.ffl_mm, "FFL");
  expect(data.f_number, "fno");
  expect(data.entrance_pupil.position_mm, "EPL");
  expect(data.entrance_pupil.diameter_mm, "EPD");
  expect(data.exit_pupil.position_mm, "XPL_from_image");
  expect(data.exit_pupil.diameter_mm, "XPD");
  expect(data.stop_semi_diameter_mm, "stop_radius_paraxial");
  expect(-data.image_space_na, "marginal_u_image");
  expect(-1 / data.petzval_radius_mm, "petzval_sum");
  expect_relative(data.lagrange_invariant_mm, reference["seidel"]["lagrange_H"], reference_precision);
  // A small difference of two distances: absolute.
  EXPECT_NEAR(data.paraxial_image_mm - lens.surfaces.back().thickness_mm,
              figures["parax_image_from_image_surface"], reference_precision);
}

TEST_P(IndependentTracer, AgreesAtEveryWavelength) {
  const auto [name, file] = GetParam();
  const Lens lens = read_lens(name).lens;
  const auto reference = nlohmann::json::parse(read_whole_file(std::string(PETZVAL_TEST_DATA "/") + file));
  const auto& rows = reference["first_order_per_wavelength"];
  ASSERT_EQ(rows.size(), lens.wavelengths_nm.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const FirstOrder data = first_order(lens, lens.wavelengths_nm[i]);
    expect_relative(data.efl_mm, rows[i]["EFL"], reference_precision);
    expect_relative(data.bfl_mm, rows[i]["BFL"], reference_precision);
    expect_relative(data.entrance_pupil.position_mm, rows[i]["EPL"], reference_precision);
    expect_relative(data.exit_pupil.position_mm, rows[i]["XPL_from_image"], reference_precision);
  }
}

INSTANTIATE_TEST_SUITE_P(Lenses, IndependentTracer,
                         ::testing::Values(std::pair("cooke-triplet", "cooke_triplet_f5.ref.json"),
                                           std::pair("double-gauss", "double_gauss_f5.ref.json")),
                         [](const auto& lens) { return lens.index == 0 ? "CookeTriplet" : "DoubleGauss"; });

/// Indices that the independent tracer used, at 480, 550 and 650 nm and at F', d and C'.
TEST(ReferenceGlass, IndicesAreThoseOfTheReference) {
  const auto expect_indices = [](const Lens& lens, std::size_t surface, std::array<double, 3> indices) {
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(lens.surfaces[surface].material.index(lens.wavelengths_nm[i]), indices[i], 1e-9);
  };
  const Lens triplet = read_lens("cooke-triplet").lens;
  expect_indices(triplet, 0, {1.6281511974045395, 1.6226085614386923, 1.6175242213709868});
  expect_indices(triplet, 2, {1.6330991998924538, 1.623655122927604, 1.6154224628432312});
  const Lens gauss = read_lens("double-gauss").lens;
  expect_indices(gauss, 0, {1.630451679115254, 1.622293795924426, 1.6187706069472942});
  expect_indices(gauss, 2, {1.6148570659636294, 1.6073809696996346, 1.604135445245278});
  expect_indices(gauss, 3, {1.6146122610758453, 1.6034202574072252, 1.5987452734273884});
  expect_indices(gauss, 9, {1.6275563487810216, 1.6204099650808939, 1.6172716598778425});
}

/// The figures that Zemax wrote into EO54852.ZMX and its ISET export. They were made with the glass catalogue
/// of that day; other coefficients for the same glasses move the sixth digit.
TEST(EdmundLens, AgreesWithTheVendorsFile) {
  constexpr double glass_precision = 2e-5;
  const FirstOrder data = first_order(read_lens("edmund-54852").lens);
  expect_relative(data.efl_mm, 5.999968, glass_precision);
  expect_relative(data.magnification, -0.023954, glass_precision);
  expect_relative(data.entrance_pupil.position_mm, 4.057947626272, glass_precision);
  expect_relative(data.entrance_pupil.diameter_mm, 3.380941613388, glass_precision);
  expect_relative(data.f_number, 1.774644, glass_precision);
  expect_relative(data.working_f_number, 1.8, paraxial_precision);
  // The rim of the stop in the file is where the marginal ray passes.
  expect_relative(data.stop_semi_diameter_mm, 1.572530251, glass_precision);
}

}  // namespace
}  // namespace petzval
