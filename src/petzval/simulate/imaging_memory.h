// SPDX-License-Identifier: BSD-3-Clause
// What is kept between the plans of one scene and set of options.
#pragma once

#include <petzval/imaging/formation_memory.h>
#include <petzval/simulate/image.h>
#include <petzval/simulate/imaging_session.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace petzval {

/// Scenes and tables that plan_image() takes instead of making them again. They move into the plan, and back
/// by give_back(): nothing is held twice.
class ImagingMemory {
 public:
  /// A scene as read() with these, of which everything else is the session's.
  Scene scene(const SceneRequest& request, const std::function<Scene()>& read);
  /// A table. \param key  says everything of its lens and options; empty: it is not to be kept.
  LensDataTable table(const std::string& key, const std::function<LensDataTable()>& make);
  /// Of the plan that was made last: as above. Scenes with depth have no table, but their lens.
  const std::string& lens_key() const { return lens_key_; }
  void set_lens_key(std::string key) { lens_key_ = std::move(key); }

  /// For images of the scene in use.
  std::shared_ptr<FormationMemory> formation() const;

  void give_back(Scene& scene);
  void give_back(ImagePlan& plan);
  ImagingSession::Work work = {};

 private:
  struct SceneKey {
    std::optional<double> horizontal_angle_deg = {}, distance_m = {};
    bool operator==(const SceneKey&) const = default;
  };
  /// As it was read, before it was fitted to a frame.
  struct KeptScene {
    SceneKey key;
    double horizontal_angle_deg;
    std::optional<double> distance_m;
    std::optional<Scene> scene;  ///< absent: in use
    std::shared_ptr<FormationMemory> formation = std::make_shared<FormationMemory>();
  };
  std::shared_ptr<FormationMemory> of_only_scene_ =
      std::make_shared<FormationMemory>();  ///< of none of these
  std::vector<KeptScene> scenes_;
  std::optional<SceneKey> scene_in_use_;
  std::string lens_key_, table_key_;
  std::optional<LensDataTable> table_;  ///< absent: in use
};

/// plan_image() with a memory; what it takes must be given back.
ImagePlan plan_image(const SceneRequest& scene, Optics optics, const ImageOptions& options,
                     const Context& context, ImagingMemory& memory);
ImagePlan plan_image(Scene scene, Optics optics, const ImageOptions& options, const Context& context,
                     ImagingMemory& memory);

}  // namespace petzval
