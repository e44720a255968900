// SPDX-License-Identifier: BSD-3-Clause
// Autofocus on pictures whose truth is known: waves whose contrast the disc of defocus takes away, in closed
// form.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/focus/autofocus.h>
#include <petzval/focus/focus_scan.h>
#include <petzval/focus/golden_search_2006.h>
#include <petzval/numeric/random.h>

#include <cmath>

namespace petzval {
namespace {

constexpr int side = 40;
constexpr double pixel_mm = 0.02;

/// What one zone looks at, and through which lens.
struct Subject {
  double sharp_at_mm = 52;  ///< film distance of the sharp image
  double f_number = 2;
  double spherical_mm = 0;  ///< marginal focus minus paraxial focus
  double noise = 0;         ///< standard deviation, of a contrast of 1
  std::uint64_t texture = 1;
};

/// A scene of waves in all directions whose strength falls as 1/frequency, as that of natural scenes does
/// (Field 1987).
struct Wave {
  double fx, fy, phase, strength;  ///< cycles a pixel
};

std::vector<Wave> waves(std::uint64_t texture) {
  RandomStream random(texture, 1, 0);
  std::vector<Wave> result;
  for (int i = 0; i < 60; ++i) {
    const double frequency = 0.01 * std::pow(50.0, (i + random.uniform()) / 60),
                 turn = 2 * M_PI * random.uniform();
    result.push_back(
        {frequency * std::cos(turn), frequency * std::sin(turn), 2 * M_PI * random.uniform(), 1});
  }
  return result;  // even over the logarithm of frequency: power 1/f² in two dimensions
}

/// What is left of a wave after the pupil's rays, each ring focused where its part of the pupil focuses, and
/// the square of the pixel: ∫ J0(2π f r(ρ)) dρ² · sinc · sinc.
double transfer(const Subject& subject, double film_mm, const Wave& wave) {
  constexpr int rings = 64;
  const double frequency = std::hypot(wave.fx, wave.fy);
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    const double rho2 = (i + 0.5) / rings, focus = subject.sharp_at_mm + subject.spherical_mm * rho2;
    const double reach = std::sqrt(rho2) * (film_mm - focus) / (2 * subject.f_number) / pixel_mm;
    sum += std::cyl_bessel_j(0, 2 * M_PI * frequency * std::abs(reach)) / rings;
  }
  const auto sinc = [](double x) { return x == 0 ? 1 : std::sin(M_PI * x) / (M_PI * x); };
  return sum * sinc(wave.fx) * sinc(wave.fy);
}

GreyPicture blurred(const Subject& subject, double film_mm, std::uint64_t noise_seed) {
  GreyPicture picture{side, side, std::vector<double>(side * side)};
  RandomStream noise(noise_seed, 2, static_cast<std::uint64_t>(std::lround(film_mm * 1e6)));
  for (const Wave& wave : waves(subject.texture)) {
    const double strength = wave.strength * transfer(subject, film_mm, wave) / 60;
    for (int row = 0; row < side; ++row)
      for (int column = 0; column < side; ++column)
        picture.values[static_cast<std::size_t>(row * side + column)] +=
            strength * std::cos(2 * M_PI * (wave.fx * column + wave.fy * row) + wave.phase);
  }
  for (double& value : picture.values) value += subject.noise * noise.normal();
  return picture;
}

PicturesAt camera(const std::vector<Subject>& subjects, int* asked = nullptr) {
  return [subjects, asked](double film_mm) {
    if (asked) ++*asked;
    std::vector<ZonePicture> pictures;
    for (const Subject& subject : subjects)
      pictures.push_back({blurred(subject, film_mm, 11),
                          subject.noise > 0 ? std::optional(blurred(subject, film_mm, 12)) : std::nullopt});
    return pictures;
  };
}

/// Half the depth of focus: where the blur disc is as wide as a pixel.
double depth_of_focus_mm(const Subject& subject) {
  return subject.f_number * pixel_mm;
}

struct Case {
  const char* name;
  std::vector<Subject> subjects;
  std::vector<FocusZone> zones;
  double nearest_mm, farthest_mm;
  double truth_mm;
};

std::vector<Case> cases() {
  const FocusZone whole;
  const Subject near{57.3, 2}, far{50.2, 2};
  return {
      {"near", {near}, {whole}, 49, 60, 57.3},
      {"far", {far}, {whole}, 49, 60, 50.2},
      {"two zones", {{53.1, 2, 0, 0, 3}, {53.1, 2, 0, 0, 4}}, {{0, .3, 0, 1}, {.5, 1, 0, 1}}, 49, 60, 53.1},
      {"telephoto wide open", {{262.7, 5.6}}, {whole}, 250, 275, 262.7},
      {"noisy", {{55.0, 2, 0, 0.002}}, {whole}, 49, 60, 55.0}};
}

TEST(Autofocus, FindsTheTruthInTwelvePictures) {
  for (const Case& each : cases()) {
    FocusSearchOptions options;
    options.nearest_mm = each.nearest_mm, options.farthest_mm = each.farthest_mm;
    options.depth_mm = depth_of_focus_mm(each.subjects[0]);
    int asked = 0;
    const FocusResult result = find_focus(camera(each.subjects, &asked), each.zones, options);
    EXPECT_LE(asked, 12) << each.name;
    EXPECT_EQ(asked, static_cast<int>(result.evaluations.size()));
    EXPECT_NEAR(result.film_distance_mm, each.truth_mm, depth_of_focus_mm(each.subjects[0]) / 10)
        << each.name;
    EXPECT_FALSE(result.at_the_end) << each.name;
  }
}

/// With spherical aberration the best place is no marginal and no paraxial focus; brute force says where.
TEST(Autofocus, AgreesWithBruteForceUnderSphericalAberration) {
  const Subject subject{52.4, 2, -0.3};
  FocusSearchOptions options;
  options.nearest_mm = 49, options.farthest_mm = 56;
  options.depth_mm = depth_of_focus_mm(subject);
  const PicturesAt pictures = camera({subject});
  const FocusResult result = find_focus(pictures, {FocusZone{}}, options);
  double best = 0, best_mm = 0;
  for (double mm = 52.0; mm <= 52.5; mm += 0.002) {
    const double measure = focus_measure(pictures(mm)[0], options.measure);
    if (measure > best) best = measure, best_mm = mm;
  }
  EXPECT_NEAR(result.film_distance_mm, best_mm, depth_of_focus_mm(subject) / 10);
  EXPECT_LE(result.evaluations.size(), 12u);
}

/// The baseline finds it too, with more pictures.
TEST(Autofocus, GoldenSectionOf2006NeedsMorePictures) {
  const Subject subject{57.3, 2};
  GoldenSearchOptions golden;
  golden.nearest_mm = 49, golden.farthest_mm = 60;
  golden.tolerance_mm = depth_of_focus_mm(subject) / 5;
  const FocusResult baseline = find_focus_2006(camera({subject}), {FocusZone{}}, golden);
  FocusSearchOptions options;
  options.nearest_mm = 49, options.farthest_mm = 60;
  options.depth_mm = depth_of_focus_mm(subject);
  const FocusResult result = find_focus(camera({subject}), {FocusZone{}}, options);
  EXPECT_NEAR(baseline.film_distance_mm, 57.3, depth_of_focus_mm(subject) / 3);
  EXPECT_LT(result.evaluations.size(), baseline.evaluations.size());
}

/// And ends where it is told to, with what it has seen.
TEST(Autofocus, GoldenSectionOf2006HeedsHowManyPicturesItMayTake) {
  const Subject subject{57.3, 2};
  GoldenSearchOptions golden;
  golden.nearest_mm = 49, golden.farthest_mm = 60;
  golden.tolerance_mm = depth_of_focus_mm(subject) / 5;
  const FocusResult whole = find_focus_2006(camera({subject}), {FocusZone{}}, golden);
  for (const int most : {2, 3, 5, 1000}) {
    golden.most_evaluations = most;
    const FocusResult result = find_focus_2006(camera({subject}), {FocusZone{}}, golden);
    ASSERT_EQ(result.evaluations.size(),
              std::min<std::size_t>(whole.evaluations.size(), static_cast<std::size_t>(most)));
    for (std::size_t i = 0; i < result.evaluations.size(); ++i)
      EXPECT_EQ(result.evaluations[i].film_distance_mm, whole.evaluations[i].film_distance_mm);
  }
  golden.most_evaluations = 1;
  EXPECT_THROW(find_focus_2006(camera({subject}), {FocusZone{}}, golden), InputError);
}

/// Wherever the peak lies between the coarse places, and however fine the pixels are against the range: a
/// search that creeps towards a peak from one side runs out of evaluations.
TEST(Autofocus, FindsTheTruthAnywhereInTheRange) {
  for (const double sharp_at_mm : {49.3, 50.9, 51.75, 53.0, 54.4, 55.6, 57.1, 58.2, 59.8}) {
    const Subject subject{sharp_at_mm, 1.4, 0, 0, 5};
    FocusSearchOptions options;
    options.nearest_mm = 49, options.farthest_mm = 60;
    options.depth_mm = depth_of_focus_mm(subject);  // a 390th of the range
    const FocusResult result = find_focus(camera({subject}), {FocusZone{}}, options);
    EXPECT_LE(result.evaluations.size(), 12u) << sharp_at_mm;
    EXPECT_NEAR(result.film_distance_mm, sharp_at_mm, depth_of_focus_mm(subject) / 10);
  }
}

/// A range of 700 depths of focus, in noise that hides the detail of single pixels but near the peak: coarser
/// detail shows the way.
TEST(Autofocus, FindsSmallPeaksInWideRanges) {
  for (const double sharp_at_mm : {54.4, 57.1, 62.0}) {
    const Subject subject{sharp_at_mm, 1.4, 0, 0.0004, 7};
    FocusSearchOptions options;
    options.nearest_mm = 50, options.farthest_mm = 69.6;
    options.depth_mm = depth_of_focus_mm(subject);
    const FocusResult result = find_focus(camera({subject}), {FocusZone{}}, options);
    EXPECT_LE(result.evaluations.size(), 12u) << sharp_at_mm;
    EXPECT_NEAR(result.film_distance_mm, sharp_at_mm, depth_of_focus_mm(subject) / 5) << sharp_at_mm;
  }
}

/// A scan needs no luck, only places; the cubic says where between them the peak is.
TEST(Autofocus, AScanFindsThePeakBetweenItsPlaces) {
  const Subject subject{53.137, 2};
  const double depth = depth_of_focus_mm(subject);
  const FocusResult result =
      scan_focus(camera({subject}), {FocusZone{}}, {}, 53.1 - 2 * depth, 53.1 + 2 * depth, 11);
  EXPECT_EQ(result.evaluations.size(), 11u);
  EXPECT_NEAR(result.film_distance_mm, 53.137, depth / 50);
  EXPECT_FALSE(result.at_the_end);
  EXPECT_TRUE(scan_focus(camera({subject}), {FocusZone{}}, {}, 49, 53, 5).at_the_end);
  EXPECT_THROW(scan_focus(camera({subject}), {FocusZone{}}, {}, 49, 53, 2), InputError);
}

TEST(Autofocus, SaysWhenTheSharpPlaceMayLieBeyond) {
  FocusSearchOptions options;
  options.nearest_mm = 49, options.farthest_mm = 51;
  EXPECT_TRUE(find_focus(camera({Subject{52, 2}}), {FocusZone{}}, options).at_the_end);
}

TEST(Autofocus, RefusesWhatMakesNoSense) {
  FocusSearchOptions options;
  options.nearest_mm = 60, options.farthest_mm = 50;
  EXPECT_THROW(find_focus(camera({Subject{}}), {FocusZone{}}, options), InputError);
  options.farthest_mm = 70;
  EXPECT_THROW(find_focus(camera({Subject{}}), {}, options), InputError);
  options.most_evaluations = options.coarse - 1;
  try {
    find_focus(camera({Subject{}}), {FocusZone{}}, options);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("in 4 evaluations; 5 or more"), std::string::npos)
        << error.what();
  }
  options.most_evaluations = FocusSearchOptions().most_evaluations;
  const PicturesAt blank = [](double) {
    return std::vector<ZonePicture>{{{8, 8, std::vector<double>(64, 1.0)}, {}}};
  };
  EXPECT_THROW(find_focus(blank, {FocusZone{}}, options), InputError);
  const PicturesAt none = [](double) { return std::vector<ZonePicture>{}; };
  EXPECT_THROW(find_focus(none, {FocusZone{}}, options), InputError);
}

/// A ramp has no Laplacian, a parabola a constant one; steps and thresholds count as they should.
TEST(FocusMeasure, KnownPictures) {
  GreyPicture ramp{9, 9, std::vector<double>(81)}, bowl = ramp;
  for (int row = 0; row < 9; ++row)
    for (int column = 0; column < 9; ++column) {
      ramp.values[static_cast<std::size_t>(9 * row + column)] = 2.0 * column + 3.0 * row;
      bowl.values[static_cast<std::size_t>(9 * row + column)] = 1.0 * column * column - 1.0 * row * row;
    }
  FocusMeasureOptions sml{FocusMeasure::sum_modified_laplacian};
  EXPECT_NEAR(focus_measure({ramp, {}}, sml), 0, 1e-12);
  // |2| + |−2|: the modified Laplacian does not cancel where the plain one is zero (Nayar).
  EXPECT_NEAR(focus_measure({bowl, {}}, sml), 4, 1e-12);
  sml.step = 2;
  EXPECT_NEAR(focus_measure({bowl, {}}, sml), 16, 1e-12);
  sml.threshold = 16.5;
  EXPECT_EQ(focus_measure({bowl, {}}, sml), 0);
  EXPECT_NEAR(focus_measure({ramp, {}}, {FocusMeasure::gradient_energy}), 4 + 9, 1e-12);
  EXPECT_NEAR(focus_measure({bowl, {}}, {FocusMeasure::laplacian_energy}), 0, 1e-12);
}

TEST(FocusMeasure, BinsWholeSquares) {
  GreyPicture picture{35, 26, {}};
  for (int row = 0; row < 26; ++row)
    for (int column = 0; column < 35; ++column) picture.values.push_back(column + 100.0 * row);
  const GreyPicture half = binned(picture, 3);
  EXPECT_EQ(half.columns, 11);
  EXPECT_EQ(half.rows, 8);
  EXPECT_NEAR(half.at(2, 5), 7 + 1600, 1e-9);
  // An eighth of 26 is 3.
  EXPECT_EQ(binned(picture, 10).columns, 11);
  EXPECT_EQ(binned(picture, 1).values, picture.values);
}

/// Two pictures of pure noise that share nothing measure nothing; one alone measures its noise.
TEST(FocusMeasure, TwoPicturesTakeTheNoiseOut) {
  GreyPicture a{100, 100, std::vector<double>(10000)}, b = a;
  RandomStream random(1, 3, 0);
  for (double& value : a.values) value = random.normal();
  for (double& value : b.values) value = random.normal();
  const FocusMeasureOptions options{FocusMeasure::gradient_energy};
  // Sobel/8 of white noise: 12/64 for each direction.
  EXPECT_NEAR(focus_measure({a, {}}, options), 24.0 / 64, 0.03);
  EXPECT_LT(focus_measure({a, b}, options), 0.02);
}

/// The scatter of the measure over pairs of pictures with other noise, beside what single pairs say of it.
TEST(FocusMeasure, KnowsItsNoise) {
  for (const char* name : {"gradient", "laplacian", "sml"}) {
    const FocusMeasureOptions options{focus_measure_of(name)};
    constexpr int pairs = 100;
    constexpr int pixels = 48;
    double sum = 0, squares = 0, estimate = 0;
    RandomStream random(3, 5, 0);
    const auto noisy = [&random] {
      GreyPicture picture{pixels, pixels, {}};
      for (int i = 0; i < pixels * pixels; ++i)
        picture.values.push_back(std::sin(0.3 * (i % pixels)) + 0.4 * random.normal());
      return picture;
    };
    for (int i = 0; i < pairs; ++i) {
      const ZonePicture pair{noisy(), noisy()};
      const double measure = focus_measure(pair, options), noise = focus_measure_noise(pair, options);
      sum += measure / pairs, squares += measure * measure / pairs, estimate += noise * noise / pairs;
    }
    // A variance from 100 draws is known to 14 %: three times that. The measure that does not multiply adds
    // the mean of two absolute values that are not independent of the pair: less than a factor of two.
    const double ratio = std::sqrt(estimate / (squares - sum * sum));
    EXPECT_GT(ratio, 0.7) << name;
    EXPECT_LT(ratio, 2.0) << name;
  }
  EXPECT_EQ(focus_measure_noise({GreyPicture{32, 32, std::vector<double>(1024, 1.0)}, {}}, {}), 0);
}

TEST(Autofocus, SaysHowLargeItsNoiseIs) {
  FocusSearchOptions options;
  options.nearest_mm = 49, options.farthest_mm = 60;
  const auto share = [&](double noise) {
    return find_focus(camera({Subject{55, 2, 0, noise}}), {FocusZone{}}, options).noise_share();
  };
  EXPECT_EQ(share(0), 0);
  EXPECT_LT(share(0.002), 0.1);
  EXPECT_GT(share(0.2), 0.1);
}

TEST(FocusZones, AreReadAsTheAssignmentHasThem) {
  const auto zones = parse_focus_zones(
      "# left right top bottom\n0.25 0.5 0.1 0.4   # a face\n\n0.6, 0.9, 0.5, 1\n", "z.txt");
  ASSERT_EQ(zones.size(), 2u);
  EXPECT_DOUBLE_EQ(zones[0].right, 0.5);
  EXPECT_DOUBLE_EQ(zones[1].bottom, 1);
  EXPECT_NEAR(zones[0].area(), 0.075, 1e-15);
  for (const char* bad : {"", "# nothing\n", "0 1 0\n", "0 1 0 1 1\n", "0.5 0.4 0 1\n", "-0.1 0.4 0 1\n",
                          "0 1 0 1.1\n", "a b c d\n", "0 nan 0 1\n"})
    EXPECT_THROW(parse_focus_zones(bad, "z.txt"), InputError) << bad;
  try {
    parse_focus_zones("0 1 0 1\n0 2 0 1\n", "z.txt");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("z.txt:2: ", 0), 0u) << error.what();
  }
}

}  // namespace
}  // namespace petzval
