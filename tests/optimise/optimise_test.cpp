// SPDX-License-Identifier: BSD-3-Clause
// Optimising: a spoiled lens is found again, limits hold, derivatives of the merit are its differences, and
// the same bytes come on any number of threads.
#include <gtest/gtest.h>
#include <petzval/analysis/best_focus.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/mtf.h>
#include <petzval/analysis/spots.h>
#include <petzval/base/error.h>
#include <petzval/glass/catalogue.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/lens/surface_shape.h>
#include <petzval/optimise/glass_choice.h>
#include <petzval/optimise/optimise.h>
#include <petzval/optimise/ray_merit.h>

#include <cmath>

namespace petzval {
namespace {

Lens optimisable(const char* name) {
  return read_lens(name).lens;
}

OptimiseRequest request_for(const Lens& lens, std::initializer_list<const char*> variables) {
  OptimiseRequest request;
  for (const char* text : variables)
    for (const LensVariable& variable : parse_lens_variables(lens, text))
      request.variables.push_back(variable);
  return request;
}

Lens with_curvatures(Lens lens, double factor) {
  for (Surface& surface : lens.surfaces) surface.curvature_per_mm *= factor;
  return lens;
}

/// RMS spot over fields and wavelengths, by the analysis of spots and not by the optimiser's rays.
double spot_um(const Lens& lens) {
  FieldTableRequest at = FieldTableRequest::of(lens);
  double squares = 0;
  std::size_t count = 0;
  // Each wavelength about its own centre: a little less than the optimiser's spot, alike before and after.
  for (const SpotRow& row : spot_table(lens, at)) squares += row.rms_radius_um * row.rms_radius_um, ++count;
  return std::sqrt(squares / static_cast<double>(count));
}

TEST(Optimise, FindsAFlattenedDoubleGaussAgain) {
  const Lens lens = optimisable("dgauss-50mm"), flat = with_curvatures(lens, 0.8);
  OptimiseRequest request = request_for(lens, {"radii", "image"});
  request.efl_mm = first_order(lens).efl_mm;
  const OptimiseResult result = optimise(flat, request);
  // The design stands a little out of its best focus: it is held to what it could be.
  const Lens best = optimise(lens, request).lens;
  EXPECT_LT(spot_um(best), spot_um(lens));
  EXPECT_GT(spot_um(flat), 10 * spot_um(best)) << "nothing was spoiled";
  EXPECT_LT(spot_um(result.lens), 1.05 * spot_um(best));
  // A thousandth of the focal length costs 5 um of a spot of that size.
  EXPECT_NEAR(result.efl_after_mm / *request.efl_mm, 1, 2e-3);
  EXPECT_EQ(result.lens.surfaces[3].thickness_mm, lens.surfaces[3].thickness_mm);
}

TEST(Optimise, SlopesAreDifferencesOfTheMerit) {
  const Lens lens = optimisable("cooke-triplet");
  for (const OptimiseMerit kind : {OptimiseMerit::rms_spot, OptimiseMerit::wavefront, OptimiseMerit::mtf}) {
    OptimiseRequest request = request_for(lens, {"radii", "gaps", "image", "surfaces[2].conic"});
    request.at = FieldTableRequest::of(lens);
    request.merit = kind, request.mtf_frequency_cpmm = 20;
    const RayMerit merit(lens, request);
    Eigen::MatrixXd slopes;
    const Eigen::VectorXd rows = *merit.residuals(lens, &slopes);
    for (std::size_t i = 0; i < request.variables.size(); ++i) {
      const LensNumber& number = request.variables[i].number;
      const double now = value_of(lens, number),
                   step = number.kind == LensNumber::Kind::thickness_mm ? 1e-4 : 1e-6;
      const auto at = [&](double value) {
        return *merit.residuals(with_value(lens, number, value), nullptr);
      };
      const Eigen::VectorXd difference = (at(now + step) - at(now - step)) / (2 * step);
      const auto column = slopes.col(static_cast<Eigen::Index>(i));
      // Central differences: their own curvature, steps of a micrometre against millimetres.
      EXPECT_LT((column - difference).norm(), 1e-4 * difference.norm()) << name_of(number);
    }
  }
}

TEST(Optimise, MeritIsTheSpotOfTheTable) {
  // One wavelength and field by field: 5 × 16 rays of the pupil against the 20 × 128 of the table, weighted
  // by light. A per cent is far less than what optimising gains.
  const Lens lens = optimisable("cooke-triplet");
  OptimiseRequest request;
  request.at = FieldTableRequest::of(lens);
  request.at.wavelengths_nm = {587.5618};
  const RayMerit merit(lens, request);
  const std::vector<double> fields = merit.by_field(*merit.residuals(lens, nullptr));
  for (std::size_t i = 0; i < fields.size(); ++i) {
    FieldTracer tracer(lens, 587.5618);
    const double object = object_field(lens, request.at.field_kind, request.at.fields[i]);
    const SpotRow row = *spot(tracer, *tracer.chief_ray(object), RayWeight::light);
    EXPECT_NEAR(fields[i] / row.rms_radius_um, 1, 0.01) << i;
  }
}

/// Of the tables: what the polychromatic MTF by rays lacks of 1, root mean square over fields and directions
/// [%].
double lost_mtf_percent(const Lens& lens, const FieldTableRequest& at, double frequency_cpmm) {
  MtfOptions options;
  options.geometric = true;
  options.frequencies_cpmm = {frequency_cpmm};
  options.weights.assign(at.wavelengths_nm.size(), 1);
  double squares = 0;
  for (const MtfRow& row : mtf_table(lens, at, options))
    squares += (std::pow(1 - row.tangential, 2) + std::pow(1 - row.sagittal, 2)) / 2;
  return 100 * std::sqrt(squares / static_cast<double>(at.fields.size()));
}

TEST(Optimise, AnMtfIsFoundThatAPlainScanDoesNotBetter) {
  // The conic of a singlet's front and its sensor do not alter its focal length: nothing else is weighed.
  const Lens lens = optimisable("plano-convex");
  OptimiseRequest request = request_for(lens, {"surfaces[0].conic", "image"});
  request.at = FieldTableRequest::of(lens);
  request.at.fields = {0, request.at.fields.back()};
  request.at.wavelengths_nm = {587.5618};
  request.merit = OptimiseMerit::mtf, request.mtf_frequency_cpmm = 3;
  const OptimiseResult result = optimise(lens, request);
  EXPECT_LT(result.after, result.before);
  const double found = lost_mtf_percent(result.lens, request.at, 3);
  // The merit's rays are weighted by light, the table's as its own: a point of contrast between them.
  EXPECT_NEAR(found, result.after, 1);
  double best = found;
  for (int i = -1; i <= 1; ++i)
    for (int k = -2; k <= 2; ++k) {
      Lens other = result.lens;
      other.surfaces[0].conic += 0.4 * i;
      other.surfaces.back().thickness_mm += 0.2 * k;
      best = std::min(best, lost_mtf_percent(other, request.at, 3));
    }
  EXPECT_GT(best, found - 0.3) << "a scan in steps of 0.4 and 0.2 mm finds one that is better";
}

TEST(Optimise, DistortionStaysWithinItsLimit) {
  const Lens lens = optimisable("cooke-triplet");
  OptimiseRequest request = request_for(lens, {"radii", "gaps", "image"});
  const auto largest_percent = [&](const Lens& of) {
    FieldTableRequest at = FieldTableRequest::of(of);
    at.wavelengths_nm = {of.reference_wavelength_nm};
    double largest = 0;
    for (const DistortionRow& row : distortion_table(of, at))
      if (row.field != 0) largest = std::max(largest, std::abs(row.paraxial_distortion_percent));
    return largest;
  };
  request.rounds = 4;
  const double free = largest_percent(optimise(lens, request).lens), limit = free / 3;
  request.most_distortion_percent = limit;
  // A hundredth of a per cent costs a micrometre of spot.
  EXPECT_LT(largest_percent(optimise(lens, request).lens), limit + 0.02);
  EXPECT_GT(free, limit + 0.05) << "there was nothing to hold";
}

TEST(Optimise, ThicknessesStayWithinTheirLimitsAndRimsThickEnough) {
  const Lens lens = with_curvatures(optimisable("cooke-triplet"), 0.9);
  OptimiseRequest request = request_for(lens, {"radii", "gaps=1:9", "thicknesses=0.9:5", "image"});
  request.least_rim_mm = 0.4;
  const OptimiseResult result = optimise(lens, request);
  EXPECT_LT(result.after, result.before);
  for (std::size_t i = 0; i + 1 < lens.surfaces.size(); ++i) {
    const Surface &front = result.lens.surfaces[i], &back = result.lens.surfaces[i + 1];
    if (front.material.is_air()) continue;
    EXPECT_GE(front.thickness_mm, 0.9);
    EXPECT_LE(front.thickness_mm, 5);
    const double height = std::min(*front.semi_diameter_mm, *back.semi_diameter_mm);
    const auto sag = [&](const Surface& surface) { return surface_point(shape_of(surface), 0, height).sag; };
    // A hundredth of a millimetre costs as much as the whole spot.
    EXPECT_GE(front.thickness_mm + sag(back) - sag(front), 0.4 - 0.01);
  }
}

TEST(Optimise, BringsALensToItsBestFocus) {
  // One variable: the sensor. Best focus of the analyses has a closed form; their rays are weighted by area
  // on the stop, ours by light, and a Cooke triplet's differ by under a hundredth of a millimetre.
  Lens lens = optimisable("cooke-triplet");
  lens.surfaces.back().thickness_mm += 0.5;
  const OptimiseResult result = optimise(lens, request_for(lens, {"image"}));
  const FieldTableRequest at = FieldTableRequest::of(lens);
  const BestFocus best = best_spot_focus(lens, at, {1, 1, 1});
  EXPECT_NEAR(result.lens.surfaces.back().thickness_mm - lens.surfaces.back().thickness_mm, best.shift_mm,
              0.02);
}

TEST(Optimise, StartsDoNotDependOnThreads) {
  const Lens lens = with_curvatures(optimisable("cooke-triplet"), 0.95);
  OptimiseRequest request = request_for(lens, {"radii", "image"});
  request.starts = 3;
  request.rounds = 3;
  Context one, two;
  one.threads = 1;
  const OptimiseResult a = optimise(lens, request, one), b = optimise(lens, request, two);
  EXPECT_EQ(a.after, b.after);
  EXPECT_EQ(lens_to_json(a.lens), lens_to_json(b.lens));
  EXPECT_LE(a.after, optimise(lens, request_for(lens, {"radii", "image"})).before);
}

TEST(Optimise, AWavefrontBecomesSmaller) {
  const Lens lens = with_curvatures(optimisable("cooke-triplet"), 0.97);
  OptimiseRequest request = request_for(lens, {"radii", "image"});
  request.merit = OptimiseMerit::wavefront;
  const OptimiseResult result = optimise(lens, request);
  EXPECT_LT(result.after, 0.5 * result.before);
  EXPECT_LT(spot_um(result.lens), spot_um(lens));
}

TEST(GlassChoice, NeighboursAreTheNearestOfTheMaker) {
  const auto glass = GlassCatalogue::bundled().find("SCHOTT:N-SF2");
  const std::vector<double> nm{480, 550, 640};
  const auto near = nearest_glasses(*glass, 6, nm);
  ASSERT_EQ(near.size(), 6U);
  // Every glass of the maker that is not among them is farther away than the last of them.
  double last = 0;
  for (const auto& each : near) {
    EXPECT_EQ(each->catalogue, "SCHOTT");
    EXPECT_NE(each->name, glass->name);
    const double distance = glass_distance(*glass->abbe(), *each->abbe());
    EXPECT_GE(distance, last) << each->name;
    last = distance;
  }
  for (const std::string& name : GlassCatalogue::bundled().full_names()) {
    if (!name.starts_with("SCHOTT:") || name == glass->full_name()) continue;
    const auto other = GlassCatalogue::bundled().find(name);
    const bool among = std::ranges::any_of(near, [&](const auto& each) { return each->full_name() == name; });
    if (!among && other->abbe()) {
      EXPECT_GE(glass_distance(*glass->abbe(), *other->abbe()), last) << name;
    }
  }
  EXPECT_GT(nearest_glasses(*glass, 10000, nm).size(), 50U);
}

/// A singlet, whose colour alone a glass can mend: by a law, the longitudinal colour of a thin lens is f/Vd.
Lens singlet(const char* glass) {
  Lens lens;
  lens.name = "singlet";
  lens.wavelengths_nm = {486.1327, 587.5618, 656.2725};
  lens.reference_wavelength_nm = 587.5618;
  lens.aperture = {Aperture::Kind::entrance_pupil_diameter_mm, 5};
  lens.surfaces = {Surface::sphere(55, 3, glass_material(glass), 4), Surface::sphere(-250, 86, {}, 4)};
  lens.surfaces[0].stop = true;
  return lens;
}

// Glasses of a singlet go towards large Vd, step by step as long as there is a
// nearer one that is better; and where they end no neighbour is better, each tried by itself.
TEST(Optimise, GlassesAreChosenUntilNoNeighbourIsBetter) {
  constexpr int neighbours = 8;
  const Lens lens = singlet("SCHOTT:N-BAK4");
  OptimiseRequest request = request_for(lens, {"radii", "image"});
  const OptimiseResult same_glass = optimise(lens, request);
  request.glasses = neighbours;
  const OptimiseResult result = optimise(lens, request);
  ASSERT_EQ(result.glasses.size(), 1U);
  EXPECT_EQ(result.glasses[0].before, "SCHOTT:N-BAK4");
  const auto chosen = catalogue_glass(result.lens, 0);
  EXPECT_EQ(result.glasses[0].after, chosen->full_name());
  const auto vd = [](const std::shared_ptr<const Glass>& glass) { return glass->abbe()->vd; };
  EXPECT_GT(vd(chosen), vd(catalogue_glass(lens, 0)));
  // The spot of a slow singlet at its best focus is colour alone: it goes as 1/Vd, to what spheres add.
  EXPECT_NEAR(result.after / same_glass.after, vd(catalogue_glass(lens, 0)) / vd(chosen), 0.1);
  OptimiseRequest alone = request;
  alone.glasses = 0;
  for (const auto& near : nearest_glasses(*chosen, neighbours, lens.wavelengths_nm)) {
    Lens other = result.lens;
    other.surfaces[0].material = Material(near);
    EXPECT_GT(optimise(other, alone).after, result.after * (1 - 1e-3)) << near->name;
  }
}

TEST(Optimise, GlassesDoNotDependOnThreadsAndNeedACatalogue) {
  const Lens lens = singlet("SCHOTT:N-BAK4");
  OptimiseRequest request = request_for(lens, {"radii", "image"});
  request.glasses = 3;
  Context one, two;
  one.threads = 1, two.threads = 2;
  const OptimiseResult first = optimise(lens, request, one), second = optimise(lens, request, two);
  EXPECT_EQ(first.after, second.after);
  EXPECT_EQ(first.lens.surfaces[0].material.description(), second.lens.surfaces[0].material.description());
  Lens constant = lens;
  constant.surfaces[0].material = Material(Material::Constant{1.6});
  EXPECT_THROW(optimise(constant, request), InputError);
}

TEST(Optimise, StopsWhenTold) {
  const Lens lens = with_curvatures(optimisable("dgauss-50mm"), 0.9);
  Context context;
  context.progress = [](double, const std::string&) { return false; };
  EXPECT_THROW(optimise(lens, {}, context), Cancelled);
}

std::string refusal_of(const char* variable) {
  try {
    parse_lens_variables(optimisable("cooke-triplet"), variable);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(LensVariables, AreWrittenAsInFiles) {
  const Lens lens = optimisable("cooke-triplet");
  EXPECT_EQ(parse_lens_variables(lens, "radii").size(), 6u);
  const LensVariable radius = parse_lens_variables(lens, "surfaces[0].radius_mm=20:30").front();
  EXPECT_EQ(name_of(radius.number), "surfaces[0].radius_mm");
  EXPECT_DOUBLE_EQ(radius.low, 1 / 30.0);
  EXPECT_DOUBLE_EQ(radius.high, 1 / 20.0);
  EXPECT_DOUBLE_EQ(shown_value(lens, radius.number), 1 / lens.surfaces[0].curvature_per_mm);
  EXPECT_EQ(parse_lens_variables(lens, "surfaces[1].asphere.6").front().number.power, 6);
}

TEST(LensVariables, SayWhatWouldBeRight) {
  EXPECT_NE(refusal_of("radi").find("radii, thicknesses"), std::string::npos);
  EXPECT_NE(refusal_of("surfaces[99].conic").find("0 to"), std::string::npos);
  EXPECT_NE(refusal_of("surfaces[0].asphere.1").find("2 to 30"), std::string::npos);
  EXPECT_NE(refusal_of("surfaces[0].radius_mm=-5:5").find("one sign"), std::string::npos);
  EXPECT_NE(refusal_of("surfaces[0].thickness_mm=5:4").find("LOW below HIGH"), std::string::npos);
  EXPECT_NE(refusal_of("surfaces[0].thickness_mm=100:200").find("outside"), std::string::npos);
  EXPECT_NE(refusal_of("gaps=5").find("radii, thicknesses"), std::string::npos);
}

}  // namespace
}  // namespace petzval
