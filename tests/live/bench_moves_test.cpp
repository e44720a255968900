// SPDX-License-Identifier: BSD-3-Clause
// One state of the bench after the other, faster than it can show them.
#include <petzval/live/bench_picture.h>

#include <chrono>
#include <thread>
#include <utility>

#include "live_page.h"

namespace petzval {
namespace {

using test::bench_state;
using test::json;
using test::LivePage;
using test::RunningServer;

TEST(BenchMoves, GiveUpAnOlderPicture) {
  RunningServer server;
  LivePage page(*server);
  json old_state = bench_state(1, "dgauss-50mm"), new_state = bench_state(2, "dgauss-50mm");
  old_state["picture"] = true;
  old_state["sensor"] = new_state["sensor"] = "full-frame-24mp";
  page.send(old_state);
  EXPECT_EQ(page.next("picture")["quality"], "preview");
  page.send(new_state);
  // The full picture of the first, which takes seconds, never comes.
  while (true) {
    const json message = page.next();
    EXPECT_FALSE(message["kind"] == "picture" && message["id"] == 1) << message["quality"];
    if (message["kind"] == "idle") {
      EXPECT_EQ(message["id"], 2);
      break;
    }
  }
}

TEST(BenchMoves, EndWithWhatAFreshBenchShows) {
  json state = bench_state(0);
  state["picture"] = true;
  state["plots"] = json::array({"mtf"});
  const json designed = state["lens"]["surfaces"];
  const auto full_picture = [](LivePage& page, std::int64_t id) {
    std::string psf;
    while (true) {
      const json message = page.next();
      EXPECT_NE(message["kind"], "problem") << message;
      EXPECT_NE(message["kind"], "refused") << message;
      if (message["kind"] == "psf") psf = page.bytes;
      if (message["kind"] == "picture" && message["quality"] == "full" && message["id"] == id)
        return std::pair(page.bytes, psf);
    }
  };
  RunningServer moved;
  LivePage page(*moved);
  page.send(state);
  const std::string designed_picture = full_picture(page, 0).first;
  constexpr int moves = 60;
  for (int move = 1; move <= moves; ++move) {
    state["id"] = move;
    state["lens"]["surfaces"] = designed;
    // Three lenses in turn: what was begun of one and given up, at any stage, is asked for again.
    json& gap = state["lens"]["surfaces"][static_cast<std::size_t>(move % 3)]["thickness_mm"];
    gap = 1.01 * gap.get<double>();
    page.send(state);
    const bool rests = move % 7 == 0;  // long enough for a full picture to be begun
    std::this_thread::sleep_for(std::chrono::milliseconds(rests ? 190 + move : move * move % 29));
  }
  const auto [picture, psf] = full_picture(page, moves);
  RunningServer fresh;
  LivePage other(*fresh);
  other.send(state);
  const auto [fresh_picture, fresh_psf] = full_picture(other, moves);
  EXPECT_TRUE(picture == fresh_picture);
  EXPECT_TRUE(psf == fresh_psf);
  EXPECT_FALSE(picture == designed_picture);
}

TEST(BenchPicture, HasAsManyPixelsWhateverPreviewCameBeforeIt) {
  const LiveNames names = bundled_live_names();
  const auto state = std::get<BenchState>(parse_live_message(bench_state(1).dump(), names));
  const CoatedLens used{read_lens("achromat-50mm").lens};
  int columns = 0;
  const SendReply keep = [&](const LiveReply& reply) { columns = json::parse(reply.json)["columns"]; };
  const auto show = [&](BenchPicture& pictures, PictureQuality quality) {
    pictures.show(state, used, BenchScene{.path = state.scene}, state.sensor, quality, {}, keep);
    return columns;
  };
  BenchPicture at_once, after_preview;
  const int pixels = show(at_once, PictureQuality::full);
  EXPECT_LT(pixels, 640);  // the blur of this lens is wide
  show(after_preview, PictureQuality::preview);
  EXPECT_EQ(show(after_preview, PictureQuality::full), pixels);
}

}  // namespace
}  // namespace petzval
