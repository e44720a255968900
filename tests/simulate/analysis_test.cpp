// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/simulate/analysis.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace petzval {
namespace {

std::vector<double> column(const Table& table, const std::string& key) {
  std::vector<double> values;
  const auto found = std::find_if(table.columns.begin(), table.columns.end(),
                                  [&](const TableColumn& each) { return each.key == key; });
  if (found == table.columns.end()) throw std::out_of_range(key);
  const auto at = static_cast<std::size_t>(found - table.columns.begin());
  for (const auto& row : table.rows) values.push_back(std::get<double>(row[at]));
  return values;
}

AnalysisRequest request(std::vector<double> fields) {
  AnalysisRequest request;
  request.at.fields = std::move(fields);
  request.at.wavelengths_nm = {550};
  return request;
}

// Programs find columns by their keys: each must have one, and its own.
TEST(Analysis, GivesTablesThatProgramsCanRead) {
  const Lens lens = read_lens("cooke-triplet").lens;
  AnalysisRequest asked = request({0, 14});
  asked.plots = true;
  asked.map_samples = 9;
  for (const Analysis& analysis : analyses()) {
    const AnalysisResult result = analyse(analysis.name, lens, asked);
    EXPECT_FALSE(result.plots.empty()) << analysis.name;
    EXPECT_FALSE(result.rows().rows.empty()) << analysis.name;
    for (const AnalysisTable& each : result.tables) {
      EXPECT_NO_THROW(each.table.validate()) << analysis.name;
      std::set<std::string> keys;
      for (const TableColumn& column : each.table.columns) {
        EXPECT_FALSE(column.key.empty()) << analysis.name << ": " << column.name;
        EXPECT_TRUE(keys.insert(column.key).second) << analysis.name << ": " << column.key;
      }
    }
  }
}

TEST(Analysis, RefusesLensesThatAreNone) {
  Lens lens = read_lens("cooke-triplet").lens;
  lens.surfaces[0].stop = true;  // beside the one that it has
  EXPECT_THROW(analyse("spots", lens), InputError);
  lens.surfaces[0].stop = false;
  lens.surfaces[0].curvature_per_mm = std::nan("");
  try {
    analyse("spots", lens);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("surfaces[0].radius_mm"), std::string::npos) << error.what();
  }
}

TEST(Analysis, NamesThoseThatThereAre) {
  try {
    analyse("sopts", read_lens("cooke-triplet").lens);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("spots"), std::string::npos) << error.what();
  }
}

// What every lens does whatever its design: no light is lost at frequency zero, illumination is relative to
// the axis, distortion is zero there (both to the four digits that are printed), and circles hold more light
// the wider they are.
TEST(Analysis, KeepsTheLawsOfLight) {
  Lens lens = read_lens("double-gauss").lens;
  AnalysisRequest asked = request({0, 7});
  const double wavelength_nm = lens.reference_wavelength_nm;
  asked.at.wavelengths_nm = {wavelength_nm};
  asked.mtf.frequencies_cpmm = {0};
  for (const char* direction : {"tangential", "sagittal"})
    for (const double value : column(analyse("mtf", lens, asked).rows(), direction))
      EXPECT_NEAR(value, 1, 1e-12) << direction;
  EXPECT_DOUBLE_EQ(column(analyse("illumination", lens, asked).rows(), "relative_illumination")[0], 1);
  // Near the axis a lens draws f·tan θ where its paraxial image is, and elsewhere as the chief ray's slope
  // has it.
  const auto on_axis = [&] {
    return column(analyse("distortion", lens, asked).rows(), "paraxial_distortion_percent")[0];
  };
  double& gap_mm = lens.surfaces.back().thickness_mm;
  gap_mm = first_order(lens, wavelength_nm).paraxial_image_mm;
  EXPECT_NEAR(on_axis(), 0, 1e-10);
  const double pupil_to_image_mm = -first_order(lens, wavelength_nm).exit_pupil.position_mm;
  gap_mm += 0.05;
  EXPECT_NEAR(on_axis(), 100 * 0.05 / pupil_to_image_mm, 1e-10);
  asked.encircled_energy.radii_um = {2, 5, 10};
  const std::vector<double> shares =
      column(analyse("encircled-energy", lens, asked).rows(), "encircled_energy");
  ASSERT_EQ(shares.size(), 6U);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.begin() + 3));
  EXPECT_TRUE(std::is_sorted(shares.begin() + 3, shares.end()));
  EXPECT_LT(shares[5], 1);
}

// Maréchal: the Strehl ratio is exp(−(2πσ)²) as long as the RMS wavefront σ is small.
TEST(Analysis, AgreesWithMarechalWhereTheWaveIsNearlyPerfect) {
  Lens lens = read_lens("double-gauss").lens;
  for (Surface& surface : lens.surfaces) surface.semi_diameter_mm.reset();
  lens.aperture = {Aperture::Kind::f_number, 16};
  const Table rows = analyse("wavefront", lens, request({0})).rows();
  const double rms = column(rows, "rms_waves")[0];
  EXPECT_LT(rms, 0.1);
  EXPECT_GT(rms, 0.001);
  EXPECT_NEAR(column(rows, "strehl")[0], std::exp(-std::pow(2 * M_PI * rms, 2)), 1e-4);
}

TEST(Analysis, TakesTheLensesOwnFieldsAndWavelengths) {
  const Lens lens = read_lens("cooke-triplet").lens;
  EXPECT_EQ(analyse("spots", lens).rows().rows.size(),
            lens.fields.values.size() * lens.wavelengths_nm.size());
}

TEST(Analysis, StopsWhenToldTo) {
  Context context;
  context.progress = [](double, const std::string&) { return false; };
  EXPECT_THROW(analyse("encircled-energy", read_lens("cooke-triplet").lens, {}, context), Cancelled);
}

}  // namespace
}  // namespace petzval
