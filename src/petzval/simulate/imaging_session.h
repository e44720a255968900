// SPDX-License-Identifier: BSD-3-Clause
// Many pictures of one flat scene, each through another camera.
#pragma once

#include <petzval/simulate/image.h>

#include <memory>

namespace petzval {

/// Images one scene through one camera after the other, and keeps what an alteration leaves valid: the scene
/// as it was read or drawn, how fine its detail is, the lens data table of the last lens, the last image.
/// What comes of it has the bytes of image().
///
///     ImagingSession session(SceneRequest{.name = "studio"});
///     for (const double gap_mm : {6.0, 6.5, 7.0}) {
///       camera.lens.surfaces[4].thickness_mm = gap_mm;
///       const SpectralImage light = session.image(camera);
///     }
///
/// Not to be used by two threads at a time.
class ImagingSession {
 public:
  explicit ImagingSession(SceneRequest scene, ImageOptions options = {});
  /// A scene in memory, which is taken as it is.
  explicit ImagingSession(Scene scene, ImageOptions options = {});
  ~ImagingSession();
  ImagingSession(ImagingSession&&) noexcept;
  ImagingSession& operator=(ImagingSession&&) noexcept;

  /// As petzval::image(). A scene's file that was altered since is not read again. \param report  may be
  /// null. \throws InputError; Cancelled, after which the session may be used as before.
  SpectralImage image(Optics optics, const Context& context = {}, ImageReport* report = nullptr);

  /// How often it has read a scene, made a table of a lens, and formed an image.
  struct Work {
    int scenes_read = 0, tables_made = 0, images_formed = 0;
  };
  const Work& work() const;

 private:
  struct Kept;
  std::unique_ptr<Kept> kept_;
};

}  // namespace petzval
