// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>

namespace petzval {
namespace {

TEST(InputError, IsMadeOfItsParts) {
  const InputError error(ErrorParts{.file = "a.json",
                                    .line = 3,
                                    .column = 7,
                                    .problem = "`conic` is no number",
                                    .remedy = "a number would be right",
                                    .parameter = "conic"});
  EXPECT_STREQ(error.what(), "a.json:3:7: `conic` is no number; a number would be right");
  EXPECT_EQ(error.parts().column, 7);
}

TEST(InputError, LeavesOutWhatIsNotKnown) {
  EXPECT_EQ((ErrorParts{.problem = "no light"}).text(), "no light");
  EXPECT_EQ((ErrorParts{.file = "a", .problem = "no light"}).text(), "a: no light");
  EXPECT_EQ((ErrorParts{.file = "a", .line = 2, .problem = "no light"}).text(), "a:2: no light");
  EXPECT_EQ((ErrorParts{.file = "a", .column = 2, .problem = "no light"}).text(), "a: no light");
}

TEST(InputError, FindsTheRemedyBehindTheFirstSemicolon) {
  const InputError error("lens.json", 12, "a radius of 0; null is flat; a length curves");
  EXPECT_EQ(error.parts().file, "lens.json");
  EXPECT_EQ(error.parts().line, 12);
  EXPECT_EQ(error.parts().problem, "a radius of 0");
  EXPECT_EQ(error.parts().remedy, "null is flat; a length curves");
  EXPECT_STREQ(error.what(), "lens.json:12: a radius of 0; null is flat; a length curves");
  EXPECT_EQ(InputError("no remedy").parts().remedy, "");
  EXPECT_STREQ(InputError("no remedy").what(), "no remedy");
}

TEST(InputError, NamesTheFirstParameterInBackquotes) {
  EXPECT_EQ(InputError("`surround` far: zero would be right, or a `sensor`").parts().parameter, "surround");
  EXPECT_EQ(InputError("a lone ` in a name").parts().parameter, "");
}

}  // namespace
}  // namespace petzval
