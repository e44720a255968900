// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/staged_files.h>
#include <petzval/base/whole_file.h>

#include <cstdlib>
#include <filesystem>

#include "scratch.h"

namespace petzval {
namespace {

namespace fs = std::filesystem;

class StagedFilesTest : public testing::Test {
 protected:
  StagedFilesTest() { fs::create_directory(folder / "other"); }
  static std::ptrdiff_t entries(const fs::path& of) {
    return std::distance(fs::directory_iterator(of), fs::directory_iterator());
  }

  const test::Scratch scratch;
  const fs::path folder = scratch.folder();
};

TEST_F(StagedFilesTest, AppearTogether) {
  const std::string a = folder / "a.txt", b = folder / "other" / "b.txt";
  {
    StagedFiles files;
    write_whole_file(files.stage(a), "A");
    write_whole_file(files.stage(b), "B");
    EXPECT_FALSE(fs::exists(a));
    EXPECT_FALSE(fs::exists(b));
    files.commit();
  }
  EXPECT_EQ(read_whole_file(a), "A");
  EXPECT_EQ(read_whole_file(b), "B");
  EXPECT_EQ(entries(folder), 2) << "a.txt and other/, no folder left from writing";
  EXPECT_EQ(entries(folder / "other"), 1);
}

TEST_F(StagedFilesTest, AnInterruptedSetLeavesEverythingAsItWas) {
  const std::string a = folder / "a.txt";
  write_whole_file(a, "old");
  try {
    StagedFiles files;
    write_whole_file(files.stage(a), "new");
    files.stage(folder / "none" / "b.txt");
    FAIL() << "a folder that does not exist is refused";
  } catch (const InputError&) {
  }
  EXPECT_EQ(read_whole_file(a), "old");
  EXPECT_EQ(entries(folder), 2);
}

TEST_F(StagedFilesTest, KeepTheNameSoThatMessagesAndExtensionsAreRight) {
  StagedFiles files;
  EXPECT_EQ(fs::path(files.stage(folder / "picture.png")).filename(), "picture.png");
}

TEST_F(StagedFilesTest, TheSameNameTwiceIsOneFile) {
  const std::string a = folder / "a.txt";
  StagedFiles files;
  write_whole_file(files.stage(a), "first");
  write_whole_file(files.stage(a), "second");
  files.commit();
  EXPECT_EQ(read_whole_file(a), "second");
}

TEST_F(StagedFilesTest, GoThroughLinks) {
  const std::string target = folder / "other" / "target.txt", link = folder / "link.txt";
  write_whole_file(target, "old");
  fs::create_symlink(fs::path("other") / "target.txt", link);
  StagedFiles files;
  write_whole_file(files.stage(link), "new");
  files.commit();
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_whole_file(target), "new");
}

TEST_F(StagedFilesTest, MessagesSpeakOfOutputs) {
  StagedFiles files;
  const std::string path = folder / "picture.png";
  EXPECT_EQ(with_final_names(files.stage(path) + ": cannot be written"), path + ": cannot be written");
  EXPECT_EQ(with_final_names("other.png: cannot be written"), "other.png: cannot be written");
}

}  // namespace
}  // namespace petzval
