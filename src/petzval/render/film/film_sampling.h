// SPDX-License-Identifier: BSD-3-Clause
// Where on the film the samples of a pixel begin, and which pixel gathers the light that lands there:
// photosite and optical low-pass filter.
#pragma once

#include <petzval/render/film/pixel_window.h>
#include <petzval/wave/photosite.h>

#include <array>
#include <cmath>
#include <optional>

namespace petzval::render {

/// A place on the film, in pixels of the upright picture, two numbers in [0, 1) that choose a direction
/// there, and the lane of the wavelength that leads. Light of that place is moved by one of the four dots of
/// the low-pass filter before it meets the photosites.
struct FilmSample {
  double column = 0, row = 0;
  double u = 0, v = 0;
  double dot_column = 0, dot_row = 0;
  int hero = 0;
};

/// A pixel of the picture.
struct Pixel {
  int column = 0, row = 0;
};

/// The value of a pixel is the mean irradiance over its photosite, after a filter that splits light into four
/// dots of a quarter each. Each sample follows one dot: as if the film stood beside the axis by it. With the
/// dot as part of the sample, light that lands is gathered by the one pixel whose photosite it meets, or by
/// none. Places are drawn evenly over the photosites, all of one area, so that where wavelengths are weighed
/// against each other this density and the mean over the photosite cancel: only whether a place is on a
/// photosite is left.
class FilmSampling {
 public:
  /// \param window  the pixels that are rendered. \param site  a rectangle or ellipse within the pixel, the
  /// same in every pixel. \throws InputError for another.
  explicit FilmSampling(const PixelWindow& window, const Photosite& site = {});

  /// A sample of a pixel for four numbers in [0, 1); neighbours stay neighbours. Half of the samples go
  /// through each of two dots along an axis: the leading digit of x (of y) chooses, and the rest goes on.
  FilmSample place(Pixel pixel, double x, double y, double u, double v) const;
  /// The same dots on photosites without gaps: light that is to land elsewhere may begin between them.
  FilmSampling without_gaps() const;
  /// Of a pixel's area, that of its photosite.
  double site_share() const;
  /// The pixel of the window that gathers light which lands on the film at a place, through the dot of the
  /// sample that found it.
  std::optional<Pixel> pixel_at(const FilmSample& found_by, double column, double row) const {
    column += found_by.dot_column, row += found_by.dot_row;
    // Before they are made whole numbers, which may not hold them.
    if (!(column >= window_.left && column < window_.right && row >= window_.top && row < window_.bottom))
      return std::nullopt;
    const Pixel pixel{static_cast<int>(std::floor(column)), static_cast<int>(std::floor(row))};
    if (whole_pixel_ || is_on_site(column - pixel.column, row - pixel.row)) return pixel;
    return std::nullopt;
  }

 private:
  /// Whether a place of a pixel, 0 … 1, is on its photosite.
  bool is_on_site(double x, double y) const;

  PixelWindow window_;
  Photosite site_;
  bool whole_pixel_;
};

}  // namespace petzval::render
