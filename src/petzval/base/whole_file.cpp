// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/stop.h>
#include <petzval/base/whole_file.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

namespace petzval {

namespace fs = std::filesystem;

namespace {

std::string temporary_name(const std::string& path) {
  static std::atomic<unsigned> counter{0};
  const fs::path final_path(path);
  fs::path aside = final_path.parent_path() / fmt::format(".{}.{}-{}{}", final_path.stem().string(), getpid(),
                                                          counter++, final_path.extension().string());
  return aside.string();
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using FileHandle = std::unique_ptr<std::FILE, CloseFile>;

}  // namespace

WholeFile::WholeFile(std::string path) : path_(std::move(path)) {
  if (path_.empty()) throw InputError("an output file needs a name");
  std::error_code ignored;
  if (fs::is_directory(path_, ignored)) throw InputError(path_, "is a folder; give the name of a file in it");
  if (fs::exists(path_, ignored) && !fs::is_regular_file(path_, ignored))
    throw InputError(path_,
                     "is a pipe or a device; output is renamed into place, so it needs an ordinary file");
  // Through a link the file that it points to is replaced, not the link.
  if (fs::is_symlink(path_, ignored)) path_ = fs::weakly_canonical(path_, ignored).string();
  const fs::path folder = fs::path(path_).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, ignored))
    throw InputError(path_, fmt::format("the folder {} does not exist; make it first", folder.string()));
  temporary_ = temporary_name(path_);
  if (std::error_code error; !fs::exists(temporary_, error) && error == std::errc::filename_too_long)
    throw InputError(path_, "is too long a name for a file; a shorter one would be right");
}

WholeFile::~WholeFile() {
  std::error_code ignored;
  if (!committed_) fs::remove(temporary_, ignored);
}

void WholeFile::commit() {
  const int descriptor = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw Failure(fmt::format("{}: cannot be written: {}", path_, std::strerror(errno)));
  const int synced = ::fsync(descriptor);
  const int reason = errno;
  ::close(descriptor);
  // Some file systems cannot fsync (EINVAL): that is no reason to lose the picture.
  if (synced != 0 && reason != EINVAL)
    throw Failure(fmt::format("{}: cannot be written: {}", path_, std::strerror(reason)));
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) throw Failure(fmt::format("{}: cannot be written: {}", path_, error.message()));
  committed_ = true;
}

void require_writable(const std::string& path) {
  const WholeFile file(path);
  // An open that succeeds tells more than permissions do: file systems are read-only or made of something
  // else.
  const FileHandle handle(std::fopen(file.temporary_path().c_str(), "wb"));
  if (!handle) throw Failure(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
}

void write_whole_file(const std::string& path, std::string_view bytes) {
  WholeFile file(path);
  FileHandle handle(std::fopen(file.temporary_path().c_str(), "wb"));
  if (!handle) throw Failure(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), handle.get()) == bytes.size();
  if (!written || std::fflush(handle.get()) != 0)
    throw Failure(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  handle.reset();
  file.commit();
}

std::string read_whole_file(const std::string& path, std::size_t max_bytes) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw InputError(path, "is a folder, not a file");
  FileHandle handle(std::fopen(path.c_str(), "rb"));
  if (!handle) throw InputError(path, fmt::format("cannot be read: {}", std::strerror(errno)));
  std::string bytes;
  char block[1 << 16];
  for (std::size_t got; (got = std::fread(block, 1, sizeof block, handle.get())) > 0;) {
    check_stop();
    bytes.append(block, got);
    if (bytes.size() > max_bytes) throw InputError(path, fmt::format("is larger than {} bytes", max_bytes));
  }
  if (std::ferror(handle.get()))
    throw InputError(path, fmt::format("cannot be read: {}", std::strerror(errno)));
  return bytes;
}

}  // namespace petzval
