// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <gtest/gtest.h>
#include <petzval/base/direct_stream.h>
#include <petzval/base/error.h>
#include <petzval/base/nameless_file.h>
#include <petzval/base/whole_file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <string>

#include "scratch.h"

namespace petzval {
namespace {

/// Bytes that differ from place to place, also from page to page and from block to block.
std::string unlike_bytes(std::size_t count) {
  std::string bytes(count, '\0');
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<char>((i * 2654435761U) >> 13);
  return bytes;
}

std::string written(const std::string& bytes, std::size_t piece) {
  NamelessFile file;
  DirectStream stream(file.descriptor(), "out");
  for (std::size_t at = 0; at < bytes.size(); at += piece)
    stream.write(bytes.data() + at, std::min(piece, bytes.size() - at));
  stream.finish();
  std::string back(bytes.size() + 1, '\0');  // one more, which must not be there
  std::size_t got = 0;
  for (ssize_t count;
       (count = pread(file.descriptor(), back.data() + got, back.size() - got, static_cast<off_t>(got))) > 0;)
    got += static_cast<std::size_t>(count);
  back.resize(got);
  return back;
}

// Shorter and longer than a block of 4 MiB and than all blocks, ending with a page and within one.
TEST(DirectStream, WritesAllBytesInOrder) {
  for (const std::size_t count : {0U, 1U, 4096U, 12345U, 4U << 20, (9U << 20) + 77, 45U << 20}) {
    const std::string bytes = unlike_bytes(count);
    EXPECT_TRUE(written(bytes, 1000003) == bytes) << count;
    EXPECT_TRUE(written(bytes, 50U << 20) == bytes) << count;
  }
}

TEST(DirectStream, SaysWhatCannotBeWritten) {
  const std::string bytes = unlike_bytes(5U << 20);
  const int read_only = open("/proc/self/exe", O_RDONLY | O_CLOEXEC);
  ASSERT_GE(read_only, 0);
  const auto write_much = [&] {
    DirectStream stream(read_only, "there.npy");
    for (int i = 0; i < 20; ++i) stream.write(bytes.data(), bytes.size());
    stream.finish();
  };
  try {
    write_much();
    ADD_FAILURE() << "written to a file that is only read";
  } catch (const Failure& failure) {
    EXPECT_NE(std::string(failure.what()).find("there.npy: cannot be written"), std::string::npos);
  }
  const auto write_little = [&] {
    DirectStream stream(read_only, "there.npy");
    stream.write(bytes.data(), 10);
    stream.finish();
  };
  EXPECT_THROW(write_little(), Failure);
  close(read_only);
}

TEST(DirectStream, MayBeGivenUp) {
  const NamelessFile file;
  DirectStream stream(file.descriptor(), "out");
  const std::string bytes = unlike_bytes(9U << 20);
  stream.write(bytes.data(), bytes.size());
}

TEST(NamelessFile, GetsANameOnce) {
  const test::Scratch scratch;
  const NamelessFile file(scratch.folder().string());
  if (!file) GTEST_SKIP() << "no files without a name here";
  ASSERT_EQ(pwrite(file.descriptor(), "whole", 5, 0), 5);
  const std::string path = scratch.path("named");
  write_whole_file(path, "before");
  EXPECT_FALSE(file.link(path)) << "in place of another";
  EXPECT_TRUE(file.link(scratch.path("new")));
  EXPECT_EQ(read_whole_file(scratch.path("new")), "whole");
  // For whom other files of this program are.
  struct stat named, usual;
  ASSERT_EQ(stat(path.c_str(), &usual), 0);
  ASSERT_EQ(stat((scratch.path("new")).c_str(), &named), 0);
  EXPECT_EQ(named.st_mode, usual.st_mode);
}

TEST(NamelessFile, NeedsAFolder) {
  EXPECT_FALSE(NamelessFile("/nonexistent"));
}

}  // namespace
}  // namespace petzval
