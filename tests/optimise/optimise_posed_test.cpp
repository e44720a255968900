// SPDX-License-Identifier: BSD-3-Clause
// Optimising lenses with poses: slopes, a decentred lens that comes back to its design, a folded lens that
// ends where the unfolded one does.
#include <gtest/gtest.h>
#include <petzval/analysis/spots.h>
#include <petzval/base/error.h>
#include <petzval/lens/lens_file.h>
#include <petzval/optimise/optimise.h>
#include <petzval/optimise/ray_merit.h>

#include <cmath>

namespace petzval {
namespace {

using Kind = LensNumber::Kind;

Lens bundled_triplet() {
  return read_lens("cooke-triplet").lens;
}

std::vector<LensVariable> variables_of(const Lens& lens, std::initializer_list<const char*> texts) {
  std::vector<LensVariable> variables;
  for (const char* text : texts)
    for (const LensVariable& variable : parse_lens_variables(lens, text)) variables.push_back(variable);
  return variables;
}

/// The middle element off its place, and the sensor tilted.
Lens decentred_triplet() {
  Lens lens = bundled_triplet();
  lens.groups = {{2, 3, {0.05, -0.08, 0, 0.15, 0.1, 0}, 0}};
  lens.sensor_pose.tilt_x_deg = 0.2, lens.sensor_pose.tilt_y_deg = -0.3;
  return lens;
}

/// A plane mirror 20 mm behind the last element, at 45°, and the sensor beside the lens.
Lens folded_triplet() {
  Lens lens = bundled_triplet();
  Surface mirror = Surface::sphere(INFINITY, -(lens.surfaces.back().thickness_mm - 20), {}, 40);
  mirror.mirror = true;
  mirror.pose.tilt_x_deg = -45;
  lens.surfaces.back().thickness_mm = 20;
  lens.surfaces.push_back(mirror);
  lens.groups = {{6, 7, {0, 0, 0, 90, 0, 0}, 0}};
  return lens;
}

TEST(OptimisePosed, SlopesAreDifferencesOfTheMerit) {
  const Lens lens = decentred_triplet();
  OptimiseRequest request;
  request.variables = variables_of(lens, {"radii", "gaps", "image", "poses", "surfaces[4].pose.tilt_x_deg"});
  request.at = FieldTableRequest::of(lens);
  request.at.azimuth_deg = 30;
  for (const OptimiseMerit kind : {OptimiseMerit::rms_spot, OptimiseMerit::wavefront, OptimiseMerit::mtf}) {
    request.merit = kind, request.mtf_frequency_cpmm = 20;
    const RayMerit merit(lens, request);
    Eigen::MatrixXd slopes;
    ASSERT_TRUE(merit.residuals(lens, &slopes));
    for (std::size_t i = 0; i < request.variables.size(); ++i) {
      const LensNumber& number = request.variables[i].number;
      const double now = value_of(lens, number), step = number.kind == Kind::curvature_per_mm ? 1e-6 : 1e-4;
      const auto at = [&](double value) {
        return *merit.residuals(with_value(lens, number, value), nullptr);
      };
      const Eigen::VectorXd difference = (at(now + step) - at(now - step)) / (2 * step);
      const auto column = slopes.col(static_cast<Eigen::Index>(i));
      // As of centred lenses: what central differences are off by.
      EXPECT_LT((column - difference).norm(), 1e-4 * difference.norm()) << name_of(number);
    }
  }
}

TEST(OptimisePosed, MeritIsTheSpotOfTheTable) {
  // At one azimuth, 5 × 16 rays against those of the table: a per cent, as of centred lenses.
  const Lens lens = decentred_triplet();
  OptimiseRequest request;
  request.at = FieldTableRequest::of(lens);
  request.at.wavelengths_nm = {550};
  request.azimuths_deg = {70};
  const RayMerit merit(lens, request);
  const std::vector<double> fields = merit.by_field(*merit.residuals(lens, nullptr));
  ASSERT_EQ(fields.size(), lens.fields.values.size());
  FieldTracer tracer(lens, 550, Tracer::Clip::apertures, 70);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const SpotRow row = *spot(tracer, *tracer.chief_ray(request.at.fields[i]), RayWeight::light);
    EXPECT_NEAR(fields[i] / row.rms_radius_um, 1, 0.01) << i;
  }
}

TEST(OptimisePosed, ALensWithoutSymmetryIsJudgedAtFourAzimuths) {
  // Of a lens whose poses are nothing all azimuths and both halves of its pupils are alike: the merit is that
  // of the centred lens, but for other nodes on its pupils, and those are exact to the ninth order.
  const Lens lens = bundled_triplet();
  OptimiseRequest centred, posed;
  posed.variables = {{{Kind::sensor_pose, 0, 3}}};
  EXPECT_EQ(azimuths_of(lens, centred), std::vector<double>{0});
  EXPECT_EQ(azimuths_of(lens, posed), (std::vector<double>{0, 90, 180, 270}));
  const RayMerit one(lens, centred), four(lens, posed);
  const std::vector<double> by_one = one.by_field(*one.residuals(lens, nullptr)),
                            by_four = four.by_field(*four.residuals(lens, nullptr));
  for (std::size_t i = 0; i < by_one.size(); ++i) EXPECT_NEAR(by_four[i] / by_one[i], 1, 1e-9) << i;
}

TEST(OptimisePosed, ADecentredLensComesBackToItsDesign) {
  const Lens lens = decentred_triplet();
  OptimiseRequest request;
  request.variables = variables_of(lens, {"poses"});
  ASSERT_EQ(request.variables.size(), 6U);
  const OptimiseResult result = optimise(lens, request);
  OptimiseRequest none = request;
  const RayMerit design(bundled_triplet(), none);
  const double designed = design.merit(*design.residuals(bundled_triplet(), nullptr));
  EXPECT_GT(result.before, 1.1 * designed) << "nothing was spoiled";
  // The centred lens is one point of the search: what is found is at least as good, and near to it: a
  // hundredth of what was spoiled.
  EXPECT_LT(result.after, 1.0001 * designed);
  for (const OptimisedNumber& number : result.numbers)
    EXPECT_LT(std::abs(number.after), 0.01 * std::abs(number.before)) << name_of(number.number);
}

TEST(OptimisePosed, AFoldedLensEndsWhereTheUnfoldedOneDoes) {
  const Lens straight = bundled_triplet(), folded = folded_triplet();
  folded.validate();
  OptimiseRequest request;
  request.azimuths_deg = {0};
  request.at = FieldTableRequest::of(straight);
  request.variables = variables_of(straight, {"radii", "gaps", "image"});
  const OptimiseResult one = optimise(straight, request);
  // Its last gap ends at the mirror: it is kept, as the way from there to the sensor varies already.
  request.variables = variables_of(folded, {"radii", "gaps", "image"});
  std::erase_if(request.variables, [](const LensVariable& variable) {
    return variable.number == LensNumber{Kind::thickness_mm, 5};
  });
  const OptimiseResult other = optimise(folded, request);
  // Pupils of lenses with poses are sampled over both halves: nodes differ, and the optimum by 1e-4.
  EXPECT_NEAR(other.after / one.after, 1, 1e-3);
  EXPECT_LT(other.after, 0.97 * other.before);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(other.lens.surfaces[i].curvature_per_mm / one.lens.surfaces[i].curvature_per_mm, 1, 0.02)
        << i;
  EXPECT_LT(other.lens.surfaces[6].thickness_mm, 0) << "light runs back to the sensor";
}

TEST(OptimisePosed, NamesOfNumbersAreThoseOfTheFile) {
  const Lens lens = decentred_triplet();
  for (const char* text :
       {"surfaces[4].pose.shift_z_mm", "groups[0].pose.tilt_x_deg", "sensor_pose.tilt_z_deg"}) {
    const std::vector<LensVariable> one = parse_lens_variables(lens, text);
    ASSERT_EQ(one.size(), 1U);
    EXPECT_EQ(name_of(one.front().number), text);
  }
  EXPECT_EQ(shown_value(lens, parse_lens_variables(lens, "groups[0].pose.tilt_x_deg").front().number), 0.15);
  for (const char* text : {"surfaces[4].pose.tilt_deg", "groups[1].pose.tilt_x_deg", "groups[0].tilt_x_deg",
                           "sensor_pose", "poses=0:1", "groups[0].pose.tilt_x_deg=1:2"})
    EXPECT_THROW(parse_lens_variables(lens, text), InputError) << text;
  EXPECT_THROW(parse_lens_variables(bundled_triplet(), "poses"), InputError);
}

}  // namespace
}  // namespace petzval
