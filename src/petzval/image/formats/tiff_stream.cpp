// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/image/formats/tiff_stream.h>
#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <new>
#include <string_view>

namespace petzval {

namespace {

constexpr std::uint64_t big_tiff_from = 4'000'000'000;
constexpr tmsize_t max_single_allocation = tmsize_t{1} << 32;

/// The file as libtiff sees it through the callbacks below, none of which may throw.
struct Memory {
  std::string bytes, complaint;
  std::size_t position = 0;
  bool is_cut_short = false;
  std::vector<std::string> ignored_tags;
};

tmsize_t read_bytes(thandle_t data, void* into, tmsize_t count) {
  Memory& memory = *static_cast<Memory*>(data);
  if (memory.position >= memory.bytes.size() || count <= 0) return 0;
  const std::size_t n = std::min(static_cast<std::size_t>(count), memory.bytes.size() - memory.position);
  std::memcpy(into, memory.bytes.data() + memory.position, n);
  memory.position += n;
  return static_cast<tmsize_t>(n);
}

tmsize_t write_bytes(thandle_t data, void* from, tmsize_t count) {
  Memory& memory = *static_cast<Memory*>(data);
  try {
    const std::size_t end = memory.position + static_cast<std::size_t>(count);
    if (end > memory.bytes.size()) memory.bytes.resize(end);
  } catch (const std::bad_alloc&) {
    return 0;
  }
  std::memcpy(memory.bytes.data() + memory.position, from, static_cast<std::size_t>(count));
  memory.position += static_cast<std::size_t>(count);
  return count;
}

toff_t seek(thandle_t data, toff_t offset, int whence) {
  Memory& memory = *static_cast<Memory*>(data);
  if (whence == SEEK_CUR) offset += memory.position;
  if (whence == SEEK_END) offset += memory.bytes.size();
  memory.position = static_cast<std::size_t>(offset);
  return offset;
}

int close(thandle_t) {
  return 0;
}

toff_t size_of(thandle_t data) {
  return static_cast<Memory*>(data)->bytes.size();
}

int keep_complaint(TIFF*, void* data, const char*, const char* format, va_list arguments) {
  Memory& memory = *static_cast<Memory*>(data);
  char text[200];
  std::vsnprintf(text, sizeof text, format, arguments);
  if (memory.complaint.empty()) memory.complaint = text;
  return 1;
}

/// Warnings are no matter, but for two: that the value of a tag lies beyond the end of the file, and that a
/// tag was ignored.
int look_at_warning(TIFF*, void* data, const char*, const char* format, va_list arguments) {
  Memory& memory = *static_cast<Memory*>(data);
  char text[200];
  std::vsnprintf(text, sizeof text, format, arguments);
  const std::string_view warning = text;
  try {
    if (warning.starts_with("IO error")) {
      memory.is_cut_short = true;
      if (memory.complaint.empty()) memory.complaint = warning;
    } else if (warning.ends_with("; tag ignored")) {
      const std::size_t from = warning.find('"') + 1, to = warning.find('"', from);
      if (to != warning.npos) memory.ignored_tags.emplace_back(warning.substr(from, to - from));
    }
  } catch (const std::bad_alloc&) {
    memory.is_cut_short = true;  // what cannot be told is no reason to go on
  }
  return 1;
}

TIFF* open(Memory& memory, const char* mode) {
  TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
  if (!options) throw std::bad_alloc();
  TIFFOpenOptionsSetMaxSingleMemAlloc(options, max_single_allocation);
  TIFFOpenOptionsSetErrorHandlerExtR(options, keep_complaint, &memory);
  TIFFOpenOptionsSetWarningHandlerExtR(options, look_at_warning, &memory);
  TIFF* handle = TIFFClientOpenExt("", mode, &memory, read_bytes, write_bytes, seek, close, size_of, nullptr,
                                   nullptr, options);
  TIFFOpenOptionsFree(options);
  return handle;
}

}  // namespace

struct TiffStream::State : Memory {
  std::string path;
  bool writing = false;
  TIFF* handle = nullptr;

  ~State() {
    if (handle) TIFFClose(handle);
  }
};

TiffStream::TiffStream(std::unique_ptr<State> state) : state_(std::move(state)) {}

TiffStream::TiffStream(std::string path, std::uint64_t expected_bytes) : state_(new State) {
  state_->path = std::move(path);
  state_->writing = true;
  constexpr std::size_t room_for_tags = 1 << 16;
  state_->bytes.reserve(expected_bytes + room_for_tags);  // it would grow, and be copied, piece by piece
  state_->handle = open(*state_, expected_bytes > big_tiff_from ? "w8l" : "wl");
  require(state_->handle != nullptr);
}

TiffStream TiffStream::reader(std::string path, std::string bytes) {
  auto state = std::make_unique<State>();
  state->path = std::move(path);
  state->bytes = std::move(bytes);
  state->handle = open(*state, "r");
  TiffStream stream(std::move(state));
  stream.require(stream.state_->handle != nullptr);
  return stream;
}

TiffStream::~TiffStream() = default;
TiffStream::TiffStream(TiffStream&&) noexcept = default;

tiff* TiffStream::handle() const {
  return state_->handle;
}

const std::string& TiffStream::path() const {
  return state_->path;
}

std::size_t TiffStream::size() const {
  return state_->bytes.size();
}

void TiffStream::require_whole() const {
  if (state_->is_cut_short) fail("the file is cut short");
}

const std::vector<std::string>& TiffStream::ignored_tags() const {
  return state_->ignored_tags;
}

void TiffStream::require(bool success) const {
  if (!success) fail("libtiff does not say why");
}

void TiffStream::fail(const std::string& what) const {
  std::string reason = state_->complaint.empty() ? what : state_->complaint;
  std::replace_if(
      reason.begin(), reason.end(), [](unsigned char c) { return c < ' ' || c > '~'; }, '?');
  if (state_->writing) throw Failure(fmt::format("{}: cannot be written: {}", state_->path, reason));
  throw InputError(state_->path, "is not a sound TIFF file: " + reason);
}

std::string TiffStream::finish() {
  require(TIFFFlush(state_->handle) != 0);
  TIFFClose(state_->handle);
  state_->handle = nullptr;
  return std::move(state_->bytes);
}

}  // namespace petzval
