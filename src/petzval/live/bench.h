// SPDX-License-Identifier: BSD-3-Clause
// One page's bench: what is on it is worked out stage by stage, the quick ones first.
#pragma once

#include <petzval/base/context.h>
#include <petzval/live/bench_scene.h>
#include <petzval/live/message.h>
#include <petzval/trace/losses.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace petzval {

/// The lens as it is used, and what its coatings take.
struct CoatedLens {
  Lens lens = Lens();
  Losses losses = {};
};

/// What is sent to the page: JSON alone, or with bytes behind it (pixels, a file).
struct LiveReply {
  std::string json;
  std::vector<std::uint8_t> bytes = {};
  bool with_bytes = false;
};
/// May be called from any thread.
using SendReply = std::function<void(LiveReply reply)>;

/// What the server was started with.
struct LiveStart {
  std::string lens_name = {};  ///< as typed, for the command line that the page shows
  std::string lens_json = {};
  std::string scene = {};   ///< the first to be shown
  std::string sensor = {};  ///< empty: the usual one of the lens
  /// Files that were named at the start, by their labels.
  std::map<std::string, BenchScene> scene_files = {};
  std::map<std::string, std::string> sensor_files = {};
};

/// What the bench asks of whoever runs it.
struct BenchQuestions {
  std::function<bool()> newer;  ///< whether something waits that is newer than what is shown
  std::function<bool()> ended;  ///< whether nobody looks any more
  std::function<bool(std::chrono::milliseconds)> rests;  ///< waits; false if something came before the end
};

/// Stages: layout → psf → preview (few pixels, three bands) → picture → finest, and plots beside them. What
/// has been shown already and has not changed is left out. While a hand moves, a stage that was shown a
/// moment ago gives way to what is newer; one that was not is finished first, so that all of them follow the
/// hand. A Bench is for one thread at a time.
///
/// All of its numbers come from `simulate` and below; what fails is told to the page ("problem") and ends
/// the stage, not the bench.
class Bench {
 public:
  Bench(const LiveStart& start, SendReply send);
  ~Bench();

  /// Of everything there is to choose from, and the first lens.
  void greet();
  /// \throws Cancelled if something newer came before the end; what was shown stays shown.
  void show(const BenchState& state, int threads, const BenchQuestions& ask);
  void send_lens(const LensWish& wish);
  void send_glasses(const GlassWish& wish);
  /// How far the sensor of the lens that was shown last must move for this place to be sharp.
  void focus(const FocusWish& wish);
  /// The lens or the picture that was shown last, as a file. \throws Cancelled.
  void save(const SaveWish& wish, const Context& context);
  /// Reads a lens, or keeps a photograph or a spectral file as a scene.
  void take(const Upload& upload);
  /// What its messages may name.
  const LiveNames& names() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace petzval
