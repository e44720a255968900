// SPDX-License-Identifier: BSD-3-Clause
// The bundled lenses, and the files that their numbers come from.
#include "sample_lenses.h"

#include <petzval/base/data_directory.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/whole_file.h>
#include <petzval/lens/first_order.h>

#include <cstdlib>
#include <filesystem>
#include <set>

namespace petzval {
namespace {

using namespace testing;

TEST(BundledLenses, AllAreLensesWithASource) {
  const std::vector<std::string> names = bundled_names("lenses", ".json");
  EXPECT_GE(names.size(), 13u);
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    const LensFile file = read_lens(name);
    EXPECT_TRUE(file.notes.empty());
    EXPECT_FALSE(file.lens.name.empty());
    EXPECT_GT(file.lens.source.size(), 20u);
    EXPECT_TRUE(std::isfinite(first_order(file.lens).efl_mm));
    for (const double wavelength_nm : file.lens.wavelengths_nm) first_order(file.lens, wavelength_nm);
  }
}

/// Focal lengths that the books give; designs are scaled from 100 mm and rounded, to 2 % at most.
TEST(BundledLenses, FocalLengthsAreThoseOfTheBook) {
  const std::pair<const char*, double> book[] = {
      {"dgauss-50mm", 50},   {"wide-22mm", 22},       {"telephoto-250mm", 250},
      {"fisheye-10mm", 10},  {"dgauss-12.5mm", 12.5}, {"tessar", 100},
      {"petzval-lens", 100}, {"cooke-triplet", 50},   {"double-gauss", 100}};
  for (const auto& [name, focal_length_mm] : book)
    expect_relative(first_order(read_lens(name).lens).efl_mm, focal_length_mm, 0.02);
}

/// What another program's paraxial trace of the patent's example 1 gives (LensVisualizer: EFL, and BFD behind
/// the last surface, with the filter), to the digits that it prints.
TEST(BundledLenses, Fisheye220IsThePatents) {
  const FirstOrder data = first_order(read_lens("us-3524697").lens);
  EXPECT_NEAR(data.efl_mm, 10.004615486, 5e-9);
  EXPECT_NEAR(data.bfl_mm, 17.860390, 5e-7);
  EXPECT_NEAR(data.petzval_radius_mm, 1 / 0.0066325, 150 * 1e-4);
}

/// The patent claims a reduction of 1/4 with a flat field, and its designer put the image at the paraxial
/// focus.
TEST(BundledLenses, ProjectionLensReducesFourTimes) {
  const FirstOrder data = first_order(read_lens("us-5831776").lens);
  expect_relative(data.magnification, -0.25, 1e-3);
  // The field is flat to a micrometre in the 12 mm of the image.
  EXPECT_LT(12.0 * 12.0 / std::abs(2 * data.petzval_radius_mm), 1e-3);
  EXPECT_NEAR(data.paraxial_image_mm, 13.0764789603, 0.01);
}

/// Lenses to teach with have laws, not books: each file's source says what was solved for.
TEST(BundledLenses, TeachingLensesKeepTheirLaws) {
  for (const char* name :
       {"plano-convex", "plano-convex-reversed", "coma-singlet", "achromat-50mm", "landscape-lens"})
    expect_relative(first_order(read_lens(name).lens).efl_mm, 50, 1e-6);
  const Lens achromat = read_lens("achromat-50mm").lens;
  EXPECT_NEAR(first_order(achromat, 486.1327).bfl_mm, first_order(achromat, 656.2725).bfl_mm, 1e-4);
  // A hyperboloid of conic −n² has no spherical aberration for parallel rays inside the glass (Descartes).
  const Lens coma = read_lens("coma-singlet").lens;
  const double n = coma.surfaces[0].material.index(coma.reference_wavelength_nm);
  expect_relative(coma.surfaces[1].conic, -n * n, 1e-8);
}

/// Machine vision names its lenses by focal length; two groups with a common focus have no power but a scale,
/// that of their focal lengths.
TEST(BundledLenses, MachineVisionLensesAreWhatTheyAreCalled) {
  const std::pair<const char*, double> lenses[] = {
      {"cmount-8mm", 8.5}, {"cmount-12mm", 12}, {"cmount-16mm", 16}, {"cmount-25mm", 25},
      {"cmount-35mm", 35}, {"cmount-50mm", 50}, {"m12-4mm", 4},      {"m12-2mm-fisheye", 1.9},
      {"m12-8mm", 8},      {"m12-12mm", 12}};
  for (const auto& [name, focal_length_mm] : lenses)
    expect_relative(first_order(read_lens(name).lens).efl_mm, focal_length_mm, 1e-4);
  expect_relative(first_order(read_lens("telecentric-0.5x").lens).magnification, -0.5, 1e-5);
  expect_relative(first_order(read_lens("telecentric-0.25x").lens).magnification, -0.25, 1e-5);
}

/// Lens files as they were published; see data/lenses/README.md. The folder stands beside the checkout or
/// nowhere.
class PublishedFile : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

std::string published_folder() {
  if (const char* folder = std::getenv("PETZVAL_PUBLISHED_DATA")) return folder;
  return data_directory() + "/../../shared/data";
}

TEST_P(PublishedFile, IsTheBundledLens) {
  const auto [name, file] = GetParam();
  const std::string path = published_folder() + "/lenses/" + file;
  if (!std::filesystem::exists(path))
    GTEST_SKIP() << path << " is not here: the published files are not part of Petzval";
  LensReadOptions options;
  options.substitutions = {{"LAK10C", "CDGM:H-LAK10"}, {"LAF1C", "CDGM:H-LAF1"}, {"ZF7C", "CDGM:ZF7"},
                           {"ZK9C", "CDGM:H-ZK9A"},    {"LAK1C", "CDGM:H-LAK1"}, {"SSK4", "1.61765/55.14"},
                           {"SK1", "1.61025/56.71"},   {"F15", "1.60565/37.83"}, {"SK16", "HIKARI:SK16"}};
  const std::string text = decoded_text(read_whole_file(path));
  std::erase_if(options.substitutions,
                [&](const auto& pair) { return text.find(" " + pair.first + " ") == text.npos; });
  const Lens original = read_lens(path, options).lens, bundled = read_lens(name).lens;
  // The bundled file leaves out digits that are artefacts of 32-bit numbers, or beyond the printed
  // curvatures.
  const double precision = std::string(name) == "dgauss-12.5mm" ? 1e-6 : 1e-12;
  ASSERT_EQ(original.surfaces.size(), bundled.surfaces.size());
  EXPECT_EQ(original.object_distance_mm, bundled.object_distance_mm);
  EXPECT_EQ(original.aperture.kind, bundled.aperture.kind);
  EXPECT_EQ(original.wavelengths_nm, bundled.wavelengths_nm);
  expect_relative(bundled.aperture.value, original.aperture.value, precision);
  for (std::size_t i = 0; i < bundled.surfaces.size(); ++i) {
    SCOPED_TRACE("surface " + std::to_string(i));
    const Surface &a = bundled.surfaces[i], &b = original.surfaces[i];
    expect_relative(a.curvature_per_mm, b.curvature_per_mm, precision);
    expect_relative(a.thickness_mm, b.thickness_mm, precision);
    expect_relative(a.material.index(original.reference_wavelength_nm),
                    b.material.index(original.reference_wavelength_nm), precision);
    EXPECT_EQ(a.stop, b.stop);
    EXPECT_EQ(a.conic, b.conic);
    EXPECT_EQ(a.asphere, b.asphere);
    ASSERT_EQ(a.semi_diameter_mm.has_value(), b.semi_diameter_mm.has_value());
    if (a.semi_diameter_mm) expect_relative(*a.semi_diameter_mm, *b.semi_diameter_mm, precision);
  }
}

INSTANTIATE_TEST_SUITE_P(Lenses, PublishedFile,
                         ::testing::Values(std::pair("edmund-54852", "zmx/EO54852.ZMX"),
                                           std::pair("us-2532751", "zmx/US02532751-1.zmx"),
                                           std::pair("us-5831776", "zmx/US05831776-1.zmx"),
                                           std::pair("dgauss-50mm", "pbrt/dgauss.50mm.dat"),
                                           std::pair("wide-22mm", "pbrt/wide.22mm.dat"),
                                           std::pair("telephoto-250mm", "pbrt/telephoto.250mm.dat"),
                                           std::pair("fisheye-10mm", "pbrt/fisheye.10mm.dat"),
                                           std::pair("tessar", "json/tessar-zemax.json"),
                                           std::pair("inverse-telephoto", "json/inversetelephoto-zemax.json"),
                                           std::pair("petzval-lens", "json/petzval-zemax.json"),
                                           std::pair("dgauss-12.5mm", "json/dgauss.22deg.12.5mm.json")),
                         [](const auto& lens) {
                           std::string name = lens.param.first;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return c == '-' || c == '.'; }, '_');
                           return name;
                         });

}  // namespace
}  // namespace petzval
