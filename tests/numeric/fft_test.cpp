// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/numeric/fft.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace petzval {
namespace {

template <typename Real>
AlignedVector<Real> random_image(std::size_t size) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> uniform(-1, 1);
  AlignedVector<Real> image(size);
  for (Real& value : image) value = static_cast<Real>(uniform(random));
  return image;
}

/// The definition of the transform, summed as it stands (whole turns taken off, as they would cost digits).
template <typename Real>
std::complex<double> dft(const AlignedVector<Real>& image, int rows, int columns, int k, int l) {
  std::complex<double> sum = 0;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      sum += static_cast<double>(image[static_cast<std::size_t>(r * columns + c)]) *
             std::polar(1.0, -2 * pi * (double(k * r % rows) / rows + double(l * c % columns) / columns));
  return sum;
}

template <typename Real>
void expect_definition(int rows, int columns, double tolerance) {
  const RealFft2<Real> fft(rows, columns);
  const AlignedVector<Real> image = random_image<Real>(fft.size());
  AlignedVector<std::complex<Real>> spectrum(fft.spectrum_size());
  fft.forward(image, spectrum);
  for (int k = 0; k < rows; ++k)
    for (int l = 0; l < fft.spectrum_columns(); ++l) {
      const std::complex<double> value = spectrum[static_cast<std::size_t>(k * fft.spectrum_columns() + l)];
      EXPECT_LT(std::abs(value - dft(image, rows, columns, k, l)), tolerance) << rows << "×" << columns;
    }
}

// Rounding of a sum of up to 360 numbers below 1: a few times √360 ulp, with a factor of ten to spare.
TEST(Fft, IsTheSumThatDefinesIt) {
  for (const auto& [rows, columns] : {std::pair{1, 1}, {1, 8}, {7, 1}, {6, 10}, {5, 9}, {18, 20}}) {
    expect_definition<float>(rows, columns, 2e-5);
    expect_definition<double>(rows, columns, 4e-14);
  }
}

TEST(Fft, InverseReturnsTheImageTimesItsSize) {
  const RealFft2<float> fft(24, 30);
  const AlignedVector<float> image = random_image<float>(fft.size());
  AlignedVector<std::complex<float>> spectrum(fft.spectrum_size());
  AlignedVector<float> back(fft.size());
  fft.forward(image, spectrum);
  fft.inverse(spectrum, back);
  // Two transforms in float, about log2(720) ≈ 10 roundings each.
  for (std::size_t i = 0; i < image.size(); ++i) EXPECT_NEAR(back[i] / 720, image[i], 1e-6);
}

TEST(Fft, ManyThreadsGiveTheBytesOfOne) {
  const RealFft2<float> fft(48, 48);
  const AlignedVector<float> image = random_image<float>(fft.size());
  AlignedVector<std::complex<float>> expected(fft.spectrum_size());
  fft.forward(image, expected);
  std::vector<int> equal(64, 0);
  parallel_for(equal.size(), [&](std::size_t i) {
    const RealFft2<float> same(48, 48);
    AlignedVector<std::complex<float>> spectrum(same.spectrum_size());
    same.forward(image, spectrum);
    equal[i] = spectrum == expected ? 1 : 0;
  });
  for (const int value : equal) EXPECT_EQ(value, 1);
}

// Of seventeen lines some fill a vector of any machine and some are left over.
TEST(LineFft, LinesTogetherGiveTheBytesOfEachAlone) {
  for (const int size : {1, 2, 15, 16, 60, 97, 180, 1024}) {
    const LineFft fft(size);
    const std::size_t count = 17, step = static_cast<std::size_t>(size) + 1;
    AlignedVector<std::complex<double>> lines(count * step);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (auto& value : lines) value = {uniform(random), uniform(random)};
    for (const auto transform :
         {&LineFft::forward, &LineFft::inverse, &LineFft::forward_real, &LineFft::inverse_real}) {
      AlignedVector<std::complex<double>> one_by_one = lines;
      for (std::size_t j = 0; j < count; ++j) (fft.*transform)(one_by_one.data() + j * step, 1, 0);
      (fft.*transform)(lines.data(), count, static_cast<std::ptrdiff_t>(step));
      EXPECT_TRUE(lines == one_by_one) << size;
    }
  }
}

TEST(LineFft, IsTheSumThatDefinesIt) {
  constexpr int size = 60;
  const AlignedVector<double> real = random_image<double>(size);
  AlignedVector<std::complex<double>> line(size), spectrum(size / 2 + 1);
  std::copy(real.begin(), real.end(), reinterpret_cast<double*>(spectrum.data()));
  std::copy(real.begin(), real.end(), line.begin());
  LineFft(size).forward(line.data());
  LineFft(size).forward_real(spectrum.data());
  for (int k = 0; k <= size / 2; ++k) {
    const std::complex<double> sum = dft(real, 1, size, 0, k);
    EXPECT_LT(std::abs(line[static_cast<std::size_t>(k)] - sum), 4e-14);
    EXPECT_LT(std::abs(spectrum[static_cast<std::size_t>(k)] - sum), 4e-14);
  }
  LineFft(size).inverse_real(spectrum.data());
  for (std::size_t i = 0; i < real.size(); ++i)
    EXPECT_NEAR(reinterpret_cast<const double*>(spectrum.data())[i] / size, real[i], 1e-14);
}

TEST(Fft, RefusesWhatItCannotTransform) {
  EXPECT_THROW(RealFft2<float>(0, 4), InputError);
  EXPECT_THROW(RealFft2<double>(4, -1), InputError);
  EXPECT_THROW(RealFft2<float>(1 << 20, 1 << 20), InputError);
  const RealFft2<float> fft(4, 4);
  AlignedVector<float> image(15);
  AlignedVector<std::complex<float>> spectrum(12);
  EXPECT_THROW(fft.forward(image, spectrum), InputError);
}

TEST(Fft, GoodSizesAreEvenSmoothAndNoSmallerThanAsked) {
  EXPECT_EQ(good_fft_size(1), 2);
  EXPECT_EQ(good_fft_size(2), 2);
  EXPECT_EQ(good_fft_size(24), 24);
  EXPECT_EQ(good_fft_size(31), 32);
  EXPECT_EQ(good_fft_size(62), 64);
  EXPECT_EQ(good_fft_size(65), 72);
  EXPECT_EQ(good_fft_size(97), 100);
}

}  // namespace
}  // namespace petzval
