// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/stop.h>
#include <petzval/base/units.h>
#include <petzval/base/wavelength.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/optimise/build_objective.h>
#include <petzval/sensor/sensor.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace petzval {

namespace {

/// Contrast of one edge that ruler and model do not share: edges of exact pictures measure to this
/// (docs/SFR.md).
constexpr double unshared_contrast = 0.003;
/// Errors of all edges together, standard deviations. Light that is spread farther than an edge is looked at
/// takes a share of all contrast; blur that the model does not hold takes 2 pi² times its variance times the
/// square of the frequency, here that of 6 % of a square pixel's variance [cycles/pixel]^-2.
constexpr double far_light = 0.01, unknown_blur = 0.1;
/// Steps of differences, in BuildNumber::scale(): the wave follows them as a straight line.
constexpr double difference_step = 0.02;
constexpr std::size_t most_edges_fitted = 2000, most_photographs = 50;

EdgeLight light_of(const Lens& lens, const FitBuildRequest& request) {
  EdgeLight light{request.wavelengths_nm, request.weights};
  if (light.wavelengths_nm.empty()) light.wavelengths_nm = lens.wavelengths_nm;
  for (const double nm : light.wavelengths_nm)
    require_wavelength(nm, fmt::format("a wavelength of {:g}", nm));
  if (light.shares.empty()) light.shares.assign(light.wavelengths_nm.size(), 1);
  if (light.shares.size() != light.wavelengths_nm.size())
    throw InputError(fmt::format("`weights`: {} for {} wavelengths; one a wavelength would be right",
                                 light.shares.size(), light.wavelengths_nm.size()));
  const double sum = std::accumulate(light.shares.begin(), light.shares.end(), 0.0);
  for (double& share : light.shares) {
    if (!(share >= 0) || !(sum > 0) || !std::isfinite(sum))
      throw InputError("`weights`: numbers of 0 or more, not all of them 0, would be right");
    share /= sum;
  }
  return light;
}

/// Which edges count: those of the channel asked for; luminance, or green of several colours.
std::string channel_of(const std::vector<SfrMap>& photographs, const std::string& asked) {
  if (!asked.empty() && asked != "luminance") return asked;
  for (const SfrMap& map : photographs)
    for (const MapEdge& edge : map.edges)
      if (edge.channel.empty()) return "";
  return "green";
}

Eigen::MatrixXd whitening_of(const MapEdge& edge) {
  const auto n = static_cast<Eigen::Index>(edge.contrast.size());
  const Eigen::Map<const Eigen::VectorXd> deviation(edge.deviation.data(), n);
  Eigen::MatrixXd covariance = deviation.cwiseAbs2().asDiagonal();
  if (!edge.correlation.empty()) {
    const Eigen::Map<const Eigen::MatrixXd> correlation(edge.correlation.data(), n, n);
    covariance = deviation.asDiagonal() * correlation * deviation.asDiagonal();
  }
  covariance.diagonal().array() += unshared_contrast * unshared_contrast;
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  return factor.matrixL().solve(Eigen::MatrixXd::Identity(n, n));
}

void check_request(const Lens& lens, const std::vector<SfrMap>& photographs, const FitBuildRequest& request) {
  lens.validate();
  if (!(request.pixel_pitch_um > 0) || !std::isfinite(request.pixel_pitch_um))
    throw InputError("the pixel pitch is not known; `sensor` or a pitch in um would be right");
  request.photosite.validate();
  if (photographs.empty() || photographs.size() > most_photographs)
    throw InputError(
        fmt::format("{} photographs; 1 to {} would be right", photographs.size(), most_photographs));
  if (!request.focus_shifts_mm.empty() && request.focus_shifts_mm.size() != photographs.size())
    throw InputError(fmt::format("`focus_shifts_mm`: {} for {} photographs; one a photograph would be right",
                                 request.focus_shifts_mm.size(), photographs.size()));
  for (const double shift : request.focus_shifts_mm)
    if (!std::isfinite(shift)) throw InputError("`focus_shifts_mm`: a finite length in mm would be right");
}

}  // namespace

BuildObjective::BuildObjective(const Lens& lens, const std::vector<SfrMap>& photographs,
                               const FitBuildRequest& request)
    : lens_(lens),
      focus_shifts_mm_(request.focus_shifts_mm),
      pitch_mm_(request.pixel_pitch_um * mm_per_um),
      photosite_(request.photosite) {
  check_request(lens, photographs, request);
  light_ = light_of(lens, request);
  take_numbers(request.free, photographs.size());
  take_edges(photographs, request);
  find_objects();
}

void BuildObjective::take_numbers(const std::vector<std::string>& free, std::size_t photographs) {
  const std::vector<std::string> usual{"defocus_mm", "sensor_tilt_deg"};
  for (const std::string& text : free.empty() ? usual : free)
    for (BuildNumber& number : parse_build_numbers(lens_, text)) {
      for (const BuildNumber& other : numbers_)
        if (other.name() == number.name())
          throw InputError(fmt::format("{} is free twice; once would be right", number.name()));
      if (number.deviation) ++priors_;
      numbers_.push_back(std::move(number));
    }
  if (photographs == 1 || !focus_shifts_mm_.empty()) return;
  // Nobody knows how far the photographs are from each other: each has a defocus of its own.
  std::vector<BuildNumber> numbers;
  for (const BuildNumber& number : numbers_)
    for (std::size_t map = 0; map < (number.kind == BuildNumber::Kind::defocus_mm ? photographs : 1); ++map) {
      numbers.push_back(number);
      if (number.kind == BuildNumber::Kind::defocus_mm) numbers.back().map = static_cast<int>(map);
    }
  numbers_ = std::move(numbers);
  priors_ =
      std::ranges::count_if(numbers_, [](const BuildNumber& each) { return each.deviation.has_value(); });
}

void BuildObjective::take_edges(const std::vector<SfrMap>& photographs, const FitBuildRequest& request) {
  const std::string channel = channel_of(photographs, request.channel);
  const double per_mm = 1 / pitch_mm_;
  for (std::size_t map = 0; map < photographs.size(); ++map) {
    const SensorGeometry frame{photographs[map].columns, photographs[map].rows, request.pixel_pitch_um};
    for (const MapEdge& edge : photographs[map].edges) {
      if (edge.channel != channel) continue;
      EdgeData data;
      data.photograph = static_cast<int>(map);
      data.edge = &edge;
      // Pictures are upright, the image on the sensor is not.
      const double c = std::cos(edge.normal_rad), s = std::sin(edge.normal_rad);
      data.at = {frame.x_mm(edge.x_px), frame.y_mm(edge.y_px), -c, s, edge.half_length_px * pitch_mm_};
      const auto n = static_cast<Eigen::Index>(edge.contrast.size());
      data.contrast = Eigen::Map<const Eigen::VectorXd>(edge.contrast.data(), n);
      data.photosite.resize(n);
      for (Eigen::Index k = 0; k < n; ++k) {
        const double f = edge.frequencies_cpp[static_cast<std::size_t>(k)];
        data.frequencies_cpmm.push_back(f * per_mm);
        data.photosite[k] = std::abs(photosite_.transform(f * c, f * s));
      }
      data.whitening = whitening_of(edge);
      first_row_.push_back(data_);
      data_ += n;
      edges_.push_back(std::move(data));
    }
  }
  if (edges_.empty())
    throw InputError(fmt::format("there is no edge of channel {}; one that was measured would be right",
                                 channel.empty() ? "luminance" : channel));
  if (edges_.size() > most_edges_fitted)
    throw InputError(fmt::format("{} edges; {} at most would be right", edges_.size(), most_edges_fitted));
  if (data_ + priors_ <= unknowns())
    throw InputError(
        fmt::format("{} numbers are free and the edges give {}; more edges or fewer numbers would "
                    "be right",
                    unknowns(), data_));
}

/// Differences of variance 1 and covariance B Bᵀ beside it, of columns B, become ones of variance 1 by
/// (I + B Bᵀ)^(-1/2), which shortens the directions of B alone.
void BuildObjective::count_shared_errors() {
  Eigen::MatrixXd errors(data_, 2);
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const EdgeData& edge = edges_[i];
    const auto n = edge.contrast.size();
    const Eigen::Map<const Eigen::ArrayXd> f(edge.edge->frequencies_cpp.data(), n);
    errors.middleRows(first_row_[i], n).col(0) = edge.whitening * (far_light * edge.contrast);
    errors.middleRows(first_row_[i], n).col(1) =
        edge.whitening * (unknown_blur * f.square() * edge.contrast.array()).matrix();
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> solved(errors, Eigen::ComputeThinU);
  shared_directions_ = solved.matrixU();
  shortened_by_ = 1 - (1 + solved.singularValues().array().square()).rsqrt();
}

void BuildObjective::look(const EdgeDetail& detail) {
  const bool other = detail.places != detail_.places;
  detail_ = detail;
  if (other) find_objects();
}

double BuildObjective::shift_mm(int photograph) const {
  return focus_shifts_mm_.empty() ? 0 : focus_shifts_mm_[static_cast<std::size_t>(photograph)];
}

void BuildObjective::find_objects() {
  objects_.assign(edges_.size(), {});
  const double nm = light_.wavelengths_nm[light_.wavelengths_nm.size() / 2];
  std::vector<char> found(edges_.size(), 0);
  parallel_tasks(edges_.size(), [&](std::size_t i) {
    FieldTracer tracer(lens_at(Eigen::VectorXd::Zero(unknowns()), edges_[i].photograph), nm);
    if (auto objects = objects_of(tracer, edges_[i].at, detail_)) objects_[i] = *objects, found[i] = 1;
  });
  const auto lost = std::ranges::find(found, 0);
  if (lost == found.end()) return;
  const EdgeData& edge = edges_[static_cast<std::size_t>(lost - found.begin())];
  throw InputError(
      fmt::format("{}: no chief ray lands on the edge at {:.0f}, {:.0f} pixels, {:.3g} mm from the "
                  "axis; a smaller pitch would be right",
                  lens_.name, edge.edge->x_px, edge.edge->y_px, std::hypot(edge.at.x_mm, edge.at.y_mm)));
}

Lens BuildObjective::lens_at(const Eigen::VectorXd& steps, int photograph) const {
  Lens lens = lens_;
  const double shift = shift_mm(photograph);
  if (shift != 0) lens.set_image_distance_mm(lens.image_distance_mm() + shift);
  for (std::size_t k = 0; k < numbers_.size(); ++k)
    if (numbers_[k].map.value_or(photograph) == photograph)
      lens = with_number(std::move(lens), numbers_[k],
                         steps[static_cast<Eigen::Index>(k)] * numbers_[k].scale());
  return lens;
}

void BuildObjective::evaluate(const Eigen::VectorXd& steps, Eigen::VectorXd& residuals,
                              Eigen::MatrixXd* slopes) const {
  int photographs = 0;
  for (const EdgeData& edge : edges_) photographs = std::max(photographs, edge.photograph + 1);
  std::vector<Lens> lenses;
  std::vector<std::vector<Lens>> altered(static_cast<std::size_t>(photographs));
  for (int map = 0; map < photographs; ++map) {
    lenses.push_back(lens_at(steps, map));
    for (Eigen::Index k = 0; slopes && k < unknowns(); ++k) {
      Eigen::VectorXd beside = steps;
      beside[k] += difference_step;
      altered[static_cast<std::size_t>(map)].push_back(lens_at(beside, map));
    }
  }
  residuals.setZero(rows());
  if (slopes) slopes->setZero(rows(), unknowns());
  const double nm = light_.wavelengths_nm[light_.wavelengths_nm.size() / 2];
  parallel_tasks(edges_.size(), [&](std::size_t i) {
    check_stop();
    const EdgeData& edge = edges_[i];
    const auto map = static_cast<std::size_t>(edge.photograph);
    const auto n = edge.contrast.size();
    std::optional<EdgeTransfer> transfer;
    try {
      FieldTracer tracer(lenses[map], nm);
      if (const auto objects = objects_of(tracer, edge.at, detail_, objects_[i]))
        transfer = edge_transfer(lenses[map], altered[map], edge.at, *objects, light_, edge.frequencies_cpmm,
                                 detail_);
    } catch (const InputError&) {
      // a lens that cannot be: as one through which no light gets
    }
    const Eigen::VectorXd modulus =
        transfer ? Eigen::VectorXd(transfer->modulus.cwiseProduct(edge.photosite)) : Eigen::VectorXd::Zero(n);
    residuals.segment(first_row_[i], n) = edge.whitening * (modulus - edge.contrast);
    if (slopes && transfer)
      slopes->middleRows(first_row_[i], n) =
          edge.whitening * edge.photosite.asDiagonal() * transfer->slopes / difference_step;
  });
  const auto shorten = [&](auto&& differences) {
    if (shortened_by_.size() == 0) return;
    differences -= shared_directions_ *
                   (shortened_by_.asDiagonal() * (shared_directions_.transpose() * differences)).eval();
  };
  shorten(residuals.head(data_));
  if (slopes) shorten(slopes->topRows(data_));
  Eigen::Index row = data_;
  for (Eigen::Index k = 0; k < unknowns(); ++k) {
    const BuildNumber& number = numbers_[static_cast<std::size_t>(k)];
    if (!number.deviation) continue;
    const double per_deviation = number.scale() / *number.deviation;
    residuals[row] = steps[k] * per_deviation;
    if (slopes) (*slopes)(row, k) = per_deviation;
    ++row;
  }
}

std::vector<double> BuildObjective::mtf50(const Eigen::VectorXd& steps) const {
  std::vector<double> result(edges_.size(), NAN);
  constexpr int frequencies = 50;
  const double nm = light_.wavelengths_nm[light_.wavelengths_nm.size() / 2];
  parallel_tasks(edges_.size(), [&](std::size_t i) {
    check_stop();
    const EdgeData& edge = edges_[i];
    const Lens lens = lens_at(steps, edge.photograph);
    FieldTracer tracer(lens, nm);
    const auto objects = objects_of(tracer, edge.at, detail_, objects_[i]);
    if (!objects) return;
    const double c = std::cos(edge.edge->normal_rad), s = std::sin(edge.edge->normal_rad);
    // From near zero upwards in equal ratios, and between them as straight lines of the logarithm.
    double before_f = 0, before = 1;
    std::vector<double> cpp, cpmm;
    for (int k = 0; k < frequencies; ++k) {
      cpp.push_back(0.005 * std::pow(200.0, k / (frequencies - 1.0)));
      cpmm.push_back(cpp.back() / pitch_mm_);
    }
    const auto transfer = edge_transfer(lens, {}, edge.at, *objects, light_, cpmm, detail_);
    if (!transfer) return;
    for (int k = 0; k < frequencies; ++k) {
      const double f = cpp[static_cast<std::size_t>(k)];
      const double now = transfer->modulus[k] * std::abs(photosite_.transform(f * c, f * s));
      if (now < 0.5) {
        result[i] = before_f + (before - 0.5) / (before - now) * (f - before_f);
        return;
      }
      before_f = f, before = now;
    }
  });
  return result;
}

}  // namespace petzval
