// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/numeric/fft.h>
#include <petzval/target/far_field.h>
#include <petzval/target/outline_transform.h>
#include <petzval/target/render_target.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

using Complex = std::complex<double>;

/// The margin around the frame, in pixels, that keeps what wraps below 1e-7, and the kernel for what lies
/// beyond.
struct Surroundings {
  Period period;
  FarKernel far;
};

void check(const TargetOptions& options, const Otf& otf) {
  options.photosite.validate();
  if (options.columns < 1 || options.rows < 1 ||
      static_cast<double>(options.columns) * options.rows > static_cast<double>(1 << 28))
    throw InputError(fmt::format("a picture of {} x {} pixels: from 1 x 1 to 2^28 pixels is right",
                                 options.columns, options.rows));
  if (!(options.pitch_um > 0) || !std::isfinite(options.pitch_um))
    throw InputError(fmt::format("a pixel pitch of {} um: a positive number is right", options.pitch_um));
  constexpr double widest_cpp = 64;
  const double cutoff = otf.cutoff_cpmm() * options.pitch_um * 1e-3;
  if (!(cutoff <= widest_cpp))
    throw InputError(
        fmt::format("the point-spread function is so narrow that it passes {:.4g} cycles/pixel; up to {} is "
                    "right: a smaller pixel pitch, a larger f-number or sigma",
                    cutoff, widest_cpp));
}

/// The lowest height of the far kernel in the margin: what the kernel leaves goes as the sixth power of it.
constexpr double heights_in_margin = 5;

/// About what one place of the far field costs.
double far_field_ns(const std::vector<Region>& regions, double height_px) {
  double sum = 0;
  for (const Region& region : regions)
    for (const Contour& contour : region.contours) {
      const double extent = extent_of(contour), edges = static_cast<double>(contour.size());
      // Short edges, as of curves, go together in runs of about a quarter of the height.
      const double runs = std::min(edges, 4 + 3.5 * extent / (0.25 * height_px));
      sum += extent <= spot_extent * height_px ? 15 : 165 * runs;
    }
  return sum;
}

/// The margin that takes the least time: more margin, a larger transform, but a coarser grid for the far
/// field, which every edge costs time on.
Surroundings surroundings(const TargetOptions& options, const Otf& otf, const std::vector<Region>& regions) {
  const double reach = otf.reach_um() / options.pitch_um;
  const double cutoff = otf.cutoff_cpmm() * options.pitch_um * 1e-3;
  const PsfTail tail = otf.tail();
  const bool has_tail = tail.k3_um != 0;
  constexpr double largest = 1 << 16;
  // The tail must hold at the margin: eight times the geometric blur, and where it has settled if that can be
  // had.
  const double room = 0.25 * (largest - std::max(options.columns, options.rows));
  const double settled = std::min(tail.settled_um / options.pitch_um, std::max(room, 0.0));
  const double least = has_tail ? std::max({64.0, 8 * reach, settled}) : reach + 2;
  double best_margin = least, best_cost = 0;
  for (double margin = least; has_tail && margin <= 16 * least; margin *= 1.3) {
    const double spacing = margin / (5 * heights_in_margin);
    const double cells = (options.columns + 2 * margin) * (options.rows + 2 * margin);
    const double transform_ns = 60 * cells * 4.5 * cutoff * cutoff;
    const double far_ns = far_field_ns(regions, margin / heights_in_margin) *
                          (options.columns / spacing + 10) * (options.rows / spacing + 10);
    const double cost = transform_ns + far_ns;
    if (margin == least || cost < best_cost) best_cost = cost, best_margin = margin;
  }
  if (std::max(options.columns, options.rows) + 2 * best_margin > largest)
    throw InputError(
        fmt::format("a picture of {} x {} pixels with a blur that reaches {:.6g} pixels needs a period above "
                    "{} pixels; a smaller picture or less aberration would fit",
                    options.columns, options.rows, reach, largest));
  const auto fitted = [&](int size) {
    return good_fft_size(size + 2 * static_cast<int>(std::ceil(best_margin)));
  };
  Surroundings around;
  around.period = {fitted(options.columns), fitted(options.rows), {}};
  around.period.origin = {-static_cast<double>((around.period.columns - options.columns) / 2),
                          -static_cast<double>((around.period.rows - options.rows) / 2)};
  if (has_tail) around.far = far_kernel(tail, options.pitch_um, best_margin / heights_in_margin);
  return around;
}

/// Multiplies spectra by OTF × photosite − far kernel, and folds them onto the frequencies of the pixel grid.
class AliasFolder {
 public:
  AliasFolder(const Otf& otf, const TargetOptions& options, const Surroundings& around)
      : otf_(otf), options_(options), around_(around), cpmm_per_cpp_(1e3 / options.pitch_um) {
    cutoff_ = otf.cutoff_cpmm() / cpmm_per_cpp_;
    const auto rows = static_cast<std::size_t>(around.period.rows);
    spectrum_.assign((static_cast<std::size_t>(around.period.columns) / 2 + 1) * rows, 0);
    const int l_max = static_cast<int>(std::ceil(cutoff_ * around.period.rows));
    for (int l = -l_max; l <= l_max; ++l) {
      const double fy = static_cast<double>(l) / around.period.rows;
      fy_.push_back(fy);
      fy_cpmm_.push_back(fy * cpmm_per_cpp_);
      // Pixel centres lie half a pixel from the corner of the period.
      turn_y_.push_back(std::polar(1.0, pi * fy));
      if (options.photosite.is_separable()) turn_y_.back() *= options.photosite.transform(0, fy);
    }
  }

  void add(int k, int l_max, std::span<const Complex> scene) {
    const double fx = static_cast<double>(k) / around_.period.columns;
    if (fx > cutoff_) return;
    const int reach = std::min(
        l_max, static_cast<int>(std::sqrt(std::max(0.0, cutoff_ * cutoff_ - fx * fx)) * around_.period.rows));
    const auto first = static_cast<std::size_t>(l_max - reach),
               count = static_cast<std::size_t>(2 * reach + 1);
    std::vector<Complex> values(count);
    otf_.evaluate(fx * cpmm_per_cpp_, std::span(fy_cpmm_).subspan(first, count), values);
    const bool separable = options_.photosite.is_separable();
    const Complex turn_x = std::polar(1.0, pi * fx) * (separable ? options_.photosite.transform(fx, 0) : 1.0);
    // Where the far kernel is below 1e-16 of its weight.
    const double far_reach = around_.far.is_zero() ? -1 : 6 / around_.far.height_px[0];
    for (std::size_t i = 0; i < count; ++i) {
      const double fy = fy_[first + i];
      Complex value = values[i] * turn_x * turn_y_[first + i];
      // A photosite gathers where it lies: a correlation, so that one that is not symmetric stands as it is
      // drawn.
      if (!separable) value *= std::conj(options_.photosite.transform(fx, fy));
      if (fx <= far_reach && std::abs(fy) <= far_reach)
        value -= around_.far.transform(std::hypot(fx, fy)) * std::polar(1.0, pi * (fx + fy));
      values[i] = value * scene[first + i];
    }
    fold(k, reach, values);
  }

  /// The values at the pixels of the frame, times columns × rows of the period.
  std::vector<double> picture();

 private:
  /// F(k, l) goes to (k mod columns, l mod rows), and its mirror image conj F(k, l) to (−k, −l); half of the
  /// columns is kept, as the transform to real numbers wants it.
  void fold(int k, int reach, const std::vector<Complex>& values) {
    const int columns = around_.period.columns, rows = around_.period.rows;
    const int direct = k % columns, mirrored = (columns - direct) % columns;
    for (const bool mirror : {false, true}) {
      const int column = mirror ? mirrored : direct;
      if (column > columns / 2 || (mirror && k == 0)) continue;
      Complex* line = spectrum_.data() + static_cast<std::size_t>(column) * static_cast<std::size_t>(rows);
      int row = mirror ? reach % rows : ((-reach) % rows + rows) % rows;
      for (const Complex& value : values) {
        line[row] += mirror ? std::conj(value) : value;
        if (mirror)
          row = row == 0 ? rows - 1 : row - 1;
        else
          row = row == rows - 1 ? 0 : row + 1;
      }
    }
  }

  const Otf& otf_;
  const TargetOptions& options_;
  const Surroundings& around_;
  double cpmm_per_cpp_, cutoff_;
  std::vector<double> fy_, fy_cpmm_;
  std::vector<Complex> turn_y_;
  AlignedVector<Complex> spectrum_;  ///< [column 0 … columns/2][row]
};

std::vector<double> AliasFolder::picture() {
  const Period& period = around_.period;
  const auto rows = static_cast<std::size_t>(period.rows);
  const std::size_t half = static_cast<std::size_t>(period.columns) / 2 + 1;
  const LineFft down(period.rows), across(period.columns);
  constexpr std::size_t block = 16;  // lines at a time, so that they share cache lines and vectors
  parallel_for((half + block - 1) / block, [&](std::size_t index) {
    down.inverse(spectrum_.data() + index * block * rows, std::min(block, half - index * block),
                 static_cast<std::ptrdiff_t>(rows));
  });

  const auto width = static_cast<std::size_t>(options_.columns),
             height = static_cast<std::size_t>(options_.rows);
  const auto left = static_cast<std::size_t>(-period.origin.x),
             top = static_cast<std::size_t>(-period.origin.y);
  std::vector<double> values(width * height);
  parallel_for((height + block - 1) / block, [&](std::size_t index) {
    const std::size_t first = index * block, count = std::min(block, height - first);
    AlignedVector<Complex> lines(half * count);
    for (std::size_t column = 0; column < half; ++column)
      for (std::size_t r = 0; r < count; ++r)
        lines[r * half + column] = spectrum_[column * rows + top + first + r];
    across.inverse_real(lines.data(), count, static_cast<std::ptrdiff_t>(half));
    for (std::size_t r = 0; r < count; ++r) {
      const auto* line = reinterpret_cast<const double*>(lines.data() + r * half) + left;
      std::copy(line, line + width, values.begin() + static_cast<std::ptrdiff_t>((first + r) * width));
    }
  });
  return values;
}

}  // namespace

TargetImage render_target(const TargetScene& scene, const Otf& otf, const TargetOptions& options) {
  check(options, otf);
  validate(scene);
  const std::vector<Region> regions = visible_regions(scene);
  const Surroundings around = surroundings(options, otf, regions);
  AliasFolder folder(otf, options, around);
  transform_outlines(
      regions, around.period, otf.cutoff_cpmm() * options.pitch_um * 1e-3, options.working_bytes,
      [&](int k, int l_max, std::span<const Complex> scene_column) { folder.add(k, l_max, scene_column); });
  TargetImage image(options.rows, options.columns, folder.picture());
  const double scale = 1 / (static_cast<double>(around.period.columns) * around.period.rows);
  for (double& value : image.values()) value *= scale;
  FarField(regions, around.far).add_to(image.values(), options.columns, options.rows);
  for (double& value : image.values()) value += scene.ground;
  return image;
}

std::complex<double> transfer(const Otf& otf, const TargetOptions& options, double fx_cpp, double fy_cpp) {
  const double cpmm_per_cpp = 1e3 / options.pitch_um;
  return otf.at(fx_cpp * cpmm_per_cpp, fy_cpp * cpmm_per_cpp) *
         std::conj(options.photosite.transform(fx_cpp, fy_cpp));
}

}  // namespace petzval
