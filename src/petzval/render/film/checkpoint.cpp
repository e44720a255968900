// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/render/film/checkpoint.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <string_view>

namespace petzval::render {

namespace {

constexpr std::string_view magic = "petzval-render-checkpoint/7\n";
constexpr std::size_t most_checkpoint_bytes = std::size_t{1} << 36;

struct CheckpointHead {
  std::uint64_t fingerprint_size, rays, passed;
  PixelWindow window, whole;
  std::int32_t first_pass, passes;
  std::array<std::uint64_t, 10> sizes;  ///< of the sums
  std::uint64_t outside;
};
static_assert(sizeof(CheckpointHead) == 152, "without bytes that nobody writes");

struct OutsideSum {
  std::uint64_t at = 0, unused = 0;
  ExactSum light;
};

/// Of all that follows the magic line, in this order; CRC-32 as in zip and PNG.
std::uint32_t checksum(std::uint32_t so_far, const void* bytes, std::size_t count) {
  if (count == 0) return so_far;  // of no bytes at all zlib begins anew
  return static_cast<std::uint32_t>(crc32_z(so_far, static_cast<const Bytef*>(bytes), count));
}

template <typename AnyFilm>
auto all_sums_of(AnyFilm& film) {
  return std::array{&film.light, &film.of_sources, &film.half,   &film.half_first, &film.lamps,
                    &film.met,   &film.depth,      &film.normal, &film.albedo,     &film.arriving};
}

InputError damaged(const std::string& path, const char* how) {
  return InputError(path, fmt::format("is a damaged checkpoint: {}; delete it to start afresh", how));
}

std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(line.size() + 1, text.size()));
  return line;
}

/// The first line in which two fingerprints differ: one has it, and the other.
std::optional<std::array<std::string_view, 2>> first_difference(std::string_view a, std::string_view b) {
  while (!a.empty() || !b.empty()) {
    const std::string_view line_a = take_line(a), line_b = take_line(b);
    if (line_a != line_b) return std::array{line_a.substr(0, 300), line_b.substr(0, 300)};
  }
  return {};
}

std::string piece_text(const Film& film) {
  const PixelWindow& window = film.window;
  return fmt::format("pixels {},{} to {},{}, passes {} to {}", window.left, window.top, window.right - 1,
                     window.bottom - 1, film.first_pass + 1, film.end_pass());
}

/// A file of sums, taken apart from its front.
class CheckpointReader {
 public:
  explicit CheckpointReader(const std::string& path)
      : path_(path), text_(read_whole_file(path, most_checkpoint_bytes)), bytes_(text_) {
    if (bytes_.substr(0, magic.size()) != magic) {
      const bool other = bytes_.starts_with(magic.substr(0, magic.size() - 2));
      throw InputError(path_, other ? "is a checkpoint of another version of petzval render"
                                    : "is no checkpoint of petzval render");
    }
    bytes_.remove_prefix(magic.size());
    const std::string_view sound =
        bytes_.substr(0, bytes_.size() - std::min(bytes_.size(), sizeof(std::uint32_t)));
    sum_ = checksum(0, sound.data(), sound.size());
    take(&head_, sizeof head_);
    if (bytes_.size() < head_.fingerprint_size) throw damaged(path_, "it ends early");
    fingerprint_ = bytes_.substr(0, head_.fingerprint_size);
    bytes_.remove_prefix(fingerprint_.size());
  }

  const std::string& path() const { return path_; }
  const CheckpointHead& head() const { return head_; }
  std::string_view fingerprint() const { return fingerprint_; }

  /// The film that it holds. \throws InputError if it is damaged.
  Film film() {
    const PixelWindow &window = head_.window, &whole = head_.whole;
    if (window.left < whole.left || window.top < whole.top || window.right > whole.right ||
        window.bottom > whole.bottom || window.left >= window.right || window.top >= window.bottom ||
        head_.first_pass < 0 || head_.passes < 0)
      throw damaged(path_, "it holds no rectangle of a picture");
    Film film(window, 1, 1, false, Film::Half::none);
    film.whole = whole;
    film.first_pass = head_.first_pass, film.passes = head_.passes;
    film.rays = head_.rays, film.passed = head_.passed;
    const auto sums = all_sums_of(film);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      if (head_.sizes[i] > bytes_.size() / sizeof(ExactSum)) throw damaged(path_, "it ends early");
      sums[i]->resize(head_.sizes[i]);
      take(sums[i]->data(), sums[i]->size() * sizeof(ExactSum));
    }
    require_sizes(film);
    if (head_.outside > bytes_.size() / sizeof(OutsideSum)) throw damaged(path_, "it ends early");
    for (std::uint64_t i = 0; i < head_.outside; ++i) {
      OutsideSum each;
      take(&each, sizeof each);
      if (each.at >= film.arriving.size() * (1 + film.sources()) * whole.size())
        throw damaged(path_, "it has light beyond the picture");
      film.outside.emplace_hint(film.outside.end(), each.at, each.light);
    }
    std::uint32_t stated = 0;
    take(&stated, sizeof stated);
    if (!bytes_.empty()) throw damaged(path_, "it is too long");
    if (stated != sum_) throw damaged(path_, "its bytes are not those that were written");
    return film;
  }

 private:
  /// Planes of the window, one for each band where there are as many.
  void require_sizes(const Film& film) const {
    const std::size_t pixels = film.window.size(), bands = film.arriving.size();
    const auto planes = [&](const std::vector<ExactSum>& sums, std::size_t count) {
      return sums.size() == count * pixels;
    };
    const bool first = !film.met.empty();
    if (!planes(film.light, bands) ||
        film.of_sources.size() % std::max<std::size_t>(1, film.light.size()) != 0 || !planes(film.lamps, 1) ||
        !(film.half.empty() || planes(film.half, 1) || planes(film.half, bands)) ||
        !(film.half_first.empty() || film.half_first.size() == film.met.size() + (4 + bands) * pixels) ||
        film.met.size() % pixels != 0 || !planes(film.depth, first ? 1 : 0) ||
        !planes(film.normal, first ? 3 : 0) || !planes(film.albedo, first ? bands : 0))
      throw damaged(path_, "its sums are not those of a picture");
  }

  void take(void* to, std::size_t count) {
    if (bytes_.size() < count) throw damaged(path_, "it ends early");
    if (count > 0) std::memcpy(to, bytes_.data(), count);
    bytes_.remove_prefix(count);
  }

  std::string path_, text_;
  std::string_view bytes_, fingerprint_;
  CheckpointHead head_{};
  std::uint32_t sum_ = 0;
};

}  // namespace

void write_checkpoint(const std::string& path, const Film& film, const std::string& fingerprint) {
  WholeFile file(path);
  std::ofstream out(file.temporary_path(), std::ios::binary);
  CheckpointHead head{.fingerprint_size = fingerprint.size(),
                      .rays = film.rays,
                      .passed = film.passed,
                      .window = film.window,
                      .whole = film.whole,
                      .first_pass = film.first_pass,
                      .passes = film.passes,
                      .sizes = {},
                      .outside = film.outside.size()};
  const auto sums = all_sums_of(film);
  for (std::size_t i = 0; i < sums.size(); ++i) head.sizes[i] = sums[i]->size();
  std::uint32_t sum = 0;
  const auto write = [&](const void* bytes, std::size_t count) {
    out.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(count));
    sum = checksum(sum, bytes, count);
  };
  out.write(magic.data(), static_cast<std::streamsize>(magic.size()));
  write(&head, sizeof head);
  write(fingerprint.data(), fingerprint.size());
  for (const std::vector<ExactSum>* each : sums) write(each->data(), each->size() * sizeof(ExactSum));
  for (const auto& [at, light] : film.outside) {
    const OutsideSum each{at, 0, light};
    write(&each, sizeof each);
  }
  const std::uint32_t of_all = sum;
  write(&of_all, sizeof of_all);
  out.close();
  if (!out) throw Failure(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  file.commit();
}

bool read_checkpoint(const std::string& path, Film& film, const std::string& fingerprint) {
  if (!std::filesystem::exists(path)) return false;
  CheckpointReader reader(path);
  if (const auto difference = first_difference(reader.fingerprint(), fingerprint))
    throw InputError(path,
                     fmt::format("is the checkpoint of another picture: it has \"{}\", this one \"{}\"; "
                                 "delete it to start afresh, or name another file",
                                 (*difference)[0], (*difference)[1]));
  Film read = reader.film();
  if (read.window != film.window || read.whole != film.whole || read.first_pass != film.first_pass)
    throw InputError(path, fmt::format("has {} of the picture, which is another piece; name another file",
                                       piece_text(read)));
  const auto there = all_sums_of(read), here = all_sums_of(film);
  for (std::size_t i = 0; i < here.size(); ++i)
    if (there[i]->size() != here[i]->size()) throw damaged(path, "its sums are not those of this picture");
  film = std::move(read);
  return true;
}

namespace {

/// Where a piece lies in the picture and among its passes.
struct PieceBox {
  std::string path;
  PixelWindow window;
  int first_pass, end_pass;

  bool contains(int column, int row, int pass) const {
    return window.contains(column, row) && pass >= first_pass && pass < end_pass;
  }
  double volume() const { return static_cast<double>(window.size()) * (end_pass - first_pass); }
};

/// \throws InputError for what the last one has, and another too.
void require_no_overlap(const std::vector<PieceBox>& boxes) {
  const PieceBox& last = boxes.back();
  for (std::size_t i = 0; i + 1 < boxes.size(); ++i) {
    const PieceBox& other = boxes[i];
    const int column = std::max(last.window.left, other.window.left),
              row = std::max(last.window.top, other.window.top),
              pass = std::max(last.first_pass, other.first_pass);
    if (last.contains(column, row, pass) && other.contains(column, row, pass))
      throw InputError(last.path,
                       fmt::format("has pixel {},{} in pass {}, and so has {}; each once would be right",
                                   column, row, pass + 1, other.path));
  }
}

/// \throws InputError for what none has. A gap begins where the picture or a piece ends.
void require_no_gap(const std::vector<PieceBox>& boxes, const PixelWindow& whole, int passes) {
  double volume = 0;
  std::set<int> columns{whole.left}, rows{whole.top}, starts{0};
  for (const PieceBox& each : boxes) {
    volume += each.volume();
    columns.insert(each.window.right), rows.insert(each.window.bottom), starts.insert(each.end_pass);
  }
  if (volume == static_cast<double>(whole.size()) * passes) return;
  for (const int pass : starts)
    for (const int row : rows)
      for (const int column : columns)
        if (whole.contains(column, row) && pass < passes &&
            std::ranges::none_of(boxes, [&](const PieceBox& box) { return box.contains(column, row, pass); }))
          throw InputError(fmt::format("no piece has pixel {},{} in pass {}", column, row, pass + 1));
}

}  // namespace

MergeReport merge_checkpoints(const std::vector<std::string>& pieces, const std::string& path,
                              const ProgressCallback& progress) {
  if (pieces.empty()) throw InputError("there are no pieces to be merged");
  std::vector<PieceBox> boxes;
  std::string fingerprint;
  std::optional<Film> sum;
  int passes = 0;
  for (const std::string& each : pieces) {
    CheckpointReader reader(each);
    if (boxes.empty()) fingerprint = reader.fingerprint();
    if (const auto difference = first_difference(reader.fingerprint(), fingerprint))
      throw InputError(each, fmt::format("is a piece of another picture: it has \"{}\", {} has \"{}\"",
                                         (*difference)[0], pieces.front(), (*difference)[1]));
    Film piece = reader.film();
    if (!piece.half.empty())
      throw InputError(each,
                       "was rendered in two halves, to a noise or to be denoised, which pieces are not");
    if (!sum) {
      sum.emplace(piece.whole, static_cast<int>(piece.arriving.size()),
                  static_cast<int>(piece.met.size() / piece.window.size()), !piece.met.empty(),
                  Film::Half::none, piece.sources());
    }
    if (sum->whole != piece.whole) throw InputError(each, "is a piece of another rectangle of the film");
    if (piece.arriving.size() != sum->arriving.size() || piece.sources() != sum->sources() ||
        piece.met.size() * sum->window.size() != sum->met.size() * piece.window.size())
      throw damaged(each, "its sums are not those of this picture");
    boxes.push_back({each, piece.window, piece.first_pass, piece.end_pass()});
    require_no_overlap(boxes);
    sum->add(piece);
    passes = std::max(passes, piece.end_pass());
    if (progress) progress(static_cast<double>(boxes.size()) / static_cast<double>(pieces.size()), "pieces");
  }
  require_no_gap(boxes, sum->whole, passes);
  sum->passes = passes;
  write_checkpoint(path, *sum, fingerprint);
  return {sum->whole, passes, sum->rays};
}

}  // namespace petzval::render
