// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/stop.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/formats/output_file.h>
#include <petzval/image/formats/png.h>
#include <petzval/image/formats/png_stream.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <exception>
#include <optional>
#include <string_view>
#include <utility>

// libpng reports errors by longjmp. Here each call into it stands in a method of its own with its own setjmp
// and no local objects, so that no destructor is ever jumped over; the method then throws. Callbacks never
// throw.

namespace petzval {

namespace {

constexpr png_uint_32 max_png_side = 1u << 20;

struct PngError {
  char message[160] = "";
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  std::snprintf(static_cast<PngError*>(png_get_error_ptr(png))->message, sizeof(PngError::message), "%s",
                message);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

using CodePoints = std::array<unsigned char, 4>;

/// What a chunk cICP says (ITU-T H.273): primaries, transfer, matrix (0: RGB), full range.
constexpr std::pair<PngTransfer, CodePoints> code_points_of[] = {{PngTransfer::rec2100_pq, {9, 16, 0, 1}},
                                                                 {PngTransfer::rec2100_hlg, {9, 18, 0, 1}}};
constexpr CodePoints srgb_code_points = {1, 13, 0, 1}, linear_code_points = {1, 8, 0, 1};

// ---- writing

class Writer {
 public:
  Writer(OutputFile& file, const PngLayout& layout) : file_(file), layout_(layout) {
    png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, &error_, on_error, on_warning);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
    if (!info_) {
      png_destroy_write_struct(&png_, nullptr);
      throw Failure("no memory for a PNG writer");
    }
  }
  ~Writer() { png_destroy_write_struct(&png_, &info_); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void write_header() {
    if (setjmp(png_jmpbuf(png_))) fail();
    png_set_write_fn(png_, this, write_bytes, nullptr);
    constexpr int types[] = {0, PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                             PNG_COLOR_TYPE_RGB_ALPHA};
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(layout_.columns),
                 static_cast<png_uint_32>(layout_.rows), layout_.bits, types[layout_.channels],
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (!layout_.icc_profile.empty())
      png_set_iCCP(png_, info_, "ICC profile", PNG_COMPRESSION_TYPE_BASE,
                   reinterpret_cast<png_const_bytep>(layout_.icc_profile.data()),
                   static_cast<png_uint_32>(layout_.icc_profile.size()));
    else if (layout_.transfer == PngTransfer::srgb)
      png_set_sRGB_gAMA_and_cHRM(png_, info_, PNG_sRGB_INTENT_RELATIVE);
    if (layout_.transfer == PngTransfer::linear) png_set_gAMA_fixed(png_, info_, PNG_GAMMA_LINEAR);
    write_text();
    png_write_info(png_, info_);
  }
  /// What libpng 1.6 does not know.
  void write_further_chunks() {
    for (const auto& [transfer, code_points] : code_points_of)
      if (layout_.transfer == transfer) write_chunk("cICP", code_points);
    if (!layout_.exif.empty())
      write_chunk("eXIf", {reinterpret_cast<const unsigned char*>(layout_.exif.data()), layout_.exif.size()});
  }
  void write_pixels(std::span<const unsigned char> compressed) { write_chunk("IDAT", compressed); }
  void finish() { write_chunk("IEND", {}); }

 private:
  void write_chunk(const char* name, std::span<const unsigned char> bytes) {
    if (setjmp(png_jmpbuf(png_))) fail();
    png_write_chunk(png_, reinterpret_cast<png_const_bytep>(name), bytes.data(), bytes.size());
  }

  /// Called below a setjmp: has no objects to destroy when libpng jumps.
  void write_text() {
    for (const auto& entry : layout_.text) {
      png_text text{};
      text.compression = PNG_ITXT_COMPRESSION_NONE;
      text.key = const_cast<char*>(entry.first.c_str());
      text.text = const_cast<char*>(entry.second.c_str());
      text.itxt_length = entry.second.size();
      png_set_text(png_, info_, &text, 1);
    }
  }

  static void write_bytes(png_structp png, png_bytep bytes, png_size_t count) {
    Writer& self = *static_cast<Writer*>(png_get_io_ptr(png));
    try {
      self.file_.write(bytes, count);
      return;
    } catch (...) {
      self.reason_ = std::current_exception();
    }
    png_error(png, "cannot be written");
  }

  [[noreturn]] void fail() {
    if (reason_) std::rethrow_exception(reason_);
    throw Failure(fmt::format("{}: cannot be written: {}", file_.path(), error_.message));
  }

  OutputFile& file_;
  const PngLayout& layout_;
  PngError error_;
  std::exception_ptr reason_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

void check_layout(const std::string& path, const PngLayout& layout) {
  if (layout.columns < 1 || layout.rows < 1 || layout.columns > static_cast<int>(max_png_side) ||
      layout.rows > static_cast<int>(max_png_side))
    throw InputError(path, fmt::format("a picture of {} x {} pixels; each side must be 1 to {}",
                                       layout.columns, layout.rows, max_png_side));
  if (layout.channels < 1 || layout.channels > 4)
    throw InputError(path, fmt::format("a PNG of {} channels; it can have 1 to 4", layout.channels));
  if (layout.bits != 8 && layout.bits != 16)
    throw InputError(path, fmt::format("a PNG of {} bits; it can have 8 or 16", layout.bits));
  for (const auto& [key, text] : layout.text)
    if (key.empty() || key.size() > 79)
      throw InputError(path, "a PNG text keyword must have 1 to 79 characters");
}

/// PNG stores 16 bits high byte first.
void pack(std::span<const std::uint16_t> samples, int bits, std::span<unsigned char> bytes) {
  std::size_t i = 0;
  for (const std::uint16_t sample : samples) {
    if (bits == 16) bytes[i++] = static_cast<png_byte>(sample >> 8);
    bytes[i++] = static_cast<png_byte>(sample & 0xff);
  }
}

// ---- reading

class Reader {
 public:
  Reader(const std::string& path, std::string bytes) : path_(path), bytes_(std::move(bytes)), rest_(bytes_) {
    check_chunks();
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &error_, on_error, on_warning);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
    if (!info_) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw Failure("no memory for a PNG reader");
    }
  }
  ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  void read_header() {
    if (setjmp(png_jmpbuf(png_))) fail();
    png_set_user_limits(png_, max_png_side, max_png_side);
    constexpr png_alloc_size_t max_chunk_bytes = 1u << 24;
    png_set_chunk_malloc_max(png_, max_chunk_bytes);
    png_set_read_fn(png_, &rest_, read_bytes);
    png_read_info(png_, info_);
  }

  /// Size, channels and bits as the rows will have them.
  PngLayout layout() const {
    PngLayout layout;
    layout.columns = static_cast<int>(png_get_image_width(png_, info_));
    layout.rows = static_cast<int>(png_get_image_height(png_, info_));
    layout.bits = png_get_bit_depth(png_, info_) == 16 ? 16 : 8;
    const int type = png_get_color_type(png_, info_);
    const bool transparent = (type & PNG_COLOR_MASK_ALPHA) || png_get_valid(png_, info_, PNG_INFO_tRNS);
    layout.channels = ((type & PNG_COLOR_MASK_COLOR) ? 3 : 1) + (transparent ? 1 : 0);
    layout.transfer = transfer();
    layout.icc_profile = icc_profile();
    return layout;
  }

  /// Deflate makes at most 1032 bytes of one: a header that promises more than that lies.
  void check_size(const PngLayout& layout) const {
    const std::uint64_t pixels = std::uint64_t(layout.columns) * std::uint64_t(layout.rows);
    const std::uint64_t bits_per_pixel =
        std::uint64_t(png_get_bit_depth(png_, info_)) * png_get_channels(png_, info_);
    if (pixels * bits_per_pixel / 8 > 1032 * bytes_.size())
      throw InputError(path_, fmt::format("promises {} x {} pixels, but the file is too short for them",
                                          layout.columns, layout.rows));
    if (pixels > (std::uint64_t{1} << 29)) throw InputError(path_, "has more than 2^29 pixels");
  }

  /// Sets what is to be resolved while reading. \returns the bytes that libpng will write into each row.
  std::size_t prepare_rows() {
    if (setjmp(png_jmpbuf(png_))) fail();
    png_set_expand(png_);
    passes_ = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return png_get_rowbytes(png_, info_);
  }

  void read_rows(const std::vector<png_bytep>& rows) {
    for (int pass = 0; pass < passes_; ++pass)
      for (const png_bytep row : rows) {
        check_stop();
        read_row(row);
      }
    read_end();
  }

  void take_text(std::map<std::string, std::string>& text) const {
    png_textp entries = nullptr;
    const int count = png_get_text(png_, info_, &entries, nullptr);
    for (int i = 0; i < count; ++i)
      if (entries[i].key && entries[i].text) text[entries[i].key] = entries[i].text;
  }

 private:
  void read_row(png_bytep row) {
    if (setjmp(png_jmpbuf(png_))) fail();
    png_read_row(png_, row, nullptr);
  }

  void read_end() {
    if (setjmp(png_jmpbuf(png_))) fail();
    png_read_end(png_, info_);
  }

  /// libpng makes room for a chunk of the length that the file states; hold that against the file first. And
  /// libpng 1.6 does not know cICP.
  void check_chunks() {
    constexpr std::size_t signature = 8, framing = 12;  // length, name and checksum
    std::size_t left = bytes_.size() > signature ? bytes_.size() - signature : 0;
    while (left >= framing) {
      std::uint32_t length = 0;
      for (std::size_t i = 0; i < 4; ++i)
        length = length << 8 | static_cast<unsigned char>(bytes_[bytes_.size() - left + i]);
      if (length > left - framing)
        throw InputError(path_, "is not a sound PNG: the file ends within a chunk");
      const std::string_view chunk = rest_.substr(bytes_.size() - left + 4, 4 + length);
      if (CodePoints points; chunk.starts_with("cICP") && length == points.size()) {
        std::copy_n(chunk.substr(4).data(), points.size(), points.begin());
        code_points_ = points;
      }
      left -= framing + length;
    }
  }

  std::string icc_profile() const {
    png_charp name = nullptr;
    int compression = 0;
    png_bytep profile = nullptr;
    png_uint_32 size = 0;
    if (!png_get_iCCP(png_, info_, &name, &compression, &profile, &size)) return {};
    return {reinterpret_cast<const char*>(profile), size};
  }

  PngTransfer transfer() const {
    if (code_points_) {  // it comes before all other chunks
      for (const auto& [transfer, code_points] : code_points_of)
        if (*code_points_ == code_points) return transfer;
      return *code_points_ == srgb_code_points     ? PngTransfer::srgb
             : *code_points_ == linear_code_points ? PngTransfer::linear
                                                   : PngTransfer::other;
    }
    int intent = 0;
    png_fixed_point gamma = 0;
    if (png_get_sRGB(png_, info_, &intent)) return PngTransfer::srgb;
    if (png_get_gAMA_fixed(png_, info_, &gamma) && gamma == PNG_GAMMA_LINEAR) return PngTransfer::linear;
    return PngTransfer::unstated;
  }

  static void read_bytes(png_structp png, png_bytep bytes, png_size_t count) {
    std::string_view& rest = *static_cast<std::string_view*>(png_get_io_ptr(png));
    if (count > rest.size()) png_error(png, "the file ends too early");
    std::memcpy(bytes, rest.data(), count);
    rest.remove_prefix(count);
  }

  [[noreturn]] void fail() const {
    throw InputError(path_, fmt::format("is not a sound PNG: {}", error_.message));
  }

  const std::string& path_;
  std::string bytes_;
  std::string_view rest_;
  PngError error_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  int passes_ = 1;  ///< through interlaced rows
  std::optional<CodePoints> code_points_;
};

}  // namespace

void write_png(const std::string& path, const PngLayout& layout, const PngRowSource& row_source) {
  check_layout(path, layout);
  OutputFile file(path);
  Writer writer(file, layout);
  writer.write_header();
  writer.write_further_chunks();
  std::vector<std::uint16_t> samples(layout.row_samples());
  const auto sample_bytes = static_cast<std::size_t>(layout.bits / 8);
  compress_png_rows(
      layout.rows, samples.size() * sample_bytes, static_cast<std::size_t>(layout.channels) * sample_bytes,
      [&](int row, std::span<unsigned char> bytes) {
        row_source(row, samples);
        pack(samples, layout.bits, bytes);
      },
      [&](std::span<const unsigned char> piece) { writer.write_pixels(piece); });
  writer.finish();
  file.commit();
}

void write_png(const std::string& path, const PngImage& image) {
  check_layout(path, image);
  const std::span<const std::uint16_t> samples = image.samples;
  const std::size_t row_samples = image.row_samples();
  if (samples.size() != row_samples * static_cast<std::size_t>(image.rows))
    throw InputError(path, fmt::format("{} samples for a picture of {} x {} x {}", samples.size(),
                                       image.columns, image.rows, image.channels));
  write_png(path, static_cast<const PngLayout&>(image), [&](int row, std::span<std::uint16_t> out) {
    const auto source = samples.subspan(static_cast<std::size_t>(row) * row_samples, row_samples);
    std::copy(source.begin(), source.end(), out.begin());
  });
}

PngImage read_png(const std::string& path) {
  return parse_png(read_whole_file(path), path);
}

PngImage read_standard_png(const std::string& path) {
  PngImage image = read_png(path);
  if (image.transfer == PngTransfer::rec2100_pq || image.transfer == PngTransfer::rec2100_hlg ||
      image.transfer == PngTransfer::other)
    throw InputError(path,
                     "is of high dynamic range or of a wide gamut, by its chunk cICP; one in sRGB or linear "
                     "light would be right");
  return image;
}

PngImage parse_png(std::string bytes_of_file, const std::string& path) {
  Reader reader(path, std::move(bytes_of_file));
  reader.read_header();
  PngImage image;
  static_cast<PngLayout&>(image) = reader.layout();
  reader.check_size(image);

  const std::size_t row_bytes = image.row_samples() * static_cast<std::size_t>(image.bits / 8);
  if (reader.prepare_rows() != row_bytes)
    throw InputError(path, "is not a sound PNG: its rows have another size");
  std::vector<png_byte> bytes(row_bytes * static_cast<std::size_t>(image.rows));
  std::vector<png_bytep> rows(static_cast<std::size_t>(image.rows));
  for (std::size_t row = 0; row < rows.size(); ++row) rows[row] = bytes.data() + row * row_bytes;
  reader.read_rows(rows);
  reader.take_text(image.text);

  image.samples.resize(image.row_samples() * rows.size());
  for (std::size_t i = 0; i < image.samples.size(); ++i)
    image.samples[i] =
        image.bits == 8 ? bytes[i] : static_cast<std::uint16_t>(bytes[2 * i] << 8 | bytes[2 * i + 1]);
  return image;
}

}  // namespace petzval
