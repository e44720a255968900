// SPDX-License-Identifier: BSD-3-Clause
#include <lcms2.h>
#include <petzval/base/error.h>
#include <petzval/colour/rec2100.h>
#include <petzval/isp/colour_rendering.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace petzval {

namespace {

using Profile = std::unique_ptr<void, decltype(&cmsCloseProfile)>;
using Curve = std::unique_ptr<cmsToneCurve, decltype(&cmsFreeToneCurve)>;

void set_text(const Profile& profile, cmsTagSignature tag, const char* text) {
  cmsMLU* const words = cmsMLUalloc(nullptr, 1);
  cmsMLUsetASCII(words, "en", "US", text);
  cmsWriteTag(profile.get(), tag, words);
  cmsMLUfree(words);
}

struct Primaries {
  const char* name;
  cmsCIExyYTRIPLE xy;
};

const Primaries& primaries_of(DisplaySpace space) {
  static const Primaries srgb{"sRGB", {{0.64, 0.33, 1}, {0.30, 0.60, 1}, {0.15, 0.06, 1}}},
      display_p3{"Display P3", {{0.680, 0.320, 1}, {0.265, 0.690, 1}, {0.150, 0.060, 1}}},
      rec2100_pq{"Rec. 2100 PQ", {{0.708, 0.292, 1}, {0.170, 0.797, 1}, {0.131, 0.046, 1}}};
  if (space == DisplaySpace::srgb) return srgb;
  return space == DisplaySpace::display_p3 ? display_p3 : rec2100_pq;
}

/// Of its peak, in 4096 steps: in a PNG the chunk cICP says it exactly.
cmsToneCurve* pq_curve() {
  constexpr int steps = 4096;
  std::vector<cmsUInt16Number> table;
  for (int i = 0; i < steps; ++i)
    table.push_back(
        static_cast<cmsUInt16Number>(65535 * pq_decoded(double(i) / (steps - 1)) / pq_decoded(1) + 0.5));
  return cmsBuildTabulatedToneCurve16(nullptr, steps, table.data());
}

}  // namespace

std::string icc_profile(DisplaySpace space) {
  const cmsCIExyY white{0.3127, 0.3290, 1};
  const Primaries& of_space = primaries_of(space);
  // The transfer curve of sRGB: Y = (aX + b)^g above d, cX below.
  const cmsFloat64Number curve[] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
  const Curve line(
      space == DisplaySpace::rec2100_pq ? pq_curve() : cmsBuildParametricToneCurve(nullptr, 4, curve),
      cmsFreeToneCurve);
  cmsToneCurve* const lines[] = {line.get(), line.get(), line.get()};
  const Profile profile(cmsCreateRGBProfile(&white, &of_space.xy, lines), cmsCloseProfile);
  if (!line || !profile) throw Failure("a colour profile could not be made");
  cmsSetProfileVersion(profile.get(), 4.2);
  set_text(profile, cmsSigProfileDescriptionTag, of_space.name);
  set_text(profile, cmsSigCopyrightTag, "no copyright: figures of public standards");
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile.get(), nullptr, &size);
  std::string bytes(size, '\0');
  if (size == 0 || !cmsSaveProfileToMem(profile.get(), bytes.data(), &size))
    throw Failure("a colour profile could not be made");
  // The date, year first: there must be one, but never today's, so that the same picture has the same bytes.
  constexpr std::size_t date = 24;
  const std::string first_of_2026{"\x07\xEA\0\1\0\1\0\0\0\0\0\0", 12};
  std::copy(first_of_2026.begin(), first_of_2026.end(), bytes.begin() + date);
  return bytes;
}

}  // namespace petzval
