// SPDX-License-Identifier: BSD-3-Clause
// ISET's lens JSON.
#include "sample_lenses.h"
#include "scratch_file.h"

#include <petzval/lens/first_order.h>

namespace petzval {
namespace {

using namespace testing;

constexpr const char* iset_example = R"({
  "description": " made for this test ", "name": "pair",
  "surfaces": [
    {"ior": 1.5, "radius": 60, "semi_aperture": 10, "thickness": 6},
    {"ior": 1, "radius": -60, "semi_aperture": 10, "thickness": 3},
    {"ior": 0, "radius": 0, "semi_aperture": 7.5, "thickness": 5},
    {"ior": 1.7, "radius": 500, "semi_aperture": 8, "thickness": 1.5},
    {"ior": 1, "radius": -1e5, "semi_aperture": 8, "thickness": 0}
  ],
  "metadata": {"focalLength": 100, "fNumber": 4, "filmdistance": 20}
})";

std::string iset_complaint(const std::string& before, const std::string& after) {
  return error_of([&] { read_text("bad.json", with_change(iset_example, before, after)); });
}

TEST(IsetReader, IsToldByItsContents) {
  const LensFile file = read_text("lens.json", iset_example);
  const Lens& lens = file.lens;
  EXPECT_EQ(lens.name, "pair");
  EXPECT_EQ(lens.source, "made for this test");
  ASSERT_EQ(lens.surfaces.size(), 5u);
  EXPECT_EQ(lens.surfaces[0].material.index(587), 1.5);
  EXPECT_EQ(lens.surfaces[0].semi_diameter_mm, 10);
  EXPECT_EQ(lens.surfaces[0].thickness_mm, 6);
  EXPECT_TRUE(lens.surfaces[1].material.is_air());
  EXPECT_EQ(lens.stop_index(), 2u);
  EXPECT_EQ(lens.aperture.value, 7.5);
  EXPECT_NEAR(trace_paraxial(lens, 1, 0, 587.5618).height_mm.back(), 0, 1e-14);
  ASSERT_EQ(file.notes.size(), 1u);
}

TEST(IsetReader, IsTheSameLensAsItsTwinInRows) {
  const Lens rows =
      read_text("twin.dat", "60 6 1.5 20\n-60 3 1 20\n0 5 0 15\n500 1.5 1.7 16\n-1e5 0 1 16\n").lens;
  expect_same_optics(read_text("lens.json", iset_example).lens, rows);
}

TEST(IsetReader, NamesLineAndPath) {
  expect_mentions(iset_complaint("\"ior\": 1.7", "\"ior\": 0.7"),
                  {"bad.json:7: surfaces[3].ior must be at least 1"});
  expect_mentions(iset_complaint("\"radius\": 500", "\"radius\": \"500\""),
                  {"bad.json:7: surfaces[3].radius must be"});
  expect_mentions(iset_complaint("\"radius\": 500, ", ""), {"bad.json:7: surfaces[3] has no \"radius\""});
  expect_mentions(iset_complaint("\"radius\": 500", "\"conic_constant\": 1, \"radius\": 500"),
                  {"surfaces[3].conic_constant"});
  expect_mentions(iset_complaint("\"radius\": 500", "\"radius\": 0"),
                  {"bad.json:7: surfaces[3] is a second stop"});
  expect_mentions(iset_complaint("\"ior\": 0, \"radius\": 0", "\"ior\": 1, \"radius\": 9"), {"no stop"});
  expect_mentions(iset_complaint("\"semi_aperture\": 7.5", "\"semi_aperture\": -1"),
                  {"surfaces[2].semi_diameter_mm must be positive"});
  expect_mentions(iset_complaint("\"metadata\"", "\"meta\""), {"bad.json:10: meta is not a key"});
}

TEST(IsetWriter, ReadsBackTheSame) {
  for (const char* name : {"dgauss-50mm", "fisheye-10mm", "telephoto-250mm"}) {
    SCOPED_TRACE(name);
    Lens lens = read_lens(name).lens;
    lens.fields = {};  // rows of numbers hold none
    const Lens again = through_file(lens, "lens.iset.json");
    expect_same_lens(again, lens);
  }
}

TEST(IsetWriter, RefusesWhatItCannotHold) {
  expect_mentions(error_of([] { through_file(read_lens("cooke-triplet").lens, "out.iset.json"); }),
                  {"out.iset.json: surfaces[0]", "an ISET file cannot hold the dispersion"});
}

TEST(IsetWriter, SaysWhatItLeavesOut) {
  ScratchFile file("lens.iset.json");
  const auto notes = write_lens(read_lens("dgauss-50mm").lens, file.path());
  ASSERT_EQ(notes.size(), 1u);
  expect_mentions(notes[0], {"lens.iset.json", "fields", "wavelengths"});
}

}  // namespace
}  // namespace petzval
