// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/context.h>
#include <petzval/render/film/film.h>

namespace petzval::render {
namespace {

TEST(Film, OfManyPixelsIsGivenUpWhileItIsLaidOut) {
  int questions = 0;
  Context context;
  context.progress = [&](double, const std::string&) { return ++questions < 2; };
  // 2.1 GiB of light, of which a few pieces are touched.
  const PixelWindow large{0, 0, 6000, 4000};
  EXPECT_THROW(
      run_within(context, [&](const ProgressCallback&) { Film(large, 6, 1, false, Film::Half::none); }),
      Cancelled);
}

}  // namespace
}  // namespace petzval::render
