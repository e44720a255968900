// SPDX-License-Identifier: BSD-3-Clause
// Data sets with ground truth: many pictures through many lenses and sensors, made by one process or a
// thousand.
#pragma once

#include <petzval/base/context.h>
#include <petzval/dataset/recipe.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace petzval {

/// Which parts of a data set a process makes: every `count`th, from number `index` (from 0) on.
struct Shard {
  std::size_t index = 0, count = 1;
};

struct DatasetReport {
  std::size_t parts = 0;              ///< of the shard
  std::size_t kept = 0;               ///< of those, made earlier
  std::size_t elsewhere = 0;          ///< of those, in the making by another process
  std::size_t items = 0, failed = 0;  ///< of the parts that were made now
  std::uint64_t bytes = 0;            ///< of their archives
};

/// Makes a data set in a folder (docs/DATASETS.md), part by part: part-00012.tar holds the items' files in
/// WebDataset's order, part-00012.jsonl a line of facts an item, part-00012.json the sums of both; it is
/// written last, and a part that has it is done. dataset.json holds the recipe. Every file appears whole or
/// not at all. Parts that are there are kept, so that a process that was killed is started again and goes on;
/// a part that another process is making is left to it. An item that cannot be made is recorded, with the
/// reason, and the rest goes on. The bytes depend on the recipe alone: not on threads, shards, or order.
///
///     make_dataset(read_recipe("recipe.json"), "out");
///
/// \throws InputError for a lens or a sensor of the recipe that cannot be read, a shard that there is not,
/// and a folder that holds the data set of another recipe or another version; Failure, as for a full disk;
/// Cancelled.
DatasetReport make_dataset(const Recipe& recipe, const std::string& folder, const Shard& shard = {},
                           const Context& context = {});

/// What is in a folder.
struct DatasetState {
  std::string made_by;  ///< "petzval 0.2.0"
  Recipe recipe;
  std::size_t parts_done = 0;
  std::size_t items = 0, failed = 0;     ///< of the parts that are done
  std::uint64_t bytes = 0;               ///< of their archives
  std::vector<std::string> errors = {};  ///< why items failed: each reason once, the most frequent first
};
/// \throws InputError for a folder without a data set, or a damaged one.
DatasetState dataset_state(const std::string& folder);

/// Reads every byte of the parts that are done and compares sums, names and sizes. \returns what is wrong, a
/// line each; nothing if all is well. \throws InputError as dataset_state(); Cancelled.
std::vector<std::string> verify_dataset(const std::string& folder, const Context& context = {});

struct DatasetEstimate {
  std::size_t probed = 0, failed = 0;  ///< items that were made for it
  double cpu_s = 0, cpu_error_s = 0;   ///< of one core an item, and the standard error
  double bytes = 0;                    ///< an item, in the archives
  int threads = 0;                     ///< of the process
  double memory_bytes = 0;             ///< of that process, the most
};
/// What a data set will take, from items spread over it, which are made and thrown away: as many at once as
/// make_dataset() makes with these threads, for memory goes by that, and twice as many at least.
/// \throws InputError as make_dataset(), and where all of the items fail; Cancelled.
DatasetEstimate estimate_dataset(const Recipe& recipe, std::size_t probes = 8, const Context& context = {});

}  // namespace petzval
