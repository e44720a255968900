// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/transfer_polynomials.h>
#include <petzval/base/error.h>
#include <petzval/base/stop.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

using Matrix = Eigen::MatrixXd;

/// Of the tolerance: what a term must move a ray by to be kept.
constexpr double least_share = 0.05;

/// Terms of all samples: the even rows are x, the odd ones y; first the terms times place, then times
/// direction.
Matrix rows_of(const std::vector<TransferSample>& samples, const std::vector<TransferPowers>& terms,
               double unit_mm) {
  const auto count = static_cast<Eigen::Index>(terms.size());
  Matrix rows(2 * static_cast<Eigen::Index>(samples.size()), 2 * count);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const TransferRay& ray = samples[i].rear;
    const double of[3] = {(ray.x * ray.x + ray.y * ray.y) / (unit_mm * unit_mm),
                          (ray.x * ray.l + ray.y * ray.m) / unit_mm, ray.l * ray.l + ray.m * ray.m};
    const auto row = 2 * static_cast<Eigen::Index>(i);
    for (Eigen::Index t = 0; t < count; ++t) {
      double term = 1;
      for (std::size_t v = 0; v < 3; ++v)
        for (int p = 0; p < terms[static_cast<std::size_t>(t)][v]; ++p) term *= of[v];
      rows(row, t) = term * ray.x, rows(row, count + t) = term * ray.l;
      rows(row + 1, t) = term * ray.y, rows(row + 1, count + t) = term * ray.m;
    }
  }
  return rows;
}

/// Least squares with columns of one size. The rows are taken in a few at a time: what matters of those
/// before is the triangle of their QR factorisation (Golub & Van Loan 2013, 5.2 and 6.5).
Matrix solved(Matrix rows, const Matrix& wanted) {
  const Eigen::Index unknowns = rows.cols();
  if (unknowns == 0) return Matrix(0, wanted.cols());  // which Eigen's solver does not survive
  Eigen::VectorXd scale = rows.colwise().norm();
  for (Eigen::Index c = 0; c < unknowns; ++c) {
    if (scale(c) == 0) scale(c) = 1;
    rows.col(c) /= scale(c);
  }
  const Eigen::Index columns = unknowns + wanted.cols(), piece = 4 * columns;
  Matrix triangle = Matrix::Zero(columns, columns), stacked;
  for (Eigen::Index row = 0; row < rows.rows(); row += piece) {
    check_stop();
    const Eigen::Index more = std::min(piece, rows.rows() - row);
    stacked.resize(columns + more, columns);
    stacked << triangle, rows.middleRows(row, more), wanted.middleRows(row, more);
    const Eigen::HouseholderQR<Eigen::Ref<Matrix>> factored(stacked);
    triangle = stacked.topRows(columns).triangularView<Eigen::Upper>();
  }
  Matrix found = triangle.topLeftCorner(unknowns, unknowns)
                     .colPivHouseholderQr()
                     .solve(triangle.topRightCorner(unknowns, wanted.cols()));
  for (Eigen::Index c = 0; c < unknowns; ++c) found.row(c) /= scale(c);
  return found;
}

/// First order of rays alone: that of a fit, its determinant made 1.
Eigen::Matrix2d first_order_of(const Matrix& rows, const Matrix& wanted) {
  const Matrix found = solved(rows, wanted);
  Eigen::Matrix2d first;
  first << found(0, 0), found(rows.cols() / 2, 0), found(0, 1), found(rows.cols() / 2, 1);
  const double determinant = first.determinant();
  if (!(determinant > 0))
    throw InputError(
        "the rays do not tell the first order of a lens; more heights on the film and places in the pupil "
        "would "
        "be right");
  return first / std::sqrt(determinant);
}

/// The coefficients of one band: of each output, of each term. The first term is 1. \param known  the first
/// order; absent: as fitted, its determinant then made 1.
std::vector<std::vector<double>> fitted(const std::vector<TransferSample>& samples,
                                        const std::vector<TransferPowers>& terms, double unit_mm,
                                        const std::optional<Eigen::Matrix2d>& known) {
  const Matrix rows = rows_of(samples, terms, unit_mm);
  const auto count = static_cast<Eigen::Index>(terms.size());
  const auto apertures = static_cast<Eigen::Index>(samples.front().at_apertures.size());
  Matrix wanted(rows.rows(), 2), places(rows.rows(), apertures);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto row = 2 * static_cast<Eigen::Index>(i);
    wanted.row(row) << samples[i].front.x, samples[i].front.l;
    wanted.row(row + 1) << samples[i].front.y, samples[i].front.m;
    for (Eigen::Index a = 0; a < apertures; ++a)
      for (Eigen::Index axis = 0; axis < 2; ++axis)
        places(row + axis, a) =
            samples[i].at_apertures[static_cast<std::size_t>(a)][static_cast<std::size_t>(axis)];
  }
  const Eigen::Matrix2d first = known ? *known : first_order_of(rows, wanted);
  wanted -= rows.col(0) * first.col(0).transpose() + rows.col(count) * first.col(1).transpose();
  Matrix higher(rows.rows(), 2 * count - 2);
  higher << rows.middleCols(1, count - 1), rows.rightCols(count - 1);
  const Matrix found = solved(higher, wanted), at = solved(rows, places);
  std::vector<std::vector<double>> coefficients(static_cast<std::size_t>(4 + 2 * apertures),
                                                std::vector<double>(terms.size()));
  for (Eigen::Index t = 0; t < count; ++t) {
    const auto term = static_cast<std::size_t>(t);
    for (Eigen::Index o = 0; o < 4; ++o)
      coefficients[static_cast<std::size_t>(o)][term] =
          t == 0 ? first(o / 2, o % 2) : found(t - 1 + (o % 2) * (count - 1), o / 2);
    for (Eigen::Index a = 0; a < apertures; ++a) {
      coefficients[static_cast<std::size_t>(4 + 2 * a)][term] = at(t, a);
      coefficients[static_cast<std::size_t>(5 + 2 * a)][term] = at(count + t, a);
    }
  }
  return coefficients;
}

void add_errors(const std::vector<TransferSample>& samples, const std::vector<TransferPowers>& terms,
                double unit_mm, const std::vector<std::vector<double>>& coefficients,
                TransferErrors& errors) {
  const Matrix rows = rows_of(samples, terms, unit_mm);
  const auto count = static_cast<Eigen::Index>(terms.size());
  const auto carried = [&](std::size_t output) {
    Eigen::VectorXd of(2 * count);
    for (Eigen::Index t = 0; t < count; ++t)
      of(t) = coefficients[output][static_cast<std::size_t>(t)],
      of(count + t) = coefficients[output + 1][static_cast<std::size_t>(t)];
    return Eigen::VectorXd(rows * of);
  };
  const Eigen::VectorXd place = carried(0), direction = carried(2);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto row = 2 * static_cast<Eigen::Index>(i);
    const TransferRay& front = samples[i].front;
    errors.mm.push_back(std::hypot(place(row) - front.x, place(row + 1) - front.y));
    errors.rad.push_back(std::hypot(direction(row) - front.l, direction(row + 1) - front.m));
  }
}
}  // namespace

std::vector<TransferPowers> powers_up_to(int degree) {
  std::vector<TransferPowers> list;
  for (int sum = 0; sum <= degree; ++sum)
    for (int a = sum; a >= 0; --a)
      for (int b = sum - a; b >= 0; --b) list.push_back({a, b, sum - a - b});
  return list;
}

int most_degree_for(const TransferSamples& samples) {
  std::size_t rays = samples.fitted.front().size();
  for (const std::vector<TransferSample>& band : samples.fitted) rays = std::min(rays, band.size());
  int degree = 0;
  while (degree < highest_transfer_degree && 2 * powers_up_to(degree + 1).size() <= rays) ++degree;
  return degree;
}

TransferCoefficients fitted_bands(const TransferSamples& samples, const std::vector<TransferPowers>& terms) {
  TransferCoefficients all;
  for (std::size_t b = 0; b < samples.wavelengths_nm.size(); ++b)
    all.push_back(fitted(samples.fitted[b], terms, samples.unit_mm, samples.first[b]));
  return all;
}

bool TransferErrors::within(double most_mm, double most_rad) const {
  return *std::max_element(mm.begin(), mm.end()) <= most_mm &&
         *std::max_element(rad.begin(), rad.end()) <= most_rad;
}

TransferErrors errors_of(const TransferSamples& samples, const std::vector<TransferPowers>& terms,
                         const TransferCoefficients& bands) {
  TransferErrors errors;
  for (std::size_t b = 0; b < bands.size(); ++b)
    add_errors(samples.held[b], terms, samples.unit_mm, bands[b], errors);
  return errors;
}

std::vector<TransferPowers> needed_terms(const TransferSamples& samples,
                                         const std::vector<TransferPowers>& terms,
                                         const TransferCoefficients& bands, double mm, double rad) {
  std::vector<TransferPowers> kept{terms.front()};
  const auto count = static_cast<Eigen::Index>(terms.size());
  for (Eigen::Index t = 1; t < count; ++t) {
    double most = 0;
    for (std::size_t b = 0; b < bands.size(); ++b) {
      const std::vector<TransferPowers> one{terms[static_cast<std::size_t>(t)]};
      const Matrix rows = rows_of(samples.held[b], one, samples.unit_mm);
      const double place = rows.col(0).cwiseAbs().maxCoeff(), direction = rows.col(1).cwiseAbs().maxCoeff();
      const auto at = static_cast<std::size_t>(t);
      for (std::size_t o = 0; o < bands[b].size(); ++o) {
        // A place in an aperture matters as little as one in front.
        const double tolerance = o == 2 || o == 3 ? rad : mm;
        most = std::max(most, std::abs(bands[b][o][at]) * (o % 2 == 0 ? place : direction) / tolerance);
      }
    }
    if (most > least_share) kept.push_back(terms[static_cast<std::size_t>(t)]);
  }
  return kept;
}

}  // namespace petzval
