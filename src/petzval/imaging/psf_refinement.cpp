// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/psf_refinement.h>
#include <petzval/numeric/fft.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

namespace petzval {

namespace {

using Frequencies = AlignedVector<std::complex<float>>;

constexpr int most_refined_samples = 1 << 19;
/// Left of a spectrum at the edge of what samples can say, relative to frequency 0.
constexpr float ended = 0.01F;

/// Of a PSF about its centre, on a square with room around it so that its sides do not meet.
struct PsfSpectrum {
  int side;  ///< even
  Frequencies values;

  explicit PsfSpectrum(const Psf& psf) : side(good_fft_size(psf.size + 4)) {
    while (side % 2 != 0) side = good_fft_size(side + 1);
    const RealFft2<float> fft(side, side);
    AlignedVector<float> image(fft.size());
    for (int i = 0; i < psf.size; ++i)
      for (int j = 0; j < psf.size; ++j) image[cyclic(i - psf.size / 2, j - psf.size / 2)] = psf.at(i, j);
    values.resize(fft.spectrum_size());
    fft.forward(image, values);
  }
  std::size_t cyclic(int row, int column) const {
    return static_cast<std::size_t>((row + side) % side) * static_cast<std::size_t>(side) +
           static_cast<std::size_t>((column + side) % side);
  }
  const std::complex<float>& at(int row, int column) const {
    return values[static_cast<std::size_t>((row + side) % side) * static_cast<std::size_t>(side / 2 + 1) +
                  static_cast<std::size_t>(column)];
  }
  /// The largest modulus at the highest frequencies along either axis.
  float edge() const {
    float largest = 0;
    for (int i = 0; i <= side / 2; ++i)
      largest = std::max(
          {largest, std::abs(at(side / 2, i)), std::abs(at(i, side / 2)), std::abs(at(-i, side / 2))});
    return largest;
  }
};

/// What a square as wide as a sample leaves of frequencies −count … count − 1 of `side`.
std::vector<float> squares_share(int count, int side) {
  std::vector<float> shares;
  for (int k = -count; k < count; ++k) {
    const double x = std::numbers::pi * k / side;
    shares.push_back(static_cast<float>(k == 0 ? 1 : std::sin(x) / x));
  }
  return shares;
}

/// Where rays do not come near, samples are zero, and stay so, but for one sample about those that are lit.
/// The light stays what it was.
void keep_dark(const Psf& psf, int factor, Psf& fine) {
  std::vector<std::pair<int, int>> lit;  // of each row, the first and the last sample
  for (int row = 0; row < psf.size; ++row) {
    int first = 0, last = psf.size - 1;
    while (first <= last && psf.at(row, first) == 0) ++first;
    while (last >= first && psf.at(row, last) == 0) --last;
    lit.push_back(first <= last ? std::pair(first, last) : std::pair(psf.size, -1));
  }
  const int middle = psf.size / 2, reach = fine.size / 2;
  const double before = std::accumulate(fine.values.begin(), fine.values.end(), 0.0);
  for (int i = 0; i < fine.size; ++i) {
    int first = psf.size, last = -1;
    const double row = middle + double(i - reach) / factor;
    for (int near = std::max(0, static_cast<int>(std::ceil(row)) - 1);
         near <= std::min(psf.size - 1, static_cast<int>(std::floor(row)) + 1); ++near) {
      const auto& [from, to] = lit[static_cast<std::size_t>(near)];
      first = std::min(first, from);
      last = std::max(last, to);
    }
    float* values = fine.values.data() + static_cast<std::ptrdiff_t>(i) * fine.size;
    const int from = reach + (first - 1 - middle) * factor, to = reach + (last + 1 - middle) * factor;
    std::fill(values, values + std::clamp(from, 0, fine.size), 0.0F);
    std::fill(values + std::clamp(to + 1, 0, fine.size), values + fine.size, 0.0F);
  }
  const double after = std::accumulate(fine.values.begin(), fine.values.end(), 0.0);
  for (float& value : fine.values) value = static_cast<float>(value * (before / after));
}

}  // namespace

Psf refined_psf(const Psf& psf, double widest_um) {
  const int room = std::max(1, static_cast<int>(std::sqrt(double(most_refined_samples)) / psf.size));
  const int factor = std::clamp(static_cast<int>(std::ceil(psf.spacing_um / widest_um)), 1, room);
  const PsfSpectrum coarse(psf);
  if (!(coarse.edge() <= ended * std::abs(coarse.at(0, 0)))) return psf;

  const int half = coarse.side / 2, side = coarse.side * factor;
  const RealFft2<float> fft(side, side);
  Frequencies spectrum(fft.spectrum_size());
  const std::vector<float> squares = squares_share(half, side);
  const float norm = 1 / static_cast<float>(fft.size());
  for (int row = -half + 1; row < half; ++row) {
    std::complex<float>* const line = spectrum.data() + static_cast<std::size_t>((row + side) % side) *
                                                            static_cast<std::size_t>(fft.spectrum_columns());
    for (int column = 0; column < half; ++column)
      line[column] = coarse.at(row, column) * (norm / (squares[static_cast<std::size_t>(row + half)] *
                                                       squares[static_cast<std::size_t>(column + half)]));
  }
  AlignedVector<float> image(fft.size());
  fft.inverse(spectrum, image);

  Psf fine;
  fine.spacing_um = psf.spacing_um / factor;
  fine.captured = psf.captured;
  // The window ends where it did; its centre is a sample.
  const int reach = factor * (psf.size / 2);
  fine.size = 2 * reach + 1;
  fine.values.reserve(static_cast<std::size_t>(fine.size) * static_cast<std::size_t>(fine.size));
  for (int i = -reach; i <= reach; ++i) {
    const float* const row = image.data() + static_cast<std::ptrdiff_t>((i + side) % side) * side;
    fine.values.insert(fine.values.end(), row + side - reach, row + side);
    fine.values.insert(fine.values.end(), row, row + reach + 1);
  }
  keep_dark(psf, factor, fine);
  return fine;
}

}  // namespace petzval
