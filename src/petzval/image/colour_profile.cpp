// SPDX-License-Identifier: BSD-3-Clause
#include <lcms2.h>
#include <petzval/base/error.h>
#include <petzval/image/colour_profile.h>

namespace petzval {

namespace {

struct CloseProfile {
  void operator()(void* profile) const { cmsCloseProfile(profile); }
};
using Profile = std::unique_ptr<void, CloseProfile>;

/// sRGB's primaries and white without its transfer curve.
Profile linear_srgb_profile() {
  const cmsCIExyY white{0.3127, 0.3290, 1};
  const cmsCIExyYTRIPLE primaries{{0.64, 0.33, 1}, {0.30, 0.60, 1}, {0.15, 0.06, 1}};
  cmsToneCurve* const line = cmsBuildGamma(nullptr, 1);
  if (line == nullptr) throw Failure("no memory for a colour profile");
  cmsToneCurve* const lines[] = {line, line, line};
  Profile profile(cmsCreateRGBProfile(&white, &primaries, lines));
  cmsFreeToneCurve(line);
  return profile;
}

}  // namespace

struct ProfileToLinear::State {
  cmsHTRANSFORM transform;
  std::size_t channels;
};

ProfileToLinear::ProfileToLinear(const std::string& profile, const std::string& file) {
  const Profile from(cmsOpenProfileFromMem(profile.data(), static_cast<cmsUInt32Number>(profile.size())));
  if (!from)
    throw InputError(file, "has a damaged colour profile; `scene.encoding` srgb takes its numbers as sRGB");
  const cmsColorSpaceSignature space = cmsGetColorSpace(from.get());
  if (space != cmsSigGrayData && space != cmsSigRgbData)
    throw InputError(file,
                     "has a colour profile for neither grey nor RGB; `scene.encoding` srgb takes its "
                     "numbers as sRGB");
  const std::size_t channels = space == cmsSigGrayData ? 1 : 3;
  const Profile to = linear_srgb_profile();
  const cmsHTRANSFORM transform =
      cmsCreateTransform(from.get(), channels == 1 ? TYPE_GRAY_FLT : TYPE_RGB_FLT, to.get(), TYPE_RGB_FLT,
                         INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOCACHE | cmsFLAGS_NOOPTIMIZE);
  if (transform == nullptr)
    throw InputError(file,
                     "has a colour profile that cannot be used; `scene.encoding` srgb takes its numbers "
                     "as sRGB");
  state_ = std::make_unique<State>(State{transform, channels});
}

ProfileToLinear::~ProfileToLinear() {
  if (state_) cmsDeleteTransform(state_->transform);
}

ProfileToLinear::ProfileToLinear(ProfileToLinear&&) noexcept = default;

std::size_t ProfileToLinear::channels() const {
  return state_->channels;
}

void ProfileToLinear::operator()(std::span<const float> stored, std::span<float> rgb) const {
  cmsDoTransform(state_->transform, stored.data(), rgb.data(),
                 static_cast<cmsUInt32Number>(stored.size() / state_->channels));
}

}  // namespace petzval
