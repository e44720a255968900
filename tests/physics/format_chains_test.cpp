// SPDX-License-Identifier: BSD-3-Clause
// A lens that goes through any chain of the file formats that can hold it traces the same rays.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/glass/catalogue.h>
#include <petzval/lens/formats/iset.h>
#include <petzval/lens/formats/native.h>
#include <petzval/lens/formats/pbrt.h>
#include <petzval/lens/formats/seq.h>
#include <petzval/lens/formats/zmx.h>
#include <petzval/trace/tracer.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace petzval {
namespace {

struct Format {
  const char* name;
  std::string (*write)(const Lens&);
  Lens (*read)(const std::string&);
};

const std::array<Format, 5> formats{{
    {"native", lens_to_json, [](const std::string& text) { return lens_from_json(text, "a.json"); }},
    {"zmx", zmx_text, [](const std::string& text) { return read_zmx(text, "a.zmx", {}).lens; }},
    {"seq", seq_text, [](const std::string& text) { return read_seq(text, "a.seq", {}).lens; }},
    {"pbrt", pbrt_text, [](const std::string& text) { return read_pbrt(text, "a.dat").lens; }},
    {"iset", iset_text, [](const std::string& text) { return read_iset(JsonDocument(text, "a.json")).lens; }},
}};

/// Lenses that light gets through: a handful of weak surfaces about a stop, of every kind that some format
/// holds.
class PlausibleLens {
 public:
  explicit PlausibleLens(unsigned seed) : bits_(seed) {}

  Lens operator()() {
    // Rows of numbers hold the plain ones; aspheres, conics and glasses make the others.
    const bool plain = chance(0.5);
    Lens lens;
    lens.name = "plausible";
    lens.wavelengths_nm = plain ? std::vector<double>{486.1327, 587.5618, 656.2725}
                                : std::vector<double>{450 + 10 * uniform(), 550 + 10 * uniform()};
    lens.reference_wavelength_nm = lens.wavelengths_nm[1];
    const std::size_t before = 1 + below(3), after = 1 + below(3);
    for (std::size_t i = 0; i < before; ++i) element(lens, plain);
    Surface& stop = lens.surfaces.emplace_back();
    stop.stop = true;
    stop.thickness_mm = 1 + uniform();
    const double stop_radius_mm = 3 + uniform();
    stop.semi_diameter_mm = stop_radius_mm;
    for (std::size_t i = 0; i < after; ++i) element(lens, plain);
    lens.surfaces.back().thickness_mm = 40 + 10 * uniform();
    // A row of numbers is open to the rim of its stop; CODE V wants an entrance pupil or an f-number.
    if (plain && chance(0.7))
      lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, stop_radius_mm};
    else
      lens.aperture = {Aperture::Kind::entrance_pupil_diameter_mm, 4 + uniform()};
    lens.fields = {Fields::Kind::angle_deg, {0, 5 * uniform()}};
    return lens;
  }

  std::size_t below(std::size_t count) { return bits_() % count; }
  double uniform() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }

 private:
  bool chance(double probability) { return uniform() < probability; }
  double curvature() { return (chance(0.5) ? 1 : -1) * (0.005 + 0.02 * uniform()); }

  Material material(bool plain) {
    static const char* const glasses[] = {"SCHOTT:N-BK7", "SCHOTT:F2", "OHARA:S-LAH66", "CDGM:H-K9L",
                                          "HOYA:FCD1"};
    if (plain) return Material(Material::Constant{1.4 + 0.4 * uniform()});
    if (chance(0.6)) return Material(GlassCatalogue::bundled().find(glasses[below(std::size(glasses))]));
    if (chance(0.7)) return Material(Material::Model{1.45 + 0.4 * uniform(), 25 + 50 * uniform()});
    return Material(Material::Table{{400, 1.62 + 0.01 * uniform()}, {500, 1.61}, {700, 1.6}});
  }

  void element(Lens& lens, bool plain) {
    for (int side = 0; side < 2; ++side) {
      Surface& surface = lens.surfaces.emplace_back();
      surface.curvature_per_mm = curvature();
      surface.thickness_mm = side == 0 ? 2 + uniform() : 0.5 + uniform();
      if (side == 0) surface.material = material(plain);
      if (plain || chance(0.7)) surface.semi_diameter_mm = 5 + 3 * uniform();
      if (!plain && chance(0.3)) surface.conic = uniform() - 0.5;
      if (!plain && chance(0.3))
        for (int power = 3, step = chance(0.5) ? 1 : 2; power <= 20; power += power % 2 ? 1 : step)
          if (chance(0.4)) surface.asphere[power] = (uniform() - 0.5) * std::pow(10, -power);
    }
  }

  std::mt19937_64 bits_;
};

void expect_same_rays(const Lens& lens, const Lens& again, PlausibleLens& random) {
  constexpr double tolerance = 1e-12;  // asked for: "the same rays to 1e-12"; lengths are some 10 mm
  constexpr double no_stop = std::numeric_limits<double>::infinity();
  for (const double wavelength_nm : lens.wavelengths_nm) {
    const Tracer before(lens, wavelength_nm, no_stop), after(again, wavelength_nm, no_stop);
    for (int i = 0; i < 6; ++i) {
      const double angle = 0.1 * random.uniform();
      const Ray start{{4 * random.uniform() - 2, 6 * random.uniform() - 3, -1},
                      {0, std::sin(angle), std::cos(angle)}};
      const Ray a = before.trace(start), b = after.trace(start);
      ASSERT_EQ(a.status, b.status);
      if (a.status != RayStatus::ok) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(a.point_mm[axis], b.point_mm[axis], tolerance);
        EXPECT_NEAR(a.direction[axis], b.direction[axis], tolerance);
      }
      EXPECT_NEAR(a.opl_mm, b.opl_mm, tolerance);
    }
    EXPECT_NEAR(stop_radius_mm(lens), stop_radius_mm(again), tolerance);
  }
}

TEST(FormatChains, TraceTheSameRays) {
  PlausibleLens random(3);
  std::array<int, formats.size()> passed{}, refused{};
  for (int trial = 0; trial < 400; ++trial) {
    const Lens lens = random();
    Lens now = lens;
    std::string chain;
    for (std::size_t step = 2 + random.below(4); step > 0; --step) {
      const std::size_t which = random.below(formats.size());
      std::string text;
      try {
        text = formats[which].write(now);
      } catch (const InputError&) {
        ++refused[which];
        continue;
      }
      now = formats[which].read(text);
      chain += std::string(" ") + formats[which].name;
      ++passed[which];
    }
    SCOPED_TRACE("trial " + std::to_string(trial) + ":" + chain);
    expect_same_rays(lens, now, random);
    if (HasFailure()) return;
  }
  // Every format has held lenses, and those that do not hold everything have said so.
  for (std::size_t i = 0; i < formats.size(); ++i) EXPECT_GT(passed[i], 50) << formats[i].name;
  EXPECT_EQ(refused[0], 0);
  EXPECT_GT(refused[3], 50);
}

}  // namespace
}  // namespace petzval
