// SPDX-License-Identifier: BSD-3-Clause
// Contrast across an edge of any direction: against the MTF of the analyses along the field and across it,
// against the transform of the PSF in between, and its derivatives against differences.
#include <gtest/gtest.h>
#include <petzval/analysis/mtf.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>
#include <petzval/optimise/build_number.h>
#include <petzval/optimise/edge_transfer.h>
#include <petzval/wave/sampled_otf.h>

#include <cmath>

namespace petzval {
namespace {

constexpr double nm = 550;

Lens posed_triplet() {
  Lens lens = read_lens("cooke-triplet").lens;
  for (const auto& [text, value] : {std::pair{"sensor_tilt_deg", 0.15}, {"element_decentre_mm@2-3", 0.06}})
    for (const BuildNumber& number : parse_build_numbers(lens, text))
      lens = with_number(std::move(lens), number, number.axis == 'x' ? value : -0.7 * value);
  return lens;
}

/// The edge whose objects stand at a field and azimuth, its normal turned by `normal_deg` from the tangential
/// direction towards the sagittal one.
struct FieldEdge {
  SensorEdge edge;
  EdgeObjects objects;
};

FieldEdge edge_at(const Lens& lens, double field, double azimuth_deg, double normal_deg) {
  const double turn = -radians(azimuth_deg), c = std::cos(turn), s = std::sin(turn);
  FieldTracer tracer(lens, nm);
  const std::array<double, 2> object{field * s, field * c};
  const auto at = tracer.landing_mm(object[0], object[1]);
  // In the field's own axes: across = sin, along = cos.
  const double across = std::sin(radians(normal_deg)), along = std::cos(radians(normal_deg));
  return {{(*at)[0], (*at)[1], across * c + along * s, along * c - across * s, 0}, {object}};
}

EdgeDetail one_place() {
  EdgeDetail detail;
  detail.places = 1;
  return detail;
}

MtfRow mtf_of(const Lens& lens, double field, double azimuth_deg, double frequency_cpmm) {
  FieldTableRequest at = FieldTableRequest::of(lens);
  at.fields = {field}, at.field_kind = Fields::Kind::angle_deg;
  at.wavelengths_nm = {nm}, at.azimuth_deg = azimuth_deg;
  MtfOptions options;
  options.frequencies_cpmm = {frequency_cpmm};
  options.model = {PupilModel::Amplitude::light, PupilModel::Phase::plane_waves};
  return mtf_table(lens, at, options).front();
}

TEST(EdgeTransfer, IsTheMtfAlongTheFieldAndAcrossIt) {
  for (const Lens& lens : {read_lens("cooke-triplet").lens, posed_triplet(), read_lens("dgauss-50mm").lens})
    for (const double azimuth : {0.0, 130.0})
      for (const double field : {0.0, 7.0, 12.0}) {
        const std::array<double, 2> frequencies{15, 40};
        const EdgeLight light{{nm}, {1}};
        for (const double normal : {0.0, 90.0}) {
          const FieldEdge at = edge_at(lens, field, azimuth, normal);
          const auto transfer = edge_transfer(lens, {}, at.edge, at.objects, light, frequencies, one_place());
          ASSERT_TRUE(transfer);
          for (std::size_t k = 0; k < 2; ++k) {
            const MtfRow row = mtf_of(lens, field, azimuth, frequencies[k]);
            EXPECT_NEAR(transfer->modulus[static_cast<Eigen::Index>(k)],
                        normal == 0 ? row.tangential : row.sagittal, 2e-3)
                << lens.name << ", field " << field << " at " << azimuth << ", " << frequencies[k] << "/mm";
          }
        }
      }
}

TEST(EdgeTransfer, IsTheTransformOfThePsfInAnyDirection) {
  const Lens lens = posed_triplet();
  constexpr double field = 11, azimuth = 70, frequency = 30;
  FieldTracer tracer(lens, nm, Tracer::Clip::apertures, azimuth);
  PsfOptions options;
  options.wanted_share = 0.998;
  options.largest_size = 1024;
  const SampledOtf otf(*point_spread(tracer, *tracer.chief_ray(field), options));
  for (const double normal : {25.0, 60.0, -40.0, 155.0}) {
    const FieldEdge at = edge_at(lens, field, azimuth, normal);
    const auto transfer =
        edge_transfer(lens, {}, at.edge, at.objects, {{nm}, {1}}, std::array{frequency}, one_place());
    ASSERT_TRUE(transfer);
    // Its x runs against s (SampledOtf).
    const double across = frequency * std::sin(radians(normal)),
                 along = frequency * std::cos(radians(normal));
    EXPECT_NEAR(transfer->modulus[0], std::abs(otf.at(-across, along)), 3e-3) << normal;
  }
}

TEST(EdgeTransfer, ObjectsLandOnTheEdge) {
  const Lens lens = posed_triplet();
  FieldTracer tracer(lens, nm);
  const SensorEdge edge{6.5, -9, 0.6, 0.8, 0.4};
  const auto objects = objects_of(tracer, edge, EdgeDetail{});
  ASSERT_TRUE(objects);
  ASSERT_EQ(objects->size(), 3u);
  const double way = std::sqrt(0.6) * 0.4;
  for (const int i : {-1, 0, 1}) {
    const auto at = tracer.landing_mm((*objects)[static_cast<std::size_t>(i + 1)][0],
                                      (*objects)[static_cast<std::size_t>(i + 1)][1]);
    ASSERT_TRUE(at);
    EXPECT_NEAR((*at)[0], edge.x_mm - i * way * edge.normal_y, 3e-4);
    EXPECT_NEAR((*at)[1], edge.y_mm + i * way * edge.normal_x, 3e-4);
  }
  EXPECT_FALSE(objects_of(tracer, {400, 0, 1, 0, 0}, EdgeDetail{}));
}

TEST(EdgeTransfer, SlopesAreDifferences) {
  const Lens lens = posed_triplet();
  const FieldEdge at = edge_at(lens, 9, 200, 35);
  const std::array<double, 2> frequencies{12, 30};
  const EdgeLight light{{480, 550, 640}, {0.2, 0.5, 0.3}};
  std::vector<BuildNumber> numbers;
  for (const char* text : {"defocus_mm", "sensor_tilt_deg", "element_decentre_mm@2-3", "element_tilt_deg@4-5",
                           "thickness_mm@1", "sag4_um@0"})
    for (const BuildNumber& number : parse_build_numbers(lens, text)) numbers.push_back(number);
  for (const BuildNumber& number : numbers) {
    const double step = 0.05 * number.scale();
    const std::vector<Lens> altered{with_number(lens, number, step)};
    const auto here = edge_transfer(lens, altered, at.edge, at.objects, light, frequencies, one_place());
    const auto above = edge_transfer(altered[0], {}, at.edge, at.objects, light, frequencies, one_place());
    const auto below = edge_transfer(with_number(lens, number, -step), {}, at.edge, at.objects, light,
                                     frequencies, one_place());
    ASSERT_TRUE(here && above && below);
    for (Eigen::Index k = 0; k < 2; ++k) {
      const double difference = 0.5 * (above->modulus[k] - below->modulus[k]);
      // The pupil's own move with the number is left out of slopes.
      EXPECT_NEAR(here->slopes(k, 0), difference, 0.05 * std::abs(difference) + 2e-5)
          << number.name() << " at " << frequencies[static_cast<std::size_t>(k)];
    }
  }
}

}  // namespace
}  // namespace petzval
