// SPDX-License-Identifier: BSD-3-Clause
// What a valid lens is.
#include <cmath>

#include "sample_lenses.h"

namespace petzval {
namespace {

using namespace testing;

Lens valid() {
  return lens_of({stop_surface(3), surface(50, 4, 1.5), surface(-50, 40)});
}

/// The complaint about a lens after `spoil`.
std::string complaint(const std::function<void(Lens&)>& spoil) {
  Lens lens = valid();
  spoil(lens);
  return error_of([&] { lens.validate(); });
}

TEST(Lens, MeasuresItself) {
  EXPECT_NO_THROW(valid().validate());
  EXPECT_EQ(valid().stop_index(), 0u);
  EXPECT_EQ(valid().total_track_mm(), 47);
  EXPECT_TRUE(is_flat(valid().surfaces[0]));
  Surface plate;
  plate.asphere = {{4, 1e-5}};
  EXPECT_FALSE(is_flat(plate));
  const Lens empty;
  EXPECT_EQ(empty.total_track_mm(), 0);
  expect_mentions(error_of([&] { empty.stop_index(); }), {"no stop"});
}

TEST(Lens, NamesWhatIsWrong) {
  const double nan = std::nan("");
  expect_mentions(complaint([](Lens& l) { l.surfaces.clear(); }), {"surfaces is empty"});
  expect_mentions(complaint([](Lens& l) { l.surfaces[0].stop = false; }), {"surfaces has no stop"});
  expect_mentions(complaint([](Lens& l) { l.surfaces[2].stop = true; }), {"surfaces[2].stop", "surfaces[0]"});
  expect_mentions(complaint([](Lens& l) { l.surfaces.resize(20'000); }),
                  {"surfaces has 20000 entries", "10000"});
  expect_mentions(complaint([&](Lens& l) { l.surfaces[1].curvature_per_mm = nan; }),
                  {"surfaces[1].radius_mm must be"});
  expect_mentions(complaint([](Lens& l) { l.surfaces[1].curvature_per_mm = 1e-320; }),
                  {"surfaces[1].radius_mm"});
  expect_mentions(complaint([](Lens& l) { l.surfaces[1].thickness_mm = infinity; }),
                  {"surfaces[1].thickness_mm must be"});
  expect_mentions(complaint([](Lens& l) { l.surfaces[1].semi_diameter_mm = 0; }),
                  {"surfaces[1].semi_diameter_mm"});
  expect_mentions(complaint([&](Lens& l) { l.surfaces[1].conic = nan; }), {"surfaces[1].conic"});
  expect_mentions(complaint([](Lens& l) { l.surfaces[1].asphere[0] = 1; }),
                  {"surfaces[1].asphere.0", "1 to 40"});
  expect_mentions(complaint([](Lens& l) { l.surfaces[1].asphere[41] = 1; }), {"surfaces[1].asphere.41"});
  expect_mentions(complaint([](Lens& l) { l.surfaces[1].asphere[4] = infinity; }), {"surfaces[1].asphere.4"});
  expect_mentions(complaint([](Lens& l) { l.object_distance_mm = 0; }),
                  {"object_distance_mm must be positive"});
  expect_mentions(complaint([&](Lens& l) { l.aperture.value = nan; }), {"aperture must be a positive"});
  expect_mentions(complaint([](Lens& l) { l.aperture.kind = Aperture::Kind::object_na; }),
                  {"aperture", "object_distance_mm"});
  expect_mentions(complaint([](Lens& l) {
                    l.object_distance_mm = 10;
                    l.aperture = {Aperture::Kind::object_na, 1};
                  }),
                  {"object_na must be below 1"});
  expect_mentions(complaint([](Lens& l) { l.fields.values.clear(); }), {"fields.values is empty"});
  expect_mentions(complaint([&](Lens& l) { l.fields.values = {0, nan}; }), {"fields.values[1]"});
  expect_mentions(complaint([](Lens& l) {
                    l.object_distance_mm = 10;
                    l.fields.values = {90};
                  }),
                  {"fields.values[0] must be an angle below 90"});
  expect_mentions(complaint([](Lens& l) { l.wavelengths_nm.clear(); }), {"wavelengths_nm is empty"});
  expect_mentions(complaint([](Lens& l) { l.wavelengths_nm = {500, 0}; }), {"wavelengths_nm[1]"});
  expect_mentions(complaint([](Lens& l) { l.reference_wavelength_nm = -1; }), {"reference_wavelength_nm"});
}

}  // namespace
}  // namespace petzval
