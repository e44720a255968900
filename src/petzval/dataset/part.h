// SPDX-License-Identifier: BSD-3-Clause
// One part of a data set: its archive, its lines of facts, and their sums.
#pragma once

#include <petzval/dataset/item.h>
#include <petzval/dataset/recipe.h>
#include <functional>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// What part-00012.json holds.
struct PartSums {
  std::size_t part = 0, items = 0, failed = 0;
  std::uint64_t archive_bytes = 0;
  std::string archive_crc32 = {}, lines_crc32 = {};

  std::string text() const;
  /// \throws InputError unless it is the text of some sums.
  static PartSums parse(const std::string& text, const std::string& file);
};

/// How many items a process makes at once: as many as it has threads, up to eight, for their files wait in
/// memory for their turn.
std::size_t items_at_once(std::size_t items);

class DatasetPart {
 public:
  DatasetPart(std::string folder, std::size_t number) : folder_(std::move(folder)), number_(number) {}

  bool is_done() const;
  /// Makes it. \param made  told of each item that is done, one call at a time. \returns nothing if another
  /// process is at it, or it is done by now. \throws Failure; Cancelled.
  std::optional<PartSums> make(const Recipe& recipe, ItemMaker& maker,
                               const std::function<void()>& made) const;
  /// \throws InputError unless it is done.
  PartSums sums() const;
  /// The lines of facts.
  std::vector<nlohmann::json> lines() const;
  /// What is wrong with it, a line each.
  std::vector<std::string> faults(const Recipe& recipe) const;

 private:
  std::string path(const char* extension) const;

  std::string folder_;
  std::size_t number_;
};

}  // namespace petzval
