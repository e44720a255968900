// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/sensor/formats/original_raw.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string_view>

namespace petzval {

namespace {

// libtiff 4.5 counts the bytes of this tag in 16 bits: its entry is written and read here.
constexpr std::uint32_t original_raw_tag = 50828, type_undefined = 7;
constexpr std::size_t entry_bytes = 12, head_bytes = 8, block_bytes = 1 << 16, word = 4;
constexpr std::size_t most_expansion = 1032;  // of Deflate

void add_big_endian(std::string& bytes, std::size_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
}

std::uint32_t number(std::string_view bytes, std::size_t at, std::size_t size, bool low_byte_first) {
  if (at > bytes.size() || bytes.size() - at < size) throw InputError("a raw file within it ends too early");
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t byte = low_byte_first ? size - 1 - i : i;
    value = value << 8 | static_cast<std::uint8_t>(bytes[at + byte]);
  }
  return value;
}
std::uint32_t little(std::string_view bytes, std::size_t at, std::size_t size) {
  return number(bytes, at, size, true);
}
std::uint32_t big(std::string_view bytes, std::size_t at) {
  return number(bytes, at, word, false);
}

bool low_byte_first_tiff(std::string_view bytes) {
  return bytes.size() >= head_bytes && bytes.substr(0, word) == std::string_view("II*\0", word);
}

/// Length, places of the deflated blocks and where they end, the blocks.
std::string compressed_fork(const std::string& data) {
  std::string fork, blocks;
  const std::size_t count = (data.size() + block_bytes - 1) / block_bytes;
  add_big_endian(fork, data.size());
  for (std::size_t i = 0; i < count; ++i) {
    add_big_endian(fork, word * (count + 2) + blocks.size());
    const std::size_t length = std::min(block_bytes, data.size() - i * block_bytes);
    uLongf packed = compressBound(static_cast<uLong>(length));
    std::string block(packed, '\0');
    if (compress2(reinterpret_cast<Bytef*>(block.data()), &packed,
                  reinterpret_cast<const Bytef*>(data.data() + i * block_bytes), static_cast<uLong>(length),
                  Z_DEFAULT_COMPRESSION) != Z_OK)
      throw Failure("a raw file cannot be deflated");
    blocks.append(block, 0, packed);
  }
  add_big_endian(fork, word * (count + 2) + blocks.size());
  return fork + blocks;
}

std::string inflated_fork(std::string_view fork) {
  const std::size_t length = big(fork, 0), count = (length + block_bytes - 1) / block_bytes;
  if (length > most_expansion * fork.size()) throw InputError("a raw file within it ends too early");
  std::string data(length, '\0');
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = big(fork, word * (i + 1)), end = big(fork, word * (i + 2));
    const std::size_t wanted = std::min(block_bytes, length - i * block_bytes);
    uLongf got = static_cast<uLongf>(wanted);
    if (begin > end || end > fork.size() ||
        uncompress(reinterpret_cast<Bytef*>(data.data() + i * block_bytes), &got,
                   reinterpret_cast<const Bytef*>(fork.data() + begin),
                   static_cast<uLong>(end - begin)) != Z_OK ||
        got != wanted)
      throw InputError("a raw file within it is damaged");
  }
  return data;
}

}  // namespace

std::string with_original_raw(const std::string& dng, const std::string& original) {
  if (!low_byte_first_tiff(dng)) throw InputError("a raw file goes into a TIFF file with the low byte first");
  const std::string fork = compressed_fork(original);
  std::string whole = dng;
  whole.resize((whole.size() + 1) / 2 * 2);
  const std::size_t fork_place = whole.size();
  whole += fork;
  whole.resize((whole.size() + 1) / 2 * 2);
  const std::size_t directory_place = whole.size();
  if (original.size() > std::numeric_limits<std::uint32_t>::max() ||
      directory_place > std::numeric_limits<std::uint32_t>::max() - block_bytes)
    throw InputError("a raw file and a picture of more than 4 GB do not go into one DNG");

  const auto add_little = [](std::string& bytes, std::size_t value, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(value >> 8 * i & 0xff);
  };
  std::string entry;
  add_little(entry, original_raw_tag, 2), add_little(entry, type_undefined, 2);
  add_little(entry, fork.size(), word), add_little(entry, fork_place, word);

  // The first directory is written anew at the end, with one entry more: they stand in the order of tags.
  const std::size_t old_place = little(dng, word, word), count = little(dng, old_place, 2);
  const std::string_view old(dng);
  std::size_t before = 0;
  while (before < count && little(dng, old_place + 2 + entry_bytes * before, 2) < original_raw_tag) ++before;
  const std::size_t entries = old_place + 2, end = entries + entry_bytes * count;
  little(dng, end, word);  // is there
  add_little(whole, count + 1, 2);
  whole += old.substr(entries, entry_bytes * before);
  whole += entry;
  whole += old.substr(entries + entry_bytes * before, entry_bytes * (count - before) + word);
  std::string place;
  add_little(place, directory_place, word);
  whole.replace(word, word, place);
  return whole;
}

std::optional<std::string> original_raw(const std::string& dng) {
  if (!low_byte_first_tiff(dng)) return {};
  const std::size_t place = little(dng, word, word), count = little(dng, place, 2);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t entry = place + 2 + entry_bytes * i;
    if (little(dng, entry, 2) != original_raw_tag) continue;
    const std::size_t size = little(dng, entry + word, word), at = little(dng, entry + 2 * word, word);
    if (at > dng.size() || dng.size() - at < size) throw InputError("a raw file within it ends too early");
    return inflated_fork(std::string_view(dng).substr(at, size));
  }
  return {};
}

}  // namespace petzval
