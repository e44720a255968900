// SPDX-License-Identifier: BSD-3-Clause
// Listings and parameters as Zemax and ISET's macros write them: our own, and originals where they are at
// hand.
#include <gtest/gtest.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/optics/formats/isetparms.h>
#include <petzval/optics/formats/psf_listing.h>

#include <filesystem>

#include "analytic_table.h"

namespace petzval {
namespace {

/// Files that may not be part of the repository lie beside the checkout, if anywhere.
std::string original(const std::string& name) {
  return data_directory() + "/../../shared/data/iset/" + name;
}

TEST(PsfListing, OfZemaxIsRead) {
  const std::string path = original("AsphereF=2mm_PSF_21_3.dat");
  if (!std::filesystem::exists(path))
    GTEST_SKIP() << "no " << path << ": our own listings are read in cli tests";
  const PsfListing listing = read_psf_listing(read_whole_file(path), path);
  EXPECT_EQ(listing.grid.rows, 128);
  EXPECT_EQ(listing.grid.columns, 128);
  EXPECT_EQ(listing.spacing_um, 0.25);
  EXPECT_EQ(listing.centre_row, 64);
  EXPECT_EQ(listing.centre_column, 64);
  ASSERT_TRUE(listing.image_point_mm);
  EXPECT_EQ(listing.image_point_mm->second, -0.959263593);
  // As an editor shows it: the brightest value is the Strehl ratio of the heading, six rows above the chief
  // ray.
  EXPECT_EQ(listing.grid.at(58, 64), 0.486);
  EXPECT_EQ(listing.grid.at(0, 0), 3.214e-4);
  EXPECT_EQ(listing.grid.at(0, 1), 3.206e-4);
  // A centred lens: the same on both sides of the tangential plane, which runs from top to bottom here.
  const auto mirror = find_mirror(std::span(&listing.grid, 1));
  ASSERT_TRUE(mirror);
  EXPECT_TRUE(mirror->upright);
  EXPECT_EQ(mirror->centre, 64);
}

TEST(IsetParameters, OfTheMacroAreRead) {
  const std::string path = original("ISETPARMS.TXT");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path << ": our own are read in cli tests";
  const IsetParameters parameters = read_isetparms(read_whole_file(path), path);
  EXPECT_EQ(parameters.base_name, "EO54852");
  EXPECT_EQ(parameters.psf_size, 128);
  EXPECT_EQ(parameters.psf_spacing_um, 0.25);
  EXPECT_EQ(parameters.data.lens_file, "EO54852.ZMX");
  EXPECT_EQ(parameters.data.wavelengths_nm, (std::vector<double>{400, 450, 500, 550, 600, 650, 700}));
  EXPECT_EQ(parameters.data.field_height_mm.size(), 13U);
  EXPECT_EQ(parameters.data.field_height_mm[4], 1.0);
  EXPECT_EQ(parameters.data.object_distance_mm, 250);
  EXPECT_EQ(parameters.data.magnification, -0.023954);
  EXPECT_EQ(parameters.data.effective_focal_length_mm, 5.999968);
  EXPECT_EQ(parameters.data.f_number, 1.774644);
  EXPECT_EQ(parameters.data.effective_f_number, 1.780820);
  EXPECT_EQ(parameters.data.field_of_view_deg, 2 * 26.198448);
}

TEST(IsetParameters, UnderstandMatlab) {
  const IsetParameters parameters = read_isetparms(
      "lensFile='a%b;c.len'; psfSize = 32 % samples\nwave = [ 450, 550; 650 ], imgHeight=0 : 0.5 : 1.5\n"
      "baseLensFileName='D:\\x\\y.z'\nobjDist=Inf;mag=0\nefl=+8.0E+000\n",
      "text");
  EXPECT_EQ(parameters.data.lens_file, "a%b;c.len");
  EXPECT_EQ(parameters.base_name, "y.z");
  EXPECT_EQ(parameters.psf_size, 32);
  EXPECT_EQ(parameters.data.wavelengths_nm, (std::vector<double>{450, 550, 650}));
  EXPECT_EQ(parameters.data.field_height_mm, (std::vector<double>{0, 0.5, 1, 1.5}));
  EXPECT_TRUE(std::isinf(parameters.data.object_distance_mm));
  EXPECT_EQ(parameters.data.effective_focal_length_mm, 8);
  EXPECT_TRUE(std::isnan(parameters.data.f_number));
}

TEST(PsfListing, KeepsEveryDigit) {
  const Psf psf = testing::comatic_psf(9, 2, 0.123456789);
  const std::string text = psf_listing_text(psf, 10, 550, 1.25, "test");
  const PsfListing listing = read_psf_listing(text, "text");
  const Psf back = psf_of_grid(listing.grid, listing_frame(10), listing.spacing_um);
  EXPECT_EQ(back.spacing_um, psf.spacing_um);
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j)
      EXPECT_EQ(back.at(i - psf.size / 2 + back.size / 2, j - psf.size / 2 + back.size / 2), psf.at(i, j));
  // Cut within its last number a listing is whole, with another number.
  const std::size_t last = text.find_last_of("\t");
  for (std::size_t size = 0; size <= last; size += 7)
    EXPECT_THROW(read_psf_listing(text.substr(0, size), "text"), InputError) << size;
}

}  // namespace
}  // namespace petzval
