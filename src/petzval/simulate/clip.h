// SPDX-License-Identifier: BSD-3-Clause
// A clip: many frames of a scene that moves, or of light that flickers.
#pragma once

#include <petzval/sensor/event_camera.h>
#include <petzval/sensor/lamp_flicker.h>
#include <petzval/sensor/timed_exposure.h>
#include <petzval/simulate/expose.h>
#include <petzval/simulate/image.h>
#include <petzval/simulate/motion_path.h>
#include <petzval/simulate/render.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace petzval {

struct ClipOptions {
  int frames = 1;
  double fps = 24;
  /// Of each frame. Automatic exposure is measured at the first instant, in light that does not flicker, and
  /// is no longer than a frame lasts. The exposures of a bracket follow each other row by row (staggered):
  /// what moves is not where it was.
  ExposeOptions expose = {};
  std::optional<Shutter> shutter = {};  ///< absent: the sensor's
  MotionPath motion = {};               ///< of the camera before a plane scene or a panorama, or of the scene
  LampFlicker flicker = {};             ///< of all light
  /// Light is worked out anew when the picture has moved by so much [pixels], and changes in straight lines
  /// in between: TimedExposure tells what that costs.
  double step_px = 0.5;
  /// Of a scene in three dimensions: from one to the next an exposure's length divided by this.
  int instants = 16;

  double frame_s() const { return 1 / fps; }
  double duration_s() const { return frames / fps; }
  /// \throws InputError saying what would be right.
  void validate() const;
};

/// The plan of a clip: that of its scene, wide enough for all that the camera comes to see where a chart or a
/// photograph takes any width. \throws InputError as plan_image(), and for a motion that the scene cannot
/// have.
ImagePlan plan_clip(const SceneRequest& scene, Optics optics, const ImageOptions& options,
                    const MotionPath& motion, const Context& context = {});

/// A clip whose exposure and white balance are settled. Frames are made one by one, in any order, each with
/// the same bytes as in any other:
///
///     ClipOptions options;
///     options.frames = 48;
///     options.flicker = LampFlicker::mains(50, 0.4);
///     const Clip clip(plan_image(SceneRequest{.name = "studio"}, camera), sensor, options);
///     const RawImage first = clip.frame(0);
///
/// Temporal noise is new in each frame; the fixed pattern stays.
class Clip {
 public:
  /// \throws InputError for options that contradict each other or the sensor; Cancelled.
  Clip(ImagePlan plan, const Sensor& sensor, const ClipOptions& options, const Context& context = {});
  /// Of a scene in three dimensions: what moves in its file (pbrt's ActiveTransform, TransformTimes in
  /// seconds), the camera too, is rendered at `instants` instants an exposure, each with
  /// `scene.samples_per_pixel` samples of its own. Its focus is settled at the beginning. The camera's sensor
  /// is `sensor`. \throws InputError also for a motion in the options.
  Clip(const RenderRequest& scene, const Sensor& sensor, const ClipOptions& options,
       const Context& context = {});
  ~Clip();
  Clip(const Clip&) = delete;
  Clip& operator=(const Clip&) = delete;

  double exposure_s() const;
  const Shutter& shutter() const;
  /// When a frame's exposure begins: frame / fps. \param exposure  of a bracket.
  FrameTiming timing(int frame, std::size_t exposure = 0) const;
  /// How many pictures of light a frame is made of.
  std::size_t instants(int frame) const;

  /// \throws InputError for a frame that the clip does not have; Cancelled.
  RawImage frame(int index, const Context& context = {}) const;

  /// What an event camera with these pixels tells from the beginning to the end of the clip: events are
  /// handed over as they come, in the order of time. Flicker is seen at `flicker_steps` instants a period.
  using TakeEvents = std::function<void(const std::vector<Event>&)>;
  void events(const EventCameraOptions& camera, const TakeEvents& take, const Context& context = {}) const;
  static constexpr int flicker_steps = 64;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Hands over every frame in turn. \throws InputError; Cancelled.
///
///     ClipOptions options;
///     options.frames = 48;
///     options.motion = MotionPath::steady({.pan_deg = 20}, options.duration_s());
///     const ImagePlan plan = plan_clip(SceneRequest{.name = "studio"}, camera, {}, options.motion);
///     shoot(plan, sensor, options, [](int frame, const RawImage& raw) {
///       write_picture("frame-" + std::to_string(frame) + ".png", develop(raw));
///     });
void shoot(const ImagePlan& plan, const Sensor& sensor, const ClipOptions& options,
           const std::function<void(int frame, const RawImage& raw)>& take, const Context& context = {});

}  // namespace petzval
