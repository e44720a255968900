// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/version.h>
#include <petzval/base/whole_file.h>
#include <petzval/simulate/image_pieces.h>
#include <petzval/simulate/lens_fingerprint.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string_view>

namespace petzval {

namespace {

constexpr std::string_view magic = "petzval-image-bands/1\n";

struct BandsHead {
  std::uint64_t fingerprint_size = 0, plane = 0;  ///< values of a band
  std::int32_t first = 0, end = 0, bands = 0, unused = 0;
};
static_assert(sizeof(BandsHead) == 32, "without bytes that nobody writes");

/// CRC-32 as in zip and PNG.
class Checksum {
 public:
  void add(const void* bytes, std::size_t count) {
    if (count > 0) sum_ = crc32_z(sum_, static_cast<const Bytef*>(bytes), count);
  }
  template <typename Value>
  void add(std::span<const Value> values) {
    add(values.data(), values.size_bytes());
  }
  std::uint32_t value() const { return static_cast<std::uint32_t>(sum_); }

 private:
  uLong sum_ = 0;
};

std::string lens_table_text(const LensDataTable& table) {
  Checksum sum;
  const auto add = [&](const std::vector<double>& values) { sum.add(std::span(values)); };
  add(table.fields), add(table.real_image_height_mm), add(table.g_source_sr), add(table.g_sensor_sr);
  if (table.frame) {
    add(table.frame->x_mm), add(table.frame->y_mm), add(table.frame->object_x);
    add(table.frame->object_y), add(table.frame->psf_azimuth_deg);
  }
  for (const Psf& psf : table.psf) {
    const double shape[] = {static_cast<double>(psf.size), psf.spacing_um};
    sum.add(std::span<const double>(shape));
    sum.add(std::span<const float>(psf.values));
  }
  return fmt::format("{}, {} mm to the sensor, {:08x}", table.lens_name, table.vertex_to_sensor_mm,
                     sum.value());
}

/// What the layers of a scene with depth are imaged with.
std::string depth_text(const ImagePlan& plan) {
  const DepthCamera& camera = *plan.depth;
  const TableOptions& table = camera.table;
  const std::array<double, 2> frame_mm = table.half_frame_mm.value_or(std::array{0.0, 0.0});
  Checksum depths;
  depths.add(std::span<const float>(plan.scene.depth_m));
  return fmt::format("depths {:08x}, reference {}, {} layers\n", depths.value(),
                     static_cast<int>(plan.scene.depth_from), plan.options.depth.layers) +
         lens_fingerprint(camera.lens, table.wavelengths_nm) +
         losses_fingerprint(table.losses.of(camera.lens)) +
         fmt::format("table {} fields up to {} mm, {} places over {} x {} mm, clip {}\n", table.field_count,
                     table.max_image_height_mm, table.frame_places, 2 * frame_mm[0], 2 * frame_mm[1],
                     static_cast<int>(table.clip));
}

/// What the light of an image depends on, a line each.
std::string fingerprint_of(const ImagePlan& plan) {
  const Scene& scene = plan.scene;
  const ImagingOptions& options = plan.options.imaging;
  Checksum radiance;
  for (int band = 0; band < scene.bands(); ++band) {
    radiance.add(scene.band(band));
    scene.release_memory();
  }
  std::string text = fmt::format("petzval {}\n", version());
  text += fmt::format("scene {}, {} x {} samples, {} degrees wide, {}, {:08x}\n", scene.name, scene.columns(),
                      scene.rows(), scene.horizontal_angle_deg(),
                      scene.distance_m() ? fmt::format("{} m away", *scene.distance_m()) : "at infinity",
                      radiance.value());
  if (scene.is_panorama()) text += fmt::format("view {} {}\n", scene.view().yaw_deg, scene.view().pitch_deg);
  text += fmt::format("wavelengths {}\n", fmt::join(scene.wavelengths_nm(), ","));
  text += plan.depth ? depth_text(plan) : fmt::format("lens {}\n", lens_table_text(plan.table));
  text += fmt::format("frame {} x {} pixels of {} um\n", plan.frame.columns, plan.frame.rows,
                      plan.frame.pitch_um);
  text += fmt::format("photosite {}\n", options.photosite.text());
  text +=
      fmt::format("method {}, tolerance {}, nodes {}, tile {}, direct {}\n", static_cast<int>(options.method),
                  options.product.tolerance, options.product.nodes, options.product.tile,
                  options.product.direct ? std::to_string(*options.product.direct) : "as planned");
  text += fmt::format("section {}, transform {}, cells {}\n", options.sections.section,
                      options.sections.transform, options.supersample);
  return text + fmt::format("interpolation {}, fit {}, surround {}\n",
                            static_cast<int>(options.interpolation), options.fit.polynomial_order,
                            static_cast<int>(options.surround));
}

/// A file of bands, read a band at a time once all of it has been checked.
class BandsFile {
 public:
  explicit BandsFile(const std::string& path) : path_(path), file_(path, std::ios::binary) {
    if (!file_) throw InputError(path_, "cannot be read");
    std::string start(magic.size(), '\0');
    file_.read(start.data(), static_cast<std::streamsize>(start.size()));
    if (start != magic) throw InputError(path_, "is no checkpoint of petzval image");
    take(&head_, sizeof head_);
    const std::uint64_t size = std::filesystem::file_size(path_), rest = size - magic.size() - sizeof head_;
    if (head_.first < 0 || head_.first >= head_.end || head_.end > head_.bands || head_.plane == 0 ||
        head_.fingerprint_size > rest || head_.plane > rest / sizeof(float))
      throw damaged();
    start_ = magic.size() + sizeof head_ + head_.fingerprint_size;
    const auto planes = static_cast<std::uint64_t>(head_.end - head_.first) * head_.plane * sizeof(float);
    if (size != start_ + planes + sizeof(std::uint32_t)) throw damaged();
    fingerprint_.resize(head_.fingerprint_size);
    take(fingerprint_.data(), fingerprint_.size());
    check_sum(planes);
  }

  const std::string& path() const { return path_; }
  const BandsHead& head() const { return head_; }
  const std::string& fingerprint() const { return fingerprint_; }

  void read(int band, std::span<float> pixels) {
    const auto number = static_cast<std::uint64_t>(band - head_.first);
    file_.seekg(static_cast<std::streamoff>(start_ + number * head_.plane * sizeof(float)));
    take(pixels.data(), pixels.size_bytes());
  }

 private:
  InputError damaged() const { return {path_, "is a damaged checkpoint; to make it again would be right"}; }

  void check_sum(std::uint64_t left) {
    Checksum sum;
    sum.add(&head_, sizeof head_);
    sum.add(fingerprint_.data(), fingerprint_.size());
    std::vector<char> some(std::size_t{1} << 20);
    while (left > 0) {
      const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left, some.size()));
      take(some.data(), count);
      sum.add(some.data(), count);
      left -= count;
    }
    std::uint32_t stated = 0;
    take(&stated, sizeof stated);
    if (stated != sum.value()) throw damaged();
  }

  void take(void* to, std::size_t count) {
    file_.read(static_cast<char*>(to), static_cast<std::streamsize>(count));
    if (!file_) throw damaged();
  }

  std::string path_;
  std::ifstream file_;
  BandsHead head_{};
  std::string fingerprint_;
  std::uint64_t start_ = 0;
};

/// Writes such a file, band by band in order.
class BandsWriter {
 public:
  BandsWriter(const std::string& path, BandsHead head, const std::string& fingerprint)
      : file_(path), out_(file_.temporary_path(), std::ios::binary) {
    head.fingerprint_size = fingerprint.size();
    out_.write(magic.data(), static_cast<std::streamsize>(magic.size()));
    write(&head, sizeof head);
    write(fingerprint.data(), fingerprint.size());
  }

  void add(std::span<const float> pixels) { write(pixels.data(), pixels.size_bytes()); }

  void finish() {
    const std::uint32_t sum = sum_.value();
    write(&sum, sizeof sum);
    out_.close();
    if (!out_) fail();
    file_.commit();
  }

 private:
  void write(const void* bytes, std::size_t count) {
    out_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(count));
    if (!out_) fail();
    sum_.add(bytes, count);
  }
  [[noreturn]] void fail() const {
    throw Failure(fmt::format("{}: cannot be written: {}", file_.path(), std::strerror(errno)));
  }

  WholeFile file_;
  std::ofstream out_;
  Checksum sum_;
};

std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(line.size() + 1, text.size()));
  return line;
}

/// \throws InputError with the first line in which they differ. \param other  whose fingerprint `text` is.
void require_same(const BandsFile& file, std::string_view text, const std::string& other) {
  std::string_view a = file.fingerprint(), b = text;
  while (!a.empty() || !b.empty()) {
    const std::string_view here = take_line(a), there = take_line(b);
    if (here != there)
      throw InputError(file.path(), fmt::format("is a piece of another image: it has \"{}\", {} has \"{}\"",
                                                here, other, there));
  }
}

}  // namespace

bool is_image_piece(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string start(magic.size(), '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  return start == magic;
}

void image_piece(const ImagePlan& plan, const Context& context, ImageReport* report) {
  const int bands = plan.scene.bands();
  const auto [first, end] = plan.options.bands.value_or(std::array{0, bands});
  if (plan.options.checkpoint.empty())
    throw InputError("`bands` are a piece of an image, which goes into a `checkpoint`; one would be right");
  if (first < 0 || first >= end || end > bands)
    throw InputError(
        fmt::format("`bands` {}:{}: of {} bands, 0:1 to 0:{} would be right", first, end, bands, bands));
  BandsWriter file(
      plan.options.checkpoint,
      {.plane = static_cast<std::uint64_t>(plan.frame.columns) * static_cast<std::uint64_t>(plan.frame.rows),
       .first = first,
       .end = end,
       .bands = bands},
      fingerprint_of(plan));
  ImagePlan piece = plan;
  piece.options.flare = {};  // is added to the whole
  image_bands(
      piece, [&](std::span<const float> pixels) { file.add(pixels); }, context, report);
  file.finish();
}

void merge_images(const std::vector<std::string>& pieces, const std::string& checkpoint,
                  const Context& context) {
  if (pieces.empty()) throw InputError("there are no pieces to be merged");
  std::vector<std::unique_ptr<BandsFile>> files;
  for (const std::string& each : pieces) {
    files.push_back(std::make_unique<BandsFile>(each));
    require_same(*files.back(), files.front()->fingerprint(), pieces.front());
  }
  std::ranges::sort(files, {}, [](const auto& file) { return file->head().first; });
  BandsHead head = files.front()->head();
  int next = 0;
  for (const auto& file : files) {
    if (file->head().plane != head.plane || file->head().bands != head.bands)
      throw InputError(file->path(), "is a piece of another image");
    if (file->head().first < next)
      throw InputError(file->path(), fmt::format("has band {}, and so has another piece; each once would be "
                                                 "right",
                                                 file->head().first));
    if (file->head().first > next) throw InputError(fmt::format("no piece has band {}", next));
    next = file->head().end;
  }
  if (next < head.bands) throw InputError(fmt::format("no piece has band {}", next));
  run_within(context, [&](const ProgressCallback& progress) {
    head.first = 0, head.end = head.bands;
    BandsWriter out(checkpoint, head, files.front()->fingerprint());
    std::vector<float> plane(head.plane);
    for (const auto& file : files)
      for (int band = file->head().first; band < file->head().end; ++band) {
        file->read(band, plane);
        out.add(plane);
        if (progress) progress(double(band + 1) / head.bands, "bands");
      }
    out.finish();
  });
}

BandShare known_bands(const ImagePlan& plan) {
  if (plan.options.bands) return {.first = (*plan.options.bands)[0], .end = (*plan.options.bands)[1]};
  if (plan.options.checkpoint.empty()) return {};
  const auto file = std::make_shared<BandsFile>(plan.options.checkpoint);
  require_same(*file, fingerprint_of(plan), "this image");
  const BandsHead& head = file->head();
  if (head.first != 0 || head.end != head.bands)
    throw InputError(file->path(), fmt::format("has bands {} to {} of {}; all of them, as petzval merge puts "
                                               "them together, would be right",
                                               head.first, head.end - 1, head.bands));
  return {
      .first = 0, .end = 0, .known = [file](int band, std::span<float> pixels) { file->read(band, pixels); }};
}

}  // namespace petzval
