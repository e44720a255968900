// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <climits>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "scratch.h"

namespace petzval {
namespace {

namespace fs = std::filesystem;

class WholeFileTest : public testing::Test {
 protected:
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }

  const test::Scratch scratch;
  const fs::path folder = scratch.folder();
};

TEST_F(WholeFileTest, AppearsOnlyWhenCommitted) {
  const std::string path = folder / "out.txt";
  {
    WholeFile file(path);
    std::ofstream(file.temporary_path()) << "half";
    EXPECT_FALSE(fs::exists(path));
  }
  EXPECT_EQ(entries(), 0u) << "an abandoned file leaves nothing behind";
  write_whole_file(path, "whole");
  EXPECT_EQ(read_whole_file(path), "whole");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(WholeFileTest, KeepsTheOldFileUntilTheNewOneIsWhole) {
  const std::string path = folder / "out.txt";
  write_whole_file(path, "old");
  {
    WholeFile file(path);
    std::ofstream(file.temporary_path()) << "new";
    EXPECT_EQ(read_whole_file(path), "old");
  }
  EXPECT_EQ(read_whole_file(path), "old");
  write_whole_file(path, "new");
  EXPECT_EQ(read_whole_file(path), "new");
}

TEST_F(WholeFileTest, TemporaryNameKeepsTheExtension) {
  EXPECT_EQ(fs::path(WholeFile(folder / "picture.png").temporary_path()).extension(), ".png");
  EXPECT_EQ(fs::path(WholeFile(folder / "picture.png").temporary_path()).parent_path(), folder);
}

TEST_F(WholeFileTest, RefusesFoldersAndMissingFolders) {
  EXPECT_THROW(WholeFile{folder.string()}, InputError);
  EXPECT_THROW(WholeFile{(folder / "none" / "out.txt").string()}, InputError);
  EXPECT_THROW(WholeFile{std::string()}, InputError);
}

TEST_F(WholeFileTest, RefusesNamesThatAreTooLong) {
  constexpr std::size_t longest_name = 255;  // NAME_MAX of all file systems in use
  EXPECT_THROW(write_whole_file(folder / std::string(longest_name + 1, 'x'), ""), InputError);
  EXPECT_THROW(write_whole_file(folder / (std::string(longest_name, 'x') + ".svg"), ""), InputError);
  std::string deep = folder;
  while (deep.size() < PATH_MAX) deep += "/.";
  EXPECT_THROW(write_whole_file(deep + "/out.txt", ""), InputError);
  write_whole_file(folder / std::string(longest_name / 2, 'x'), "");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(WholeFileTest, LeavesPipesAndLinksAsTheyAre) {
  const std::string pipe = folder / "pipe", link = folder / "link", target = folder / "target";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(WholeFile{pipe}, InputError);
  EXPECT_TRUE(fs::is_fifo(pipe));
  write_whole_file(target, "old");
  fs::create_symlink("target", link);
  write_whole_file(link, "new");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_whole_file(target), "new");
}

TEST_F(WholeFileTest, TryingLeavesNothing) {
  write_whole_file(folder / "old", "old");
  require_writable(folder / "old");
  require_writable(folder / "new");
  EXPECT_EQ(read_whole_file(folder / "old"), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
  EXPECT_THROW(require_writable(folder / "none" / "new"), InputError);
  // A folder that takes no files from anybody, root too.
  EXPECT_THROW(require_writable("/proc/new"), Failure);
}

TEST_F(WholeFileTest, ReadingSaysWhatIsWrong) {
  EXPECT_THROW(read_whole_file(folder / "none"), InputError);
  EXPECT_THROW(read_whole_file(folder), InputError);
  write_whole_file(folder / "big", std::string(2000, 'x'));
  EXPECT_THROW(read_whole_file(folder / "big", 1000), InputError);
}

TEST_F(WholeFileTest, BinaryBytesSurvive) {
  std::string bytes;
  for (int i = 0; i < 70000; ++i) bytes.push_back(static_cast<char>(i * 31));
  write_whole_file(folder / "bytes", bytes);
  EXPECT_EQ(read_whole_file(folder / "bytes"), bytes);
}

}  // namespace
}  // namespace petzval
