// SPDX-License-Identifier: BSD-3-Clause
// Places on the film, drawn for a photosite and a low-pass filter, against the transform of both.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/sobol.h>
#include <petzval/render/film/film_sampling.h>

#include <cmath>
#include <complex>

namespace petzval::render {
namespace {

Photosite site_of(Photosite::Shape shape, double width, double height, double dots_x, double dots_y) {
  Photosite site;
  site.shape = shape, site.width = width, site.height = height;
  site.separation_x = dots_x, site.separation_y = dots_y;
  return site;
}

using Shape = Photosite::Shape;
const Photosite sites[] = {{},
                           site_of(Shape::rectangle, 0.7, 0.4, 0, 0),
                           site_of(Shape::rectangle, 1, 1, 0.5, 0.3),
                           site_of(Shape::rectangle, 0.6, 0.8, 0, 1.2),
                           site_of(Shape::ellipse, 0.9, 0.5, 0.4, 0.4)};

/// The characteristic function of the places about the pixel's centre is the transform that targets use, in
/// closed form.
TEST(FilmSampling, PlacesHaveTheTransformOfPhotositeAndFilter) {
  const PixelWindow window{3, 2, 10, 9};
  for (const Photosite& site : sites) {
    const FilmSampling film(window, site);
    for (const auto& [fx, fy] : {std::pair{0.3, 0.0}, {0.0, 0.4}, {0.25, 0.35}, {0.7, -0.2}}) {
      std::complex<double> sum = 0;
      constexpr int count = 1 << 14;
      for (int i = 0; i < count; ++i) {
        SobolSample sample(7, static_cast<std::uint32_t>(i));
        const auto [x, y, u, v] = sample.next4();
        const FilmSample place = film.place({5, 6}, x, y, u, v);
        sum += std::polar(1.0 / count, -2 * pi * (fx * (place.column - 5.5) + fy * (place.row - 6.5)));
      }
      // Sobol points: errors below log²(N)/N = 6e-3, in practice a hundredth of it.
      EXPECT_LT(std::abs(sum - site.transform(fx, fy)), 2e-4) << site.text() << " at " << fx << ", " << fy;
    }
  }
}

TEST(FilmSampling, ThePixelOfASampleGathersItsLight) {
  const PixelWindow window{3, 2, 10, 9};
  for (const Photosite& site : sites) {
    const FilmSampling film(window, site);
    for (std::uint32_t i = 0; i < 1000; ++i) {
      SobolSample sample(3, i);
      const auto [x, y, u, v] = sample.next4();
      const FilmSample place = film.place({3, 8}, x, y, u, v);
      const std::optional<Pixel> pixel = film.pixel_at(place, place.column, place.row);
      ASSERT_TRUE(pixel) << site.text();
      EXPECT_EQ(pixel->column, 3);
      EXPECT_EQ(pixel->row, 8);
      // To the left of the window, by any dot.
      EXPECT_FALSE(film.pixel_at(place, place.column - 1, place.row));
      EXPECT_FALSE(film.pixel_at(place, 1e300, std::nan("")));
    }
  }
}

/// Light everywhere: as many places as the photosites' share of the film are gathered.
TEST(FilmSampling, PhotositesGatherTheirShareOfTheFilm) {
  for (const Photosite& site : sites) {
    const FilmSampling film({0, 0, 10, 10}, site);
    const FilmSample through = film.place({5, 5}, 0.2, 0.7, 0, 0);
    int gathered = 0;
    constexpr int side = 500;
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j)
        gathered += film.pixel_at(through, 4 + (i + 0.5) / side, 4 + (j + 0.5) / side).has_value();
    const double area = site.width * site.height * (site.shape == Shape::ellipse ? pi / 4 : 1);
    // A grid of cells along an outline of at most 4: 4/500 of an area of 1 and less.
    EXPECT_NEAR(gathered / double(side * side), area, 0.008) << site.text();
  }
}

TEST(FilmSampling, RefusesPhotositesThatOverlap) {
  for (const Photosite& site : {site_of(Shape::rectangle, 1.1, 1, 0, 0), site_of(Shape::none, 1, 1, 0, 0),
                                site_of(Shape::ellipse, 0, 1, 0, 0)})
    EXPECT_THROW(FilmSampling({0, 0, 2, 2}, site), InputError) << site.text();
}

}  // namespace
}  // namespace petzval::render
