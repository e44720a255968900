// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/simulate/imaging_memory.h>

#include <algorithm>
#include <iterator>

namespace petzval {

Scene ImagingMemory::scene(const SceneRequest& request, const std::function<Scene()>& read) {
  const SceneKey key{request.options.horizontal_angle_deg, request.options.distance_m};
  const auto same = [&](const KeptScene& kept) { return kept.key == key; };
  auto found = std::find_if(scenes_.begin(), scenes_.end(), same);
  if (found != scenes_.end() && !found->scene) {  // lost with a plan that failed
    scenes_.erase(found);
    found = scenes_.end();
  }
  if (found == scenes_.end()) {
    // As it is read to be looked at, and as it is drawn to fill a frame.
    constexpr std::size_t most = 2;
    if (scenes_.size() == most) scenes_.erase(scenes_.begin());
    Scene made = read();
    ++work.scenes_read;
    scenes_.push_back({key, made.horizontal_angle_deg(), made.distance_m(), std::move(made)});
    found = std::prev(scenes_.end());
  }
  scene_in_use_ = key;
  Scene taken = *std::move(found->scene);
  found->scene.reset();
  return taken;
}

std::shared_ptr<FormationMemory> ImagingMemory::formation() const {
  for (const KeptScene& kept : scenes_)
    if (scene_in_use_ && kept.key == *scene_in_use_) return kept.formation;
  return of_only_scene_;
}

void ImagingMemory::give_back(Scene& scene) {
  if (!scene_in_use_) return;
  for (KeptScene& kept : scenes_) {
    if (kept.key != *scene_in_use_) continue;
    if (!scene.is_panorama()) {
      scene.set_distance_m(kept.distance_m);
      scene.set_horizontal_angle_deg(kept.horizontal_angle_deg);
    }
    kept.scene = std::move(scene);
    break;
  }
  scene_in_use_.reset();
}

LensDataTable ImagingMemory::table(const std::string& key, const std::function<LensDataTable()>& make) {
  lens_key_ = key;
  if (key != table_key_) table_.reset();
  table_key_ = key;
  if (!table_) {
    LensDataTable made = make();
    ++work.tables_made;
    return made;
  }
  LensDataTable taken = *std::move(table_);
  table_.reset();
  return taken;
}

void ImagingMemory::give_back(ImagePlan& plan) {
  give_back(plan.scene);
  if (!plan.depth && !lens_key_.empty() && lens_key_ == table_key_) table_ = std::move(plan.table);
}

}  // namespace petzval
