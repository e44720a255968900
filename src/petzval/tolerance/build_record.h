// SPDX-License-Identifier: BSD-3-Clause
// Judgements of builds in a file, so that work that was ended goes on where it was.
#pragma once

#include <petzval/tolerance/build_merit.h>

#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace petzval {

struct ToleranceRequest;

/// A text file: what is judged, a fact a line, then a line for each build that is finished, in any order. A
/// line that was not written to its end does not count.
class BuildRecord {
 public:
  /// Begins a file, or reads one that is there. \throws InputError if it is no record of builds, if it is one
  /// of other builds (naming what differs), or damaged (naming the line); Failure if it cannot be written.
  BuildRecord(std::string path, const Lens& lens, const ToleranceRequest& request, std::uint64_t seed);

  /// What is known of a build; null if nothing.
  const Judgement* find(std::size_t build) const;
  /// Adds a build, flushed. May be called by several threads. \throws Failure when the disk is full.
  void add(std::size_t build, const Judgement& judgement);

 private:
  using Facts = std::vector<std::pair<std::string, std::string>>;
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  /// \returns how many bytes hold whole lines.
  std::size_t read(const std::string& text, const Facts& facts, std::size_t points);

  std::string path_;
  std::map<std::size_t, Judgement> known_;
  std::mutex writing_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace petzval
