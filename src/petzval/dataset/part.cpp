// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/whole_file.h>
#include <petzval/dataset/part.h>
#include <petzval/dataset/tar_file.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

namespace petzval {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// Held by one process as long as it lives, on whatever machine. The file goes with it.
class PartLock {
 public:
  explicit PartLock(std::string path)
      : path_(std::move(path)), file_(::open(path_.c_str(), O_CREAT | O_RDWR, 0644)) {
    if (file_ < 0) throw Failure(path_ + ": cannot be written");
    held_ = ::flock(file_, LOCK_EX | LOCK_NB) == 0;
  }
  ~PartLock() {
    if (held_) ::unlink(path_.c_str());
    ::close(file_);
  }
  PartLock(const PartLock&) = delete;
  PartLock& operator=(const PartLock&) = delete;

  bool is_held() const { return held_; }

 private:
  std::string path_;
  int file_;
  bool held_ = false;
};

/// A file under a name that is its own alone while it is not whole; a process that was killed leaves it to be
/// written over by the next.
class PartFile {
 public:
  explicit PartFile(std::string path) : path_(std::move(path)), making_(in_making(path_)) {}
  ~PartFile() {
    std::error_code ignored;
    if (!committed_) fs::remove(making_, ignored);
  }
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  const std::string& making() const { return making_; }
  void commit() {
    const int file = ::open(making_.c_str(), O_RDONLY);
    const bool safe = file >= 0 && ::fsync(file) == 0;
    if (file >= 0) ::close(file);
    std::error_code failed;
    if (safe) fs::rename(making_, path_, failed);
    if (!safe || failed) throw Failure(path_ + ": cannot be written; is the disk full?");
    committed_ = true;
  }

 private:
  static std::string in_making(const std::string& path) {
    const fs::path whole(path);
    return (whole.parent_path() / ("." + whole.filename().string() + ".making")).string();
  }

  std::string path_, making_;
  bool committed_ = false;
};

struct MadeItem {
  json facts;
  std::vector<ItemFile> files;
  bool failed = false;
};

MadeItem make_item(const Recipe& recipe, ItemMaker& maker, std::size_t number) {
  MadeItem made;
  try {
    Item item = maker.make(number);
    made.facts = std::move(item.facts), made.files = std::move(item.files);
  } catch (const InputError& error) {
    made.failed = true;
    json parameters = json::object();
    for (const auto& [name, value] : draw_item(recipe, number))
      std::visit([&, &key = name](const auto& each) { parameters[key] = each; }, value);
    made.facts = {{"item", number},
                  {"key", ItemMaker::key(number)},
                  {"parameters", parameters},
                  {"error", error.what()}};
  }
  return made;
}

/// What a process that was killed was about to write. \pre  the part's lock is held.
void remove_unfinished(const std::string& folder, std::size_t number) {
  const std::string begins = fmt::format(".part-{:05}.", number);
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (const std::string name = entry.path().filename(); name.starts_with(begins) && name != begins + "lock")
      found.push_back(entry.path());
  std::error_code ignored;
  for (const fs::path& path : found) fs::remove(path, ignored);
}

/// Adds an item's files to the archive and its line to the others.
void store(MadeItem& item, TarWriter& archive, std::string& lines) {
  json line = item.facts;
  if (!item.failed) {
    item.files.push_back({"json", item.facts.dump()});
    for (const ItemFile& file : item.files) {
      archive.add(item.facts["key"].get<std::string>() + "." + file.extension, file.bytes);
      line["files"][file.extension] = {{"bytes", file.bytes.size()}, {"crc32", crc32_text(file.bytes)}};
    }
  }
  lines += line.dump() + "\n";
  item = {};
}

}  // namespace

std::size_t items_at_once(std::size_t items) {
  constexpr std::size_t most = 8;
  return std::min({most, static_cast<std::size_t>(thread_count()), items});
}

std::string PartSums::text() const {
  return json{{"part", part},
              {"items", items},
              {"failed", failed},
              {"archive_bytes", archive_bytes},
              {"archive_crc32", archive_crc32},
              {"lines_crc32", lines_crc32}}
             .dump() +
         "\n";
}

PartSums PartSums::parse(const std::string& text, const std::string& file) {
  try {
    const json root = json::parse(text);
    const PartSums sums{root.at("part"),          root.at("items"),         root.at("failed"),
                        root.at("archive_bytes"), root.at("archive_crc32"), root.at("lines_crc32")};
    if (sums.text() == text) return sums;
  } catch (const json::exception&) {
  }
  throw InputError(file, "is damaged");
}

std::string DatasetPart::path(const char* extension) const {
  return fmt::format("{}/part-{:05}.{}", folder_, number_, extension);
}

bool DatasetPart::is_done() const {
  std::error_code failed;
  return fs::is_regular_file(path("json"), failed);
}

std::optional<PartSums> DatasetPart::make(const Recipe& recipe, ItemMaker& maker,
                                          const std::function<void()>& made) const {
  const PartLock lock(fmt::format("{}/.part-{:05}.lock", folder_, number_));
  if (!lock.is_held() || is_done()) return {};
  remove_unfinished(folder_, number_);
  const auto [first, last] = recipe.items_of(number_);
  PartFile archive_file(path("tar")), lines_file(path("jsonl"));
  TarWriter archive(archive_file.making());
  PartSums sums{.part = number_, .items = last - first};
  std::string lines;
  const std::size_t slots = items_at_once(sums.items);
  std::vector<MadeItem> waiting(slots);
  parallel_stages(sums.items, slots,
                  {[](std::size_t, std::size_t) {},
                   [&, start = first](std::size_t item, std::size_t slot) {
                     waiting[slot] = make_item(recipe, maker, start + item);
                   },
                   [&](std::size_t, std::size_t slot) {
                     sums.failed += waiting[slot].failed ? 1 : 0;
                     store(waiting[slot], archive, lines);
                     made();
                   }});
  archive.finish();
  sums.archive_bytes = archive.bytes();
  sums.archive_crc32 = archive.crc32();
  sums.lines_crc32 = crc32_text(lines);
  write_whole_file(lines_file.making(), lines);
  archive_file.commit();
  lines_file.commit();
  write_whole_file(path("json"), sums.text());
  return sums;
}

PartSums DatasetPart::sums() const {
  return PartSums::parse(read_whole_file(path("json")), path("json"));
}

std::vector<json> DatasetPart::lines() const {
  std::vector<json> all;
  const std::string text = read_whole_file(path("jsonl"));
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    try {
      all.push_back(json::parse(text.substr(from, end - from)));
    } catch (const json::exception&) {
      throw InputError(path("jsonl"), static_cast<int>(all.size()) + 1, "is damaged");
    }
    from = end + 1;
  }
  return all;
}

namespace {

/// Compares the files of an archive with the lines and the sums that tell of them.
void compare(const std::string& archive, const std::vector<json>& lines, const PartSums& sums) {
  TarReader reader(archive);
  std::string name, bytes;
  std::map<std::string, std::pair<std::size_t, std::string>> wanted;
  for (const json& line : lines)
    if (line.contains("files"))
      for (const auto& [extension, file] : line["files"].items())
        wanted[line.at("key").get<std::string>() + "." + extension] = {file.at("bytes"), file.at("crc32")};
  while (reader.next(name, bytes)) {
    const auto found = wanted.find(name);
    if (found == wanted.end()) throw InputError(archive, name + " is not in the lines of facts");
    if (found->second != std::pair(bytes.size(), crc32_text(bytes)))
      throw InputError(archive, name + " is damaged");
    wanted.erase(found);
  }
  if (!wanted.empty()) throw InputError(archive, wanted.begin()->first + " is missing");
  if (reader.crc32() != sums.archive_crc32 || fs::file_size(archive) != sums.archive_bytes)
    throw InputError(archive, "is not the archive that its sums are of");
}

}  // namespace

std::vector<std::string> DatasetPart::faults(const Recipe& recipe) const {
  std::vector<std::string> all;
  const auto tell = [&](const auto& work) {
    try {
      work();
    } catch (const InputError& error) {
      all.push_back(error.what());
    } catch (const json::exception&) {
      all.push_back(path("jsonl") + ": is damaged");
    }
  };
  std::optional<PartSums> stated;
  tell([&] { stated = sums(); });
  if (!stated) return all;
  const auto [first, last] = recipe.items_of(number_);
  if (stated->part != number_ || stated->items != last - first)
    all.push_back(path("json") + ": is of another part");
  tell([&] {
    const std::string text = read_whole_file(path("jsonl"));
    if (crc32_text(text) != stated->lines_crc32) throw InputError(path("jsonl"), "is damaged");
  });
  tell([&] { compare(path("tar"), lines(), *stated); });
  return all;
}

}  // namespace petzval
