// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/helper_process.h>
#include <petzval/base/nameless_file.h>
#include <unistd.h>

#include <atomic>
#include <string>
#include <thread>

namespace petzval {
namespace {

HelperEnd run_shell(const std::string& script, int descriptor = -1) {
  return run_helper("/bin/sh", {"-c", script}, descriptor);
}

TEST(HelperProcess, LeavesItsWorkInAFile) {
  const NamelessFile file;
  ASSERT_TRUE(file);
  EXPECT_EQ(run_shell("echo to nobody; echo to nobody >&2; printf done >&3", file.descriptor()),
            HelperEnd::finished);
  char text[5] = "";
  EXPECT_EQ(pread(file.descriptor(), text, 4, 0), 4);
  EXPECT_STREQ(text, "done");
}

TEST(HelperProcess, CrashesAlone) {
  EXPECT_EQ(run_shell("kill -SEGV $$"), HelperEnd::crashed);
  EXPECT_EQ(run_shell("kill -ABRT $$"), HelperEnd::crashed);
  EXPECT_EQ(run_shell("exit 1"), HelperEnd::crashed);
}

TEST(HelperProcess, IsStoppedWhenItFindsNoEnd) {
  EXPECT_EQ(run_shell("ulimit -S -t 1; while :; do :; done"), HelperEnd::endless);
}

template <typename Thrown>
std::string message_of(const std::string& script) {
  try {
    run_shell(script);
  } catch (const Thrown& error) {
    return error.what();
  }
  return "nothing thrown";
}

TEST(HelperProcess, SaysWhatWasWrong) {
  EXPECT_EQ(message_of<InputError>("printf 'file: is no file'; exit 3"), "file: is no file");
  EXPECT_EQ(message_of<Failure>("printf 'disk full'; exit 4"), "disk full");
  EXPECT_THROW(run_helper("/nowhere/at/all", {}), Failure);
  EXPECT_THROW(helper_program("no-such-helper"), Failure);
}

// A copy of this process would be one of a single thread, with locks that others hold.
TEST(HelperProcess, RunsWhileThreadsAllocate) {
  std::atomic<bool> stop = false;
  std::thread busy([&] {
    while (!stop) std::string(1000, 'x').append(1000, 'y');
  });
  for (int i = 0; i < 20; ++i) EXPECT_EQ(run_shell("exit 0"), HelperEnd::finished);
  stop = true;
  busy.join();
}

}  // namespace
}  // namespace petzval
