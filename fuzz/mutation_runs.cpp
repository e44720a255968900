// SPDX-License-Identifier: BSD-3-Clause
// fuzz_runs FORMAT SEEDS RUNS: alters the seeds at random, the same way every time, and tries each result.
// For compilers without libFuzzer, and for tests that must not take long.
#include "formats.h"

#include <petzval/base/whole_file.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>

namespace {

using petzval::fuzz::Format;

class Mutator {
 public:
  Mutator(const Format& format, std::vector<std::string> seeds) : format_(format), seeds_(std::move(seeds)) {
    // HDF5 files are no smaller than ten kilobytes.
    for (const std::string& seed : seeds_) shortest_ = std::min(shortest_, seed.size());
    largest_ = std::max(largest_, 2 * shortest_);
  }

  std::string operator()() {
    std::string bytes = seeds_[below(seeds_.size())];
    constexpr std::size_t most_changes = 5;
    for (std::size_t changes = below(most_changes + 1); changes > 0; --changes) change(bytes);
    if (bytes.size() > largest_) bytes.resize(largest_);
    return bytes;
  }

 private:
  std::size_t below(std::size_t count) { return count == 0 ? 0 : bits_() % count; }
  /// A stretch that is mostly short.
  std::pair<std::size_t, std::size_t> stretch(const std::string& bytes) {
    const std::size_t start = below(bytes.size() + 1);
    return {start, std::min(bytes.size() - start, below(std::size_t{1} << (1 + below(8))))};
  }
  std::string number() {
    static const char* const numbers[] = {"0",     "-0",  "1e-320", "1e308",  "-1e308", "1e999",
                                          "nan",   "inf", "1e10",   "-1e-12", "0.5",    "255",
                                          "65536", "-1",  "1.",     ".5"};
    return numbers[below(std::size(numbers))];
  }
  /// Exchanges a word of digits for another.
  void exchange_number(std::string& bytes) {
    const std::size_t start = bytes.find_first_of("0123456789", below(bytes.size()));
    if (start == bytes.npos) return;
    const std::size_t end = std::min(bytes.find_first_not_of("0123456789.eE+-", start), bytes.size());
    bytes.replace(start, end - start, number());
  }
  void change(std::string& bytes) {
    const auto [start, length] = stretch(bytes);
    switch (below(9)) {
      case 0:
        if (!bytes.empty()) bytes[below(bytes.size())] ^= static_cast<char>(1 << below(8));
        return;
      case 1:
        if (!bytes.empty()) bytes[below(bytes.size())] = static_cast<char>(below(256));
        return;
      case 2:
        bytes.erase(start, length);
        return;
      case 3:
        bytes.insert(start, bytes.substr(start, length));
        return;
      case 4:
        bytes.insert(start, format_.words[below(format_.words.size())]);
        return;
      case 5:
      case 6:
        return exchange_number(bytes);
      case 7: {
        const std::string& other = seeds_[below(seeds_.size())];
        bytes.replace(start, length, other.substr(below(other.size()), length));
        return;
      }
      default:
        if (below(8) == 0) bytes.resize(start);  // the end is missing
    }
  }

  const Format& format_;
  std::vector<std::string> seeds_;
  std::size_t shortest_ = std::size_t{1} << 20, largest_ = 4096;
  std::mt19937_64 bits_{1};
};

std::vector<std::string> read_seeds(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> seeds;
  for (const auto& file : files) seeds.push_back(petzval::read_whole_file(file.string()));
  return seeds;
}

}  // namespace

int main(int argc, char** argv) {
  const Format* format = argc == 4 ? petzval::fuzz::find_format(argv[1]) : nullptr;
  if (!format) {
    std::fprintf(stderr, "usage: fuzz_runs FORMAT SEEDS RUNS\n");
    return 2;
  }
  std::vector<std::string> seeds = read_seeds(argv[2]);
  if (seeds.empty()) {
    std::fprintf(stderr, "%s holds no seeds\n", argv[2]);
    return 2;
  }
  // A seed that is refused leads nowhere.
  for (const std::string& seed : seeds)
    if (!format->entry(seed)) {
      std::fprintf(stderr, "a seed of %s is refused\n", argv[2]);
      return 1;
    }
  Mutator mutated(*format, std::move(seeds));
  const long runs = std::atol(argv[3]);
  long accepted = 0;
  for (long run = 0; run < runs; ++run) {
    try {
      accepted += format->entry(mutated());
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s: run %ld: %s\n", argv[1], run, error.what());
      return 1;
    }
  }
  std::printf("%s: %ld runs, %ld accepted\n", argv[1], runs, accepted);
  // A mutator that only ever makes what is refused at once tests nothing.
  return runs >= 1000 && accepted * 100 < runs ? 1 : 0;
}
