// SPDX-License-Identifier: BSD-3-Clause
// What single pixels of a prepared scene's camera see through the middle of its stop.
#pragma once

#include <petzval/render/film/film_sampling.h>
#include <petzval/simulate/prepared_world.h>

#include <memory>
#include <optional>
#include <vector>

namespace petzval {

/// The first surface that a pixel's middle sees.
struct SeenPoint {
  render::Hit hit;
  render::Vector3 at;  ///< world space
};

/// A scene's camera with its stop almost closed.
class ChiefRays {
 public:
  explicit ChiefRays(const PreparedScene& scene);

  const render::PixelWindow& window() const { return window_; }
  int film_rows() const { return camera_.film.rows; }
  const std::optional<render::CameraMotion>& motion() const { return camera_.motion; }
  /// Where the camera is when the exposure of a row begins.
  render::Transform world_from_camera(double row) const;
  /// Camera rays of places on the film [pixels].
  std::vector<render::CameraRay> trace(const std::vector<std::array<double, 2>>& places) const;
  /// Those of the middles of a row's pixels. \param row  of the picture, from 0.
  std::vector<render::CameraRay> trace_row(int row) const;
  /// Surfaces that are no boundary are seen through.
  std::optional<SeenPoint> seen(const render::CameraRay& ray, const render::Transform& from) const;

 private:
  const render::World& world_;
  render::SceneCamera camera_;
  render::PixelWindow window_;
  std::unique_ptr<const render::FilmCamera> film_camera_;
  render::FilmSampling sampling_;
};

/// How wide the stop of chief rays is, of its own width.
constexpr double middle_share_of_stop = 0.02;
render::SceneCamera camera_through_the_middle(const PreparedScene& scene);

}  // namespace petzval
