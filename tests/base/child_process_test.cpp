// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/child_process.h>
#include <petzval/base/error.h>
#include <petzval/base/nameless_file.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <functional>
#include <new>
#include <string>

namespace petzval {
namespace {

TEST(ChildProcess, LeavesItsWorkInAFile) {
  const NamelessFile file;
  ASSERT_TRUE(file);
  int mine = 1;
  EXPECT_EQ(run_in_child([&] {
              mine = 2;
              EXPECT_EQ(write(file.descriptor(), "done", 4), 4);
            }),
            ChildEnd::finished);
  EXPECT_EQ(mine, 1);
  char text[5] = "";
  EXPECT_EQ(pread(file.descriptor(), text, 4, 0), 4);
  EXPECT_STREQ(text, "done");
}

TEST(ChildProcess, CrashesAlone) {
  EXPECT_EQ(run_in_child([] { std::raise(SIGSEGV); }), ChildEnd::crashed);
  EXPECT_EQ(run_in_child([] { std::abort(); }), ChildEnd::crashed);
  EXPECT_EQ(run_in_child([] { _exit(1); }), ChildEnd::crashed);
}

TEST(ChildProcess, IsStoppedWhenItFindsNoEnd) {
  ChildLimits limits;
  limits.processor_s = 1;
  EXPECT_EQ(run_in_child(
                [] {
                  volatile unsigned turns = 0;
                  for (;;) turns = turns + 1;
                },
                limits),
            ChildEnd::endless);
}

template <typename Thrown>
std::string message_of(const std::function<void()>& work) {
  try {
    run_in_child(work);
  } catch (const Thrown& error) {
    return error.what();
  }
  return "nothing thrown";
}

TEST(ChildProcess, SaysWhatWasWrong) {
  EXPECT_EQ(message_of<InputError>([] { throw InputError("file", "is no file"); }), "file: is no file");
  EXPECT_EQ(message_of<Failure>([] { throw Failure("disk full"); }), "disk full");
  EXPECT_EQ(message_of<Failure>([] { throw std::bad_alloc(); }), std::bad_alloc().what());
}

}  // namespace
}  // namespace petzval
