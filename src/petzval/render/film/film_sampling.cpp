// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/render/disk_point.h>
#include <petzval/render/film/film_sampling.h>

#include <cmath>

namespace petzval::render {

namespace {

/// Which of two dots, at ±separation/2, and what is left of the number that chose it.
double dot_of(double separation, double& number) {
  if (separation == 0) return 0;
  const bool second = number >= 0.5;
  number = 2 * number - (second ? 1 : 0);
  return second ? separation / 2 : -separation / 2;
}

}  // namespace

FilmSampling::FilmSampling(const PixelWindow& window, const Photosite& site)
    : window_(window),
      site_(site),
      whole_pixel_(site.shape == Photosite::Shape::rectangle && site.width == 1 && site.height == 1) {
  site.validate();
  if ((site.shape != Photosite::Shape::rectangle && site.shape != Photosite::Shape::ellipse) ||
      !(site.width <= 1 && site.height <= 1))
    throw InputError(
        fmt::format("a photosite {}: a rectangle or ellipse within the pixel is right", site.text()));
}

FilmSample FilmSampling::place(Pixel pixel, double x, double y, double u, double v) const {
  FilmSample sample{0, 0, u, v, dot_of(site_.separation_x, x), dot_of(site_.separation_y, y), 0};
  if (site_.shape == Photosite::Shape::ellipse) {
    const DiskPoint on = disk_point(x, y);
    x = (1 + site_.width * on.x) / 2, y = (1 + site_.height * on.y) / 2;
  } else {
    // Exact where the photosite is the whole pixel.
    x = (1 - site_.width) / 2 + site_.width * x, y = (1 - site_.height) / 2 + site_.height * y;
  }
  sample.column = pixel.column + x - sample.dot_column;
  sample.row = pixel.row + y - sample.dot_row;
  return sample;
}

FilmSampling FilmSampling::without_gaps() const {
  Photosite whole = site_;
  whole.shape = Photosite::Shape::rectangle, whole.width = whole.height = 1;
  return FilmSampling(window_, whole);
}

double FilmSampling::site_share() const {
  return site_.width * site_.height * (site_.shape == Photosite::Shape::ellipse ? pi / 4 : 1);
}

bool FilmSampling::is_on_site(double x, double y) const {
  x = (2 * x - 1) / site_.width, y = (2 * y - 1) / site_.height;
  return site_.shape == Photosite::Shape::ellipse ? x * x + y * y <= 1 : std::abs(x) <= 1 && std::abs(y) <= 1;
}

}  // namespace petzval::render
