// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/live/guard.h>
#include <sys/stat.h>

#include <cstdlib>
#include <set>

#include "scratch.h"

namespace petzval {
namespace {

TEST(Tokens, AreLongAndNeverTheSame) {
  std::set<std::string> all;
  for (int i = 0; i < 100; ++i) all.insert(random_token());
  EXPECT_EQ(all.size(), 100u);
  for (const std::string& token : all) EXPECT_EQ(token.size(), 32u);  // 128 bits
}

TEST(Tokens, AreKeptForTheUserAlone) {
  const test::Scratch scratch;
  setenv("XDG_RUNTIME_DIR", scratch.folder().c_str(), 1);
  const std::string token = kept_token(4711);
  EXPECT_EQ(kept_token(4711), token);
  EXPECT_NE(kept_token(4712), token);
  const std::string file = scratch.path("petzval-live-4711.token");
  struct stat facts {};
  ASSERT_EQ(stat(file.c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0777, 0600u);
  // One that others could have read, or that is none, is not trusted.
  chmod(file.c_str(), 0644);
  const std::string second = kept_token(4711);
  EXPECT_NE(second, token);
  scratch.with("petzval-live-4711.token", "short");
  EXPECT_EQ(kept_token(4711).size(), 32u);
  unsetenv("XDG_RUNTIME_DIR");
  EXPECT_NE(kept_token(4711), kept_token(4711));
}

TEST(RequestGuard, TakesTheProtocolsOfAPageAndNoOther) {
  const RequestGuard guard(8000, "0123456789abcdef0123456789abcdef");
  EXPECT_TRUE(guard.right_protocols("petzval-live.1, 0123456789abcdef0123456789abcdef"));
  for (const char* wrong :
       {"", "petzval-live.1", "petzval-live.1, ", "petzval-live.1, 0123456789abcdef0123456789abcdeF",
        "0123456789abcdef0123456789abcdef", "petzval-live.1,0123456789abcdef0123456789abcdef, x"})
    EXPECT_FALSE(guard.right_protocols(wrong)) << wrong;
  EXPECT_FALSE(guard.right_protocols({}));
}

}  // namespace
}  // namespace petzval
