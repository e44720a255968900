// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/scratch_folder.h>
#include <petzval/base/stop.h>
#include <petzval/base/whole_file.h>
#include <petzval/lens/lens_file.h>
#include <petzval/tolerance/tolerancing.h>

#include <algorithm>
#include <atomic>
#include <filesystem>

namespace petzval {
namespace {

class BuildRecordTest : public testing::Test {
 protected:
  BuildRecordTest() : lens(read_lens("cooke-triplet").lens) {
    request.builds = 24;
    request.sensitivities = false;
    request.judge.at.fields = {0, 14};
    request.judge.azimuths_deg = {0, 90};
    plain = tolerance_lens(lens, request);
    request.record = (std::filesystem::path(folder.path()) / "builds.txt").string();
  }

  void expect_plain(const ToleranceReport& report) const {
    ASSERT_LE(report.builds.size(), plain.builds.size());
    for (std::size_t i = 0; i < report.builds.size(); ++i) {
      const Judgement &one = report.builds[i].judgement, &other = plain.builds[i].judgement;
      EXPECT_EQ(one.overall, other.overall) << i;
      EXPECT_EQ(one.worst, other.worst) << i;
      EXPECT_EQ(one.refocus_mm, other.refocus_mm) << i;
      EXPECT_EQ(one.at_points, other.at_points) << i;
      EXPECT_EQ(report.builds[i].errors_x, plain.builds[i].errors_x) << i;
    }
  }
  std::size_t recorded() const {
    const std::string text = read_whole_file(request.record);
    const std::size_t builds = text.find("\nbuilds\n");
    return static_cast<std::size_t>(
        std::count(text.begin() + static_cast<std::ptrdiff_t>(builds + 8), text.end(), '\n'));
  }
  std::string refusal() const {
    try {
      tolerance_lens(lens, request);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  ScratchFolder folder;
  Lens lens;
  ToleranceRequest request;
  ToleranceReport plain;
};

TEST_F(BuildRecordTest, GoesOnWhereItWasEnded) {
  Context stopping;
  std::atomic<int> calls = 0;
  stopping.progress = [&](double, std::string_view) { return ++calls < 9; };
  EXPECT_THROW(tolerance_lens(lens, request, stopping), Cancelled);
  const std::size_t before = recorded();
  EXPECT_GT(before, 0U);
  EXPECT_LT(before, 24U);
  expect_plain(tolerance_lens(lens, request));
  EXPECT_EQ(recorded(), 24U);
  // All is known now: nothing is added, and fewer may be asked for.
  request.builds = 10;
  expect_plain(tolerance_lens(lens, request));
  EXPECT_EQ(recorded(), 24U);
}

TEST_F(BuildRecordTest, IsBelieved) {
  tolerance_lens(lens, request);
  std::string text = read_whole_file(request.record);
  const std::size_t line = text.find("\n7 ") + 3;
  text.replace(line, text.find(' ', line) - line, "0x1.8p+4");
  write_whole_file(request.record, text);
  EXPECT_EQ(tolerance_lens(lens, request).builds[7].judgement.overall, 24);
}

TEST_F(BuildRecordTest, LeavesOutALineWithoutAnEnd) {
  tolerance_lens(lens, request);
  const std::string text = read_whole_file(request.record);
  for (const std::size_t lost : {std::size_t{1}, std::size_t{30}}) {
    write_whole_file(request.record, text.substr(0, text.size() - lost));
    expect_plain(tolerance_lens(lens, request));
    EXPECT_EQ(recorded(), 24U) << lost;
  }
}

TEST_F(BuildRecordTest, RefusesWhatIsNotItsOwn) {
  tolerance_lens(lens, request);
  const std::string whole = read_whole_file(request.record);
  ToleranceRequest own = request;
  request.judge.merit = {Merit::Kind::mtf, 20};
  EXPECT_NE(refusal().find("not the same merit"), std::string::npos) << refusal();
  request = own;
  request.grade = "high";
  EXPECT_NE(refusal().find("not the same tolerances"), std::string::npos) << refusal();
  request = own;
  lens.surfaces[0].thickness_mm += 1e-9;
  EXPECT_NE(refusal().find("not the same lens"), std::string::npos) << refusal();
  lens.surfaces[0].thickness_mm = read_lens("cooke-triplet").lens.surfaces[0].thickness_mm;
  EXPECT_EQ(read_whole_file(request.record), whole) << "and leaves it alone";
  write_whole_file(request.record, "something else\n");
  EXPECT_NE(refusal().find("no record of builds"), std::string::npos) << refusal();
  EXPECT_EQ(read_whole_file(request.record), "something else\n");
  write_whole_file(request.record, whole + "25 0x1p+1 nonsense\n");
  EXPECT_NE(refusal().find("not a build"), std::string::npos) << refusal();
}

TEST_F(BuildRecordTest, IsTheSameWhateverIsCutOff) {
  request.builds = 3;
  tolerance_lens(lens, request);
  const std::string whole = read_whole_file(request.record);
  for (std::size_t size = 0; size < whole.size(); size += 1 + size / 7) {
    write_whole_file(request.record, whole.substr(0, size));
    try {
      expect_plain(tolerance_lens(lens, request));
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace petzval
