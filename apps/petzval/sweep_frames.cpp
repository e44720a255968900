// SPDX-License-Identifier: BSD-3-Clause
#include "sweep_frames.h"

#include <petzval/base/error.h>
#include <petzval/render/pbrt/scene_files.h>
#include <petzval/simulate/render_frames.h>

#include "command.h"
#include "run_command.h"
#include "sweep_result.h"

namespace petzval::app {

bool SweepFrames::takes(const PreparedScene& scene) {
  if (!pictures_.empty()) return false;
  scenes_.push_back(scene);
  return true;
}

SweepFrames::SweepFrames(std::vector<std::vector<std::string>> commands) : commands_(std::move(commands)) {
  std::string all;
  for (const std::vector<std::string>& words : commands_) {
    for (const std::string& word : words) all += word + "\n";
    all += checksums_of_files(words, words.back()).dump() + "\n";
  }
  fingerprint_ = render::hash_text(all);
}

void SweepFrames::render(const Shared& shared) {
  if (!pictures_.empty()) return;
  for (const std::vector<std::string>& words : commands_) {
    const std::size_t before = scenes_.size();
    const CommandOutcome outcome = run_command(words, shared.renders, this);
    if (outcome.exit_code != 0) throw InputError("--share-paths: " + outcome.error);
    if (scenes_.size() == before)
      throw InputError(
          "--share-paths: pieces of pictures and estimates share nothing; whole pictures would be right");
  }
  pictures_ = render_frames(scenes_, context_of(shared));
  scenes_.clear();
}

}  // namespace petzval::app
