// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/file_extension.h>

namespace petzval {

TEST(FileExtension, IsTheLastOneInLowerCase) {
  EXPECT_EQ(extension_of("out/Light.EXR"), ".exr");
  EXPECT_EQ(extension_of("a.tar.Gz"), ".gz");
  EXPECT_EQ(extension_of("folder.d/file"), "");
  EXPECT_EQ(extension_of(".hidden"), "");
  EXPECT_EQ(extension_of(""), "");
}

}  // namespace petzval
