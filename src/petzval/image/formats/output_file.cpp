// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/image/formats/output_file.h>

#include <cerrno>
#include <cstring>

namespace petzval {

OutputFile::OutputFile(const std::string& path)
    : whole_(path), file_(std::fopen(whole_.temporary_path().c_str(), "wb")) {
  if (!file_) fail();
}

void OutputFile::fail() const {
  throw Failure(fmt::format("{}: cannot be written: {}", path(), std::strerror(errno)));
}

void OutputFile::write(const void* bytes, std::size_t count) {
  if (std::fwrite(bytes, 1, count, file_.get()) != count) fail();
}

std::uint64_t OutputFile::position() const {
  return static_cast<std::uint64_t>(ftello(file_.get()));
}

void OutputFile::seek(std::uint64_t position) {
  if (fseeko(file_.get(), static_cast<off_t>(position), SEEK_SET) != 0) fail();
}

void OutputFile::commit() {
  if (std::fclose(file_.release()) != 0) fail();
  whole_.commit();
}

}  // namespace petzval
