// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/imaging/section_blur.h>
#include <petzval/imaging/section_layout.h>
#include <petzval/numeric/fft.h>

#include <algorithm>

namespace petzval {

namespace {

using SectionSpectrum = AlignedVector<std::complex<float>>;

/// Blurs sections one by one: the buffers of one thread's work.
class SectionBlur {
 public:
  /// \param weights  of a section's cells along either axis.
  SectionBlur(const CellPlane& source, CellPlane& result, const std::vector<float>& weights, int radius,
              const RealFft2<float>& fft)
      : source_(source),
        result_(result),
        weights_(weights),
        section_(static_cast<int>(weights.size())),
        radius_(radius),
        margin_((source.grid.columns - result.grid.columns) / 2),
        fft_(fft),
        cells_(fft.size()),
        spectrum_(fft.spectrum_size()),
        otf_(fft.spectrum_size()) {}

  bool has_light(int first_row, int first_column) const;
  void set_kernel(const Kernel& kernel);
  /// Blurs one section with the kernel, which is turned over left-right and top-bottom if so told.
  void add_section(int first_row, int first_column, bool flip_rows, bool flip_columns);

 private:
  void load(int first_row, int first_column, bool flip_rows, bool flip_columns);
  void add_to_result(int first_row, int first_column, bool flip_rows, bool flip_columns);
  std::size_t square() const { return static_cast<std::size_t>(fft_.columns()); }

  const CellPlane& source_;
  CellPlane& result_;
  const std::vector<float>& weights_;
  int section_, radius_, margin_;
  RealFft2<float> fft_;
  AlignedVector<float> cells_;
  SectionSpectrum spectrum_, otf_;
};

bool SectionBlur::has_light(int first_row, int first_column) const {
  const int from = std::max(0, first_column), to = std::min(first_column + section_, source_.grid.columns);
  const int bottom = std::min(first_row + section_, source_.grid.rows);
  for (int row = std::max(0, first_row); row < bottom; ++row) {
    const float* in = source_.row(static_cast<std::size_t>(row));
    if (std::any_of(in + from, in + to, [](float light) { return light != 0; })) return true;
  }
  return false;
}

void SectionBlur::set_kernel(const Kernel& kernel) {
  std::fill(cells_.begin(), cells_.end(), 0.0F);
  const double scale = 1 / double(fft_.size());  // the transform back is not normalised
  const auto size = static_cast<std::size_t>(kernel.size());
  for (std::size_t row = 0; row < size; ++row)
    for (std::size_t column = 0; column < size; ++column)
      cells_[row * square() + column] = static_cast<float>(scale * kernel.weights[row * size + column]);
  fft_.forward(cells_, otf_);
}

void SectionBlur::add_section(int first_row, int first_column, bool flip_rows, bool flip_columns) {
  load(first_row, first_column, flip_rows, flip_columns);
  fft_.forward(cells_, spectrum_);
  for (std::size_t k = 0; k < spectrum_.size(); ++k) {
    const float a = spectrum_[k].real(), b = spectrum_[k].imag(), c = otf_[k].real(), d = otf_[k].imag();
    spectrum_[k] = {a * c - b * d, a * d + b * c};
  }
  fft_.inverse(spectrum_, cells_);
  add_to_result(first_row, first_column, flip_rows, flip_columns);
}

/// Instead of the kernel, the section itself is turned over, and its image again on the way out.
void SectionBlur::load(int first_row, int first_column, bool flip_rows, bool flip_columns) {
  std::fill(cells_.begin(), cells_.end(), 0.0F);
  const int from = std::max(0, -first_column), to = std::min(section_, source_.grid.columns - first_column);
  for (int i = 0; i < section_; ++i) {
    const int row = first_row + i;
    if (row < 0 || row >= source_.grid.rows) continue;
    const float* in = source_.row(static_cast<std::size_t>(row));
    float* out = cells_.data() + static_cast<std::size_t>(flip_rows ? section_ - 1 - i : i) * square();
    const float weight = weights_[static_cast<std::size_t>(i)];
    for (int j = from; j < to; ++j)
      out[flip_columns ? section_ - 1 - j : j] =
          weight * weights_[static_cast<std::size_t>(j)] * in[first_column + j];
  }
}

void SectionBlur::add_to_result(int first_row, int first_column, bool flip_rows, bool flip_columns) {
  const int extent = section_ + 2 * radius_;  // the image of the section begins one radius before it
  const int top = first_row - radius_ - margin_, left = first_column - radius_ - margin_;
  const int from = std::max(0, -left), to = std::min(extent, result_.grid.columns - left);
  for (int i = std::max(0, -top); i < std::min(extent, result_.grid.rows - top); ++i) {
    const float* in = cells_.data() + static_cast<std::size_t>(flip_rows ? extent - 1 - i : i) * square();
    float* out = result_.row(static_cast<std::size_t>(top + i));
    if (flip_columns)
      for (int j = from; j < to; ++j) out[left + j] += in[extent - 1 - j];
    else
      for (int j = from; j < to; ++j) out[left + j] += in[j];
  }
}

/// All sections of two groups that cross: at most four, mirror images of each other. The kernel of one serves
/// the one that lies opposite the axis (rotated by half a turn), and all four if the PSFs are mirror
/// symmetric; none but itself where nothing is symmetric.
void blur_crossing(const SectionGroup& rows, const SectionGroup& columns, const PsfField& psfs,
                   SectionBlur& blur) {
  const double cell_mm = psfs.cell_um() * 1e-3;
  const bool mirror_symmetric = psfs.symmetry() == KernelSymmetry::mirrored;
  if (psfs.symmetry() == KernelSymmetry::none) {
    for (const SectionSpan& row : rows.sections)
      for (const SectionSpan& column : columns.sections) {
        if (!blur.has_light(row.first, column.first)) continue;
        blur.set_kernel(psfs.kernel_at((column.mirrored ? 1 : -1) * columns.centre * cell_mm,
                                       (row.mirrored ? -1 : 1) * rows.centre * cell_mm));
        blur.add_section(row.first, column.first, false, false);
      }
    return;
  }
  for (const bool across : {false, true}) {
    if (across && mirror_symmetric) break;
    bool ready = false;
    for (const SectionSpan& row : rows.sections)
      for (const SectionSpan& column : columns.sections) {
        if (!mirror_symmetric && (row.mirrored != column.mirrored) != across) continue;
        if (!blur.has_light(row.first, column.first)) continue;
        if (!ready)  // columns run along −x'; the kernel of the pair across the axis is made for its mirrored
                     // column
          blur.set_kernel(
              psfs.kernel_at((across ? 1 : -1) * columns.centre * cell_mm, rows.centre * cell_mm));
        ready = true;
        blur.add_section(row.first, column.first, row.mirrored, column.mirrored != across);
      }
  }
}

}  // namespace

int transform_size(const SectionOptions& options, int radius) {
  constexpr int max_section = 4096;
  if (options.section < 1 || options.section > max_section)
    throw InputError(fmt::format("sections of {} cells: 1 to {} are right", options.section, max_section));
  const int needed = options.window() + 2 * radius;
  if (options.transform == 0) return good_fft_size(needed);
  constexpr int max_transform = 16384;
  if (options.transform < needed || options.transform > max_transform)
    throw InputError(fmt::format(
        "transforms of {0} cells for {1} cells a section and PSFs of {2}: from {3} (= {1} + {2} − 1) to "
        "{4} are right",
        options.transform, options.window(), 2 * radius + 1, needed, max_transform));
  return options.transform;
}

CellPlane blur_sections(const CellPlane& source, const PsfField& psfs, int margin,
                        const SectionOptions& options, const ProgressCallback& progress) {
  const int size = transform_size(options, psfs.radius());
  const RealFft2<float> fft(size, size);
  CellPlane result(grown(source.grid, -margin));
  const auto lay = options.blend ? lay_fading_sections : lay_sections;
  const std::vector<SectionGroup> columns = lay(source.grid.columns, options.section);
  const std::vector<SectionGroup> rows = lay(source.grid.rows, options.section);
  const std::vector<float> weights = options.blend
                                         ? fading_weights(options.section)
                                         : std::vector<float>(static_cast<std::size_t>(options.section), 1);

  // Rows of sections that write to different rows of cells work at the same time; the turns follow each
  // other, so that each cell is summed in one order whatever the number of threads.
  const auto turns =
      static_cast<std::size_t>((options.window() + 2 * psfs.radius() - 1) / options.section + 1);
  for (std::size_t turn = 0; turn < std::min(turns, rows.size()); ++turn) {
    const std::size_t count = (rows.size() - turn + turns - 1) / turns;
    parallel_for(count, [&](std::size_t i) {
      SectionBlur blur(source, result, weights, psfs.radius(), fft);
      for (const SectionGroup& column : columns) blur_crossing(rows[turn + i * turns], column, psfs, blur);
    });
    if (progress) progress(double(turn + 1) / double(turns), "blur");
  }
  return result;
}

}  // namespace petzval
