// SPDX-License-Identifier: BSD-3-Clause
// How sharp a picture is.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// One number a pixel, rows from the top: for colours their largest component, max(R, G, B).
struct GreyPicture {
  int columns = 0, rows = 0;
  std::vector<double> values;

  double at(int column, int row) const {
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(column)];
  }
};

/// A picture of one zone. A second one of the same with other noise, if there is one, takes the noise out of
/// measures that multiply: noise that two pictures do not share has no product on average.
struct ZonePicture {
  GreyPicture first;
  std::optional<GreyPicture> second;
};

/// Which measure. Every one grows with sharpness and scales with the square of the light or with the light.
enum class FocusMeasure {
  sum_modified_laplacian,  ///< Nayar & Nakagawa 1994: Σ |∂²/∂x²| + |∂²/∂y²|, where it exceeds the threshold
  gradient_energy,  ///< Σ (∂/∂x)² + (∂/∂y)², by Sobel's operator (Tenenbaum 1970)
  laplacian_energy  ///< Σ of the squared Laplacian of the picture smoothed by 1 2 1
};

struct FocusMeasureOptions {
  FocusMeasure measure = FocusMeasure::gradient_energy;
  int step = 1;          ///< pixels between the points of a difference
  double threshold = 0;  ///< of the modified Laplacian, in the unit of the picture
};

/// "sml", "gradient", "laplacian". \throws InputError for another name.
FocusMeasure focus_measure_of(const std::string& name);
const char* to_string(FocusMeasure measure);

/// Means over squares of k × k pixels; what is left over at the right and below is left out. Squares grow no
/// larger than an eighth of the picture's shorter side. Detail of k pixels tells of focus from k times as far
/// away as that of one, and has 1/k² of the noise.
GreyPicture binned(const GreyPicture& picture, int k);
ZonePicture binned(const ZonePicture& picture, int k);

/// Per pixel, so that zones of several sizes may be compared; 0 for a picture smaller than the operator.
/// \throws InputError if sizes and values do not agree or the step is below 1.
double focus_measure(const ZonePicture& picture, const FocusMeasureOptions& options);

/// The standard deviation that noise leaves in focus_measure(), from how far the two pictures of a zone
/// differ: half the difference of what they measure alone has the variance of what they measure together. Up
/// to sixteen parts of the picture are asked one by one, so that one estimate rests on as many differences.
/// 0 without a second picture.
double focus_measure_noise(const ZonePicture& picture, const FocusMeasureOptions& options);

}  // namespace petzval
