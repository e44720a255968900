// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/render/film/film.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace petzval::render {

namespace {

/// 16 GiB of sums.
constexpr double most_values = 2147483648.0;
constexpr std::string_view magic = "petzval-render-checkpoint/4\n";

struct CheckpointHead {
  std::uint64_t fingerprint_size, rays, passed;
  std::int64_t passes;
};

/// Of all that follows the magic line, in this order; CRC-32 as in zip and PNG.
std::uint32_t checksum(std::uint32_t so_far, const void* bytes, std::size_t count) {
  if (count == 0) return so_far;  // of no bytes at all zlib begins anew
  return static_cast<std::uint32_t>(crc32_z(so_far, static_cast<const Bytef*>(bytes), count));
}

/// Takes bytes from the front of a text, checking that they are there.
void take(std::string_view& bytes, void* to, std::size_t count, const std::string& path) {
  if (bytes.size() < count)
    throw InputError(path, "is a damaged checkpoint: it ends early; delete it to start afresh");
  if (count > 0) std::memcpy(to, bytes.data(), count);
  bytes.remove_prefix(count);
}

std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(line.size() + 1, text.size()));
  return line;
}

/// \throws InputError with the first line in which two fingerprints differ.
void require_same(std::string_view there, std::string_view here, const std::string& path) {
  while (!there.empty() || !here.empty()) {
    const std::string_view old_line = take_line(there), new_line = take_line(here);
    if (old_line != new_line)
      throw InputError(path,
                       fmt::format("is the checkpoint of another picture: it has \"{}\", this one \"{}\"; "
                                   "delete it to start afresh, or name another file",
                                   old_line.substr(0, 300), new_line.substr(0, 300)));
  }
}

/// Of a film or a const one.
template <typename AnyFilm>
auto sums_of(AnyFilm& film) {
  return std::array{&film.light, &film.half, &film.lamps, &film.met, &film.depth, &film.normal, &film.albedo};
}

/// Row by row, where a tile's sums stand in those of a window that holds it.
template <typename Copy>
void each_row(const PixelWindow& window, const PixelWindow& tile, std::size_t planes, const Copy& copy) {
  const auto columns = static_cast<std::size_t>(tile.columns());
  for (std::size_t plane = 0; plane < planes; ++plane)
    for (int row = tile.top; row < tile.bottom; ++row)
      copy(plane * window.size() + window.index(tile.left, row),
           plane * tile.size() + tile.index(tile.left, row), columns);
}

}  // namespace

Film::Film(const PixelWindow& pixels, int bands, int groups, bool first_surfaces, bool noise)
    : window(pixels) {
  const double values =
      static_cast<double>(pixels.size()) * (bands * (first_surfaces ? 2.0 : 1.0) + groups + 6);
  if (values > most_values)
    throw InputError(
        fmt::format("a picture of {} x {} pixels and {} bands needs {:.0f} GiB to gather its light in; fewer "
                    "pixels or bands would fit",
                    pixels.columns(), pixels.rows(), bands, values * 8 / 1073741824));
  light.assign(pixels.size() * static_cast<std::size_t>(bands), 0.0);
  arriving.assign(static_cast<std::size_t>(bands), 0.0);
  lamps.assign(pixels.size(), 0.0);
  if (noise) half.assign(pixels.size(), 0.0);
  if (!first_surfaces) return;
  met.assign(pixels.size() * static_cast<std::size_t>(groups), 0.0);
  depth.assign(pixels.size(), 0.0);
  normal.assign(3 * pixels.size(), 0.0);
  albedo.assign(light.size(), 0.0);
}

Film Film::part(const PixelWindow& tile) const {
  Film result;
  result.window = tile;
  const auto from = sums_of(*this);
  const auto to = sums_of(result);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::size_t planes = from[i]->size() / window.size();
    to[i]->resize(planes * tile.size());
    each_row(window, tile, planes, [&](std::size_t here, std::size_t there, std::size_t count) {
      std::copy_n(from[i]->begin() + static_cast<std::ptrdiff_t>(here), count,
                  to[i]->begin() + static_cast<std::ptrdiff_t>(there));
    });
  }
  return result;
}

void Film::put(const Film& tile) {
  const auto from = sums_of(tile);
  const auto to = sums_of(*this);
  for (std::size_t i = 0; i < from.size(); ++i)
    each_row(window, tile.window, from[i]->size() / tile.window.size(),
             [&](std::size_t here, std::size_t there, std::size_t count) {
               std::copy_n(from[i]->begin() + static_cast<std::ptrdiff_t>(there), count,
                           to[i]->begin() + static_cast<std::ptrdiff_t>(here));
             });
}

void write_checkpoint(const std::string& path, const Film& film, const std::string& fingerprint) {
  WholeFile file(path);
  std::ofstream out(file.temporary_path(), std::ios::binary);
  const CheckpointHead head{fingerprint.size(), film.rays, film.passed, film.passes};
  std::uint32_t sum = 0;
  const auto write = [&](const void* bytes, std::size_t count) {
    out.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(count));
    sum = checksum(sum, bytes, count);
  };
  out.write(magic.data(), static_cast<std::streamsize>(magic.size()));
  write(&head, sizeof head);
  write(fingerprint.data(), fingerprint.size());
  for (const std::vector<double>* sums : sums_of(film)) write(sums->data(), sums->size() * sizeof(double));
  write(film.arriving.data(), film.arriving.size() * sizeof(double));
  const std::uint32_t of_all = sum;
  write(&of_all, sizeof of_all);
  out.close();
  if (!out) throw Failure(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  file.commit();
}

bool read_checkpoint(const std::string& path, Film& film, const std::string& fingerprint) {
  if (!std::filesystem::exists(path)) return false;
  const std::string text = read_whole_file(path, std::size_t{1} << 36);
  std::string_view bytes(text);
  if (bytes.substr(0, magic.size()) != magic) throw InputError(path, "is no checkpoint of petzval render");
  bytes.remove_prefix(magic.size());
  const std::string_view sound =
      bytes.substr(0, bytes.size() - std::min(bytes.size(), sizeof(std::uint32_t)));
  CheckpointHead head{};
  take(bytes, &head, sizeof head, path);
  if (bytes.size() < head.fingerprint_size)
    throw InputError(path, "is a damaged checkpoint: it ends early; delete it to start afresh");
  require_same(bytes.substr(0, head.fingerprint_size), fingerprint, path);
  bytes.remove_prefix(fingerprint.size());
  Film read = film;
  for (std::vector<double>* sums : sums_of(read))
    take(bytes, sums->data(), sums->size() * sizeof(double), path);
  take(bytes, read.arriving.data(), read.arriving.size() * sizeof(double), path);
  std::uint32_t sum = 0;
  take(bytes, &sum, sizeof sum, path);
  if (!bytes.empty())
    throw InputError(path, "is a damaged checkpoint: it is too long; delete it to start afresh");
  if (sum != checksum(0, sound.data(), sound.size()))
    throw InputError(
        path,
        "is a damaged checkpoint: its bytes are not those that were written; delete it to start afresh");
  read.rays = head.rays, read.passed = head.passed, read.passes = static_cast<int>(head.passes);
  film = std::move(read);
  return true;
}

}  // namespace petzval::render
