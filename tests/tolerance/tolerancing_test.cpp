// SPDX-License-Identifier: BSD-3-Clause
// Tolerancing: lenses off the line against sensitivities in quadrature, judging against the tables of the
// analyses, yields against binomial sums, and the same builds on any number of threads.
#include <gtest/gtest.h>
#include <petzval/analysis/mtf.h>
#include <petzval/analysis/spots.h>
#include <petzval/analysis/wavefront.h>
#include <petzval/base/error.h>
#include <petzval/lens/lens_file.h>
#include <petzval/tolerance/tolerancing.h>

#include <array>
#include <cmath>
#include <functional>

namespace petzval {
namespace {

Lens triplet() {
  return read_lens("cooke-triplet").lens;
}

std::string complaint(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

ToleranceRequest small_request() {
  ToleranceRequest request;
  request.judge.at.fields = {0, 10};
  request.judge.at.wavelengths_nm = {587.5618};
  request.builds = 12;
  return request;
}

TEST(Judge, SpotsAreThoseOfTheSpotTable) {
  // A lens with errors of every kind, judged where its sensor stands: 8 × 48 rays a pupil against the 20 ×
  // 128 of the table. Half a per cent is a tenth of the smallest change that anyone would act on.
  const std::vector<Tolerance> tolerances = graded_tolerances(triplet(), "commercial");
  const Lens built = built_lens(triplet(), tolerances, draw_build(tolerances, {}, 5, 0));
  JudgeRequest request;
  request.at.fields = {0, 10, 18};
  request.at.wavelengths_nm = {587.5618};
  request.refocus = false;
  const Judgement judgement = judge(built, request);
  const std::vector<FieldPoint> points = points_of(built, request);
  ASSERT_EQ(judgement.at_points.size(), 9u);  // the axis once
  double squares = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    FieldTracer tracer(built, 587.5618, Tracer::Clip::apertures, points[i].azimuth_deg);
    const SpotRow row = *spot(tracer, *tracer.chief_ray(points[i].field), RayWeight::light);
    EXPECT_NEAR(judgement.at_points[i] / row.rms_radius_um, 1, 5e-3) << i;
    squares += judgement.at_points[i] * judgement.at_points[i];
  }
  EXPECT_NEAR(judgement.overall, std::sqrt(squares / 9), 1e-9);
  EXPECT_EQ(judgement.worst, *std::max_element(judgement.at_points.begin(), judgement.at_points.end()));
  EXPECT_EQ(judgement.refocus_mm, 0);
}

TEST(Judge, RefocusingIsMovingTheSensorToTheSmallestSpots) {
  Lens lens = triplet();
  lens.surfaces.back().thickness_mm += 0.4;
  JudgeRequest request;
  const Judgement focused = judge(lens, request);
  request.refocus = false;
  const auto at = [&](double shift_mm) {
    Lens moved = lens;
    moved.surfaces.back().thickness_mm += shift_mm;
    return judge(moved, request).overall;
  };
  EXPECT_LT(focused.refocus_mm, -0.2);
  // Rays are straight, so that the sensor's move is told exactly; chief rays to 1e-9.
  EXPECT_NEAR(at(focused.refocus_mm) / focused.overall, 1, 1e-6);
  EXPECT_GT(at(focused.refocus_mm + 0.01), focused.overall);
  EXPECT_GT(at(focused.refocus_mm - 0.01), focused.overall);
}

TEST(Judge, MtfIsThatOfTheMtfTable) {
  Lens lens = triplet();
  lens.surfaces[2].pose.tilt_x_deg = 0.1;
  JudgeRequest request;
  request.at.fields = {10};
  request.azimuths_deg = {90};
  request.merit = {Merit::Kind::mtf, 30};
  const Judgement judgement = judge(lens, request);
  FieldTableRequest at = FieldTableRequest::of(lens);
  at.fields = {10};
  at.azimuth_deg = 90;
  MtfOptions options;
  options.frequencies_cpmm = {30};
  options.weights = {1, 1, 1};
  options.sensor_shifts_mm = {judgement.refocus_mm};
  const MtfRow row = mtf_table(lens, at, options).front();
  // Quick pupils against those of the table (PupilDetail).
  EXPECT_NEAR(judgement.overall, 0.5 * (row.tangential + row.sagittal), 2e-3);
}

/// What one build does to the wave of a point: defocus [mm of sensor], and Zernike's coma and astigmatism
/// over the stop [waves], two components each.
struct Errors {
  static constexpr std::size_t count = 5;
  std::array<double, count> value{};
};

Errors errors_of(const Lens& lens) {
  FieldTracer tracer(lens, 587.5618, Tracer::Clip::stop_only);
  const ChiefRay chief = *tracer.chief_ray(8);
  const std::vector<PupilRay> rays = pupil_rays(tracer, chief, {8, 48});
  const std::vector<double> waves = opd_waves(tracer, chief, rays);
  const double stop = tracer.tracer().stop_radius_mm();
  std::array<double, Errors::count> sums{};
  double area = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::array<double, 2> signs{1, -1};
    for (const double sign : std::span(signs).first(rays[i].mirrored ? 2 : 1)) {
      const double x = sign * rays[i].stop_x_mm / stop, y = rays[i].stop_y_mm / stop, r = x * x + y * y;
      const double w = rays[i].stop_area_mm2;
      area += w;
      sums[0] += w * waves[i] * std::sqrt(3) * (2 * r - 1);
      sums[1] += w * waves[i] * std::sqrt(8) * (3 * r - 2) * y;
      sums[2] += w * waves[i] * std::sqrt(8) * (3 * r - 2) * x;
      sums[3] += w * waves[i] * std::sqrt(6) * (y * y - x * x);
      sums[4] += w * waves[i] * std::sqrt(6) * 2 * x * y;
    }
  }
  Errors errors;
  for (std::size_t k = 0; k < Errors::count; ++k) errors.value[k] = sums[k] / area;
  return errors;
}

TEST(Tolerancing, BuildsSpreadAsSensitivitiesInQuadrature) {
  // Uniform errors have a variance of limit²/3, those across the axis of limit²/4 a component. Means are
  // those of the design plus half the second derivatives times the variances. A deviation of 1,500 builds is
  // known to 1/√3000 = 1.8 %, a mean to a 39th of the deviation: four of these each.
  const Lens lens = triplet();
  const std::vector<Tolerance> tolerances = graded_tolerances(lens, "high");
  const Errors designed = errors_of(lens);
  std::array<double, Errors::count> variance{}, shift{};
  for (const Tolerance& tolerance : tolerances) {
    const bool across = find_tolerance_kind(tolerance.kind)->has_direction;
    const double limit = tolerance.limit, of_one = limit * limit / (across ? 4 : 3);
    for (int axis = 0; axis < (across ? 2 : 1); ++axis) {
      const auto at = [&](double x) {
        return errors_of(axis == 0 ? with_error(lens, tolerance, x) : with_error(lens, tolerance, 0, x));
      };
      const Errors plus = at(limit), minus = at(-limit);
      for (std::size_t k = 0; k < Errors::count; ++k) {
        const double slope = (plus.value[k] - minus.value[k]) / (2 * limit);
        const double bend = (plus.value[k] + minus.value[k] - 2 * designed.value[k]) / (limit * limit);
        variance[k] += slope * slope * of_one;
        shift[k] += 0.5 * bend * of_one;
      }
    }
  }
  constexpr int builds = 1500;
  std::array<double, Errors::count> sum{}, squares{};
  for (std::size_t i = 0; i < builds; ++i) {
    const Build build = draw_build(tolerances, ErrorDistribution::uniform, 3, i);
    const Errors errors = errors_of(built_lens(lens, tolerances, build));
    for (std::size_t k = 0; k < Errors::count; ++k) {
      const double change = errors.value[k] - designed.value[k];
      sum[k] += change, squares[k] += change * change;
    }
  }
  for (std::size_t k = 0; k < Errors::count; ++k) {
    const double mean = sum[k] / builds, deviation = std::sqrt(squares[k] / builds - mean * mean);
    const double expected = std::sqrt(variance[k]);
    EXPECT_GT(expected, 1e-3) << k << ": nothing to show [waves]";
    EXPECT_NEAR(deviation / expected, 1, 4 / std::sqrt(2.0 * builds)) << k;
    EXPECT_NEAR(mean, shift[k], 4 * expected / std::sqrt(1.0 * builds)) << k;
  }
}

TEST(Tolerancing, SensitivitiesAreThoseOfTheAlteredLens) {
  ToleranceRequest request = small_request();
  request.builds = 0;
  const ToleranceReport report = tolerance_lens(triplet(), request);
  ASSERT_EQ(report.sensitivities.size(), report.tolerances.size());
  double last = 1e9, mean = 0;
  for (const Sensitivity& row : report.sensitivities) {
    EXPECT_LE(row.worst_change, last) << "the worst come first";
    last = row.worst_change;
    EXPECT_LE(row.best_change, row.mean_change);
    EXPECT_LE(row.mean_change, row.worst_change);
    mean += row.mean_change;
  }
  EXPECT_NEAR(report.expected_change, mean, 1e-12);
  const Tolerance& worst = report.sensitivities.front().tolerance;
  double largest = -1e9;
  for (const auto& [x, y] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    const Lens off = with_error(triplet(), worst, x * worst.limit, y * worst.limit);
    largest = std::max(largest, judge(off, request.judge).overall - report.designed.overall);
  }
  EXPECT_EQ(report.sensitivities.front().worst_change, largest);
}

TEST(Tolerancing, InverseLimitsCostWhatWasAsked) {
  ToleranceRequest request = small_request();
  request.builds = 0;
  request.tolerances = {parse_tolerance("element_tilt_deg@2-3=0.05"), parse_tolerance("thickness_mm@1=0.05"),
                        parse_tolerance("index@0=1e-9")};
  request.inverse_change = 0.5;
  const ToleranceReport report = tolerance_lens(triplet(), request);
  for (const Sensitivity& row : report.sensitivities) {
    if (row.tolerance.kind == "index") {
      EXPECT_FALSE(row.inverse_limit) << "20 times a thousandth of a millionth does nothing";
      continue;
    }
    ASSERT_TRUE(row.inverse_limit);
    double worst = 0;
    for (const auto& [x, y] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const Lens off = with_error(triplet(), row.tolerance, x * *row.inverse_limit, y * *row.inverse_limit);
      worst = std::max(worst, judge(off, request.judge).overall - report.designed.overall);
    }
    EXPECT_NEAR(worst, 0.5, 0.5 * 5e-3) << row.tolerance.kind;
  }
}

TEST(Tolerancing, TheSameBuildsOnAnyNumberOfThreads) {
  ToleranceRequest request = small_request();
  request.sensitivities = false;
  const auto run = [&](int threads, std::uint64_t seed) {
    Context context;
    context.threads = threads;
    context.seed = seed;
    std::vector<double> values;
    for (const Build& build : tolerance_lens(triplet(), request, context).builds) {
      values.insert(values.end(), build.errors_x.begin(), build.errors_x.end());
      values.insert(values.end(), build.errors_y.begin(), build.errors_y.end());
      values.insert(values.end(), build.judgement.at_points.begin(), build.judgement.at_points.end());
    }
    return values;
  };
  const std::vector<double> one = run(1, 4);
  EXPECT_EQ(one, run(2, 4));
  EXPECT_NE(one, run(1, 5));
  // A build is the same whatever else is built.
  request.builds = 3;
  const std::vector<double> few = run(1, 4);
  EXPECT_TRUE(std::equal(few.begin(), few.end(), one.begin()));
}

TEST(Tolerancing, ErrorsKeepTheirLimits) {
  const std::vector<Tolerance> tolerances = {parse_tolerance("thickness_mm@1=0.2"),
                                             parse_tolerance("element_tilt_deg@2-3=0.1")};
  for (const auto distribution :
       {ErrorDistribution::normal, ErrorDistribution::uniform, ErrorDistribution::at_limit})
    for (std::size_t i = 0; i < 500; ++i) {
      const Build build = draw_build(tolerances, distribution, 1, i);
      EXPECT_LE(std::abs(build.errors_x[0]), 0.2);
      EXPECT_EQ(build.errors_y[0], 0);
      const double tilt = std::hypot(build.errors_x[1], build.errors_y[1]);
      EXPECT_LE(tilt, 0.1 + 1e-12);
      if (distribution == ErrorDistribution::at_limit) {
        EXPECT_NEAR(std::abs(build.errors_x[0]), 0.2, 1e-12);
        EXPECT_NEAR(tilt, 0.1, 1e-12);
      }
    }
}

/// P(X ≥ k) of n with chance p, term by term.
double at_least(int k, int n, double p) {
  double sum = 0;
  for (int i = k; i <= n; ++i)
    sum += std::exp(std::lgamma(n + 1) - std::lgamma(i + 1) - std::lgamma(n - i + 1) + i * std::log(p) +
                    (n - i) * std::log1p(-p));
  return sum;
}

TEST(Tolerancing, YieldHasItsInterval) {
  // Clopper and Pearson: at either end of the interval the count that was seen, or one beyond it, has a
  // chance of 2.5 %.
  ToleranceRequest request = small_request();
  request.sensitivities = false;
  request.builds = 20;
  std::vector<double> worst;
  for (const Build& build : tolerance_lens(triplet(), request).builds) worst.push_back(build.judgement.worst);
  std::sort(worst.begin(), worst.end());
  request.accept = 0.5 * (worst[13] + worst[14]);
  const ToleranceReport report = tolerance_lens(triplet(), request);
  EXPECT_EQ(report.yield, 0.7);
  EXPECT_NEAR(at_least(14, 20, report.yield_low), 0.025, 1e-9);
  EXPECT_NEAR(1 - at_least(15, 20, report.yield_high), 0.025, 1e-9);
  request.accept = 0.5 * worst.front();
  const ToleranceReport none = tolerance_lens(triplet(), request);
  EXPECT_EQ(none.yield, 0);
  EXPECT_EQ(none.yield_low, 0);
  EXPECT_NEAR(std::pow(1 - none.yield_high, 20), 0.025, 1e-9);
}

TEST(Tolerancing, OwnTolerancesComeBeforeGrades) {
  Lens lens = triplet();
  EXPECT_EQ(tolerances_of(lens, {}).size(), graded_tolerances(lens, "precision").size());
  lens.tolerances = {parse_tolerance("thickness_mm@1=0.2")};
  EXPECT_EQ(tolerances_of(lens, {}).size(), 1u);
  ToleranceRequest request;
  request.tolerances = {parse_tolerance("thickness_mm@2=0.2"), parse_tolerance("thickness_mm@3=0.2")};
  EXPECT_EQ(tolerances_of(lens, request).size(), 2u);
}

TEST(Tolerancing, SaysWhatWouldBeRight) {
  const auto with = [](const std::function<void(ToleranceRequest&)>& change) {
    return complaint([&] {
      ToleranceRequest request = small_request();
      change(request);
      tolerance_lens(triplet(), request);
    });
  };
  EXPECT_NE(with([](auto& r) { r.builds = -1; }).find("0 to"), std::string::npos);
  EXPECT_NE(with([](auto& r) { r.accept = 0; }).find("a positive RMS spot"), std::string::npos);
  EXPECT_NE(with([](auto& r) { r.inverse_change = -1; }).find("a positive change"), std::string::npos);
  EXPECT_NE(with([](auto& r) { r.grade = "best"; }).find("commercial"), std::string::npos);
  EXPECT_NE(with([](auto& r) { r.judge.azimuths_deg = {}; }).find("0,90,180,270"), std::string::npos);
  EXPECT_NE(with([](auto& r) {
              r.judge.merit = {Merit::Kind::mtf, 0};
            }).find("positive frequency"),
            std::string::npos);
  EXPECT_NE(with([](auto& r) { r.tolerances = {parse_tolerance("index@1=0.1")}; }).find("air"),
            std::string::npos);
}

TEST(Tolerancing, StopsWhenTold) {
  ToleranceRequest request = small_request();
  request.builds = 100'000;
  Context context;
  context.progress = [](double, const std::string&) { return false; };
  EXPECT_THROW(tolerance_lens(triplet(), request, context), Cancelled);
}

}  // namespace
}  // namespace petzval
