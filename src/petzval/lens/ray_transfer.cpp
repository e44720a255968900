// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/lens/lens.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/lens/transfer-inl.h>
#include <petzval/lens/transfer_faults.h>
#include <petzval/lens/transfer_terms.h>
#include <petzval/numeric/quadrature.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

namespace petzval {

namespace {

using Scalar = HWY_NAMESPACE::PlaneRay<double>;
using Steps = std::vector<TransferPolynomials<double>::Step>;
using Powers = TransferPowers;

/// Terms of the start of the inverse: products of up to so many invariants.
constexpr int start_degree = 4;

/// Polynomials with no coefficients yet.
TransferPolynomials<double> made_of(TransferVariables variables, double unit_mm, std::size_t outputs,
                                    const std::vector<Powers>& all) {
  TransferPolynomials<double> p;
  p.variables = variables;
  p.per_unit = 1 / unit_mm;
  p.outputs = outputs;
  for (const Powers& powers : all) {
    TransferPolynomials<double>::Step step;
    step.degree = static_cast<std::uint8_t>(output_degree(variables, powers));
    for (std::uint8_t v = 0; v < 3; ++v) {
      if (powers[v] == 0) continue;
      Powers from = powers;
      --from[v];
      step.variable = v;
      step.from = static_cast<std::uint16_t>(std::find(all.begin(), all.end(), from) - all.begin());
      break;
    }
    p.steps.push_back(step);
  }
  p.coefficients.assign(p.steps.size() * outputs, 0.0);
  return p;
}

std::vector<Powers> all_powers(int degree) {
  std::vector<Powers> list;
  for (int sum = 0; sum <= degree; ++sum)
    for (int a = sum; a >= 0; --a)
      for (int b = sum - a; b >= 0; --b) list.push_back({a, b, sum - a - b});
  return list;
}

Scalar scalar(const TransferRay& ray) {
  return {ray.x, ray.y, ray.l, ray.m};
}

/// About the inverse of `data.back` over its domain, by least squares.
void fit_start(TransferData<double>& data, double largest_radius_mm) {
  const std::vector<TransferRay> rays = domain_rays(data, largest_radius_mm, check_radii, check_across);
  double unit = 0;
  std::vector<TransferRay> front;
  for (const TransferRay& ray : rays) {
    front.push_back(carried_back(data, ray).front);
    unit = std::max(unit, std::hypot(front.back().x, front.back().y));
  }
  const std::vector<Powers> all = closed(all_powers(start_degree));
  data.start = made_of(TransferVariables::invariants, unit > 0 ? unit : 1, 4, all);
  const auto count = static_cast<Eigen::Index>(all.size());
  Eigen::MatrixXd rows(2 * static_cast<Eigen::Index>(rays.size()), 2 * count), wanted(rows.rows(), 2);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto at = HWY_NAMESPACE::arguments_of(data.start, scalar(front[i]));
    const auto row = 2 * static_cast<Eigen::Index>(i);
    std::vector<double> term(all.size(), 1);
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (k > 0) term[k] = term[data.start.steps[k].from] * at.of[data.start.steps[k].variable];
      const auto column = static_cast<Eigen::Index>(k);
      rows(row, column) = front[i].x * term[k], rows(row, count + column) = front[i].l * term[k];
      rows(row + 1, column) = front[i].y * term[k], rows(row + 1, count + column) = front[i].m * term[k];
    }
    wanted(row, 0) = rays[i].x, wanted(row, 1) = rays[i].l;
    wanted(row + 1, 0) = rays[i].y, wanted(row + 1, 1) = rays[i].m;
  }
  const Eigen::MatrixXd found = rows.colPivHouseholderQr().solve(wanted);
  for (std::size_t k = 0; k < all.size(); ++k)
    for (std::size_t o = 0; o < 4; ++o)
      data.start.coefficients[4 * k + o] =
          found(static_cast<Eigen::Index>(k) + static_cast<Eigen::Index>(o % 2) * count,
                static_cast<Eigen::Index>(o / 2));
}

/// The integral ∫ f·dg/dt by Gauss-Legendre nodes, dg/dt that of the polynomial through g.
void set_path_weights(TransferData<double>& data) {
  constexpr std::size_t count = transfer_path_nodes;
  const QuadratureRule rule = gauss_legendre(static_cast<int>(count), 0, 1);
  data.path_at = rule.nodes;
  data.path_weights.assign(count * count, 0);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < count; ++k) {
      // The derivative at node i of the polynomial that is 1 at node k and 0 at the others.
      double slope = 0;
      for (std::size_t m = 0; m < count; ++m) {
        if (m == k) continue;
        double product = 1 / (rule.nodes[k] - rule.nodes[m]);
        for (std::size_t n = 0; n < count; ++n)
          if (n != k && n != m) product *= (rule.nodes[i] - rule.nodes[n]) / (rule.nodes[k] - rule.nodes[n]);
        slope += product;
      }
      data.path_weights[i * count + k] = rule.weights[i] * slope;
    }
}

/// About where in front the light of a direction has its middle.
void fit_centre(TransferData<double>& data, double largest_radius_mm) {
  constexpr int terms = 4;
  const std::vector<TransferRay> rays = domain_rays(data, largest_radius_mm, check_radii, check_across);
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(rays.size()), terms);
  Eigen::VectorXd wanted(rows.rows());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const TransferRay front = carried_back(data, rays[i]).front;
    const double square = front.l * front.l + front.m * front.m;
    const auto row = static_cast<Eigen::Index>(i);
    for (int k = 0; k < terms; ++k) rows(row, k) = front.m * std::pow(square, k);
    wanted(row) = front.y;
  }
  const Eigen::VectorXd found = rows.colPivHouseholderQr().solve(wanted);
  data.centre.assign(found.data(), found.data() + terms);
}

/// What turned polynomials leave undecided on the axis, where they should turn with the ray.
void find_jump(TransferData<double>& data) {
  if (data.back.variables == TransferVariables::invariants) return;
  double reach = 0;
  for (const TransferRay& ray : domain_rays(data, 0, 1, check_across))
    reach = std::max(reach, std::hypot(ray.l, ray.m));
  constexpr int turns = 16;
  for (int i = 0; i < turns; ++i) {
    const double angle = 2 * 3.14159265358979323846 * i / turns;
    const TransferRay along = carried_back(data, {0, 0, 0, reach}).front;
    const TransferRay ray =
        carried_back(data, {0, 0, reach * std::sin(angle), reach * std::cos(angle)}).front;
    const double s = std::sin(angle), c = std::cos(angle);
    const auto miss = [&](double x, double y, double of_x, double of_y) {
      return std::hypot(x - (of_x * c + of_y * s), y - (-of_x * s + of_y * c));
    };
    data.jump_mm = std::max(data.jump_mm, miss(ray.x, ray.y, along.x, along.y));
    data.jump = std::max(data.jump, miss(ray.l, ray.m, along.l, along.m));
  }
}

/// Weights of the bands at a wavelength.
std::vector<double> weights_at(const std::vector<RayTransfer::Band>& bands, double nm) {
  std::vector<double> weights(bands.size(), 1);
  if (bands.size() == 1) return weights;
  constexpr double rounding_nm = 1e-6;
  if (nm < bands.front().wavelength_nm - rounding_nm || nm > bands.back().wavelength_nm + rounding_nm)
    throw InputError(
        fmt::format("the ray transfer of the lens is known from {:g} to {:g} nm, and {:g} nm is outside",
                    bands.front().wavelength_nm, bands.back().wavelength_nm, nm));
  const bool linear = bands.size() == 2;
  const auto at = [&](double each) { return linear ? each : 1e6 / (each * each); };
  for (std::size_t i = 0; i < bands.size(); ++i)
    for (std::size_t k = 0; k < bands.size(); ++k)
      if (k != i)
        weights[i] *=
            (at(nm) - at(bands[k].wavelength_nm)) / (at(bands[i].wavelength_nm) - at(bands[k].wavelength_nm));
  return weights;
}

TransferEllipses<double> ellipses_at(const RayTransfer& transfer, double nm) {
  TransferEllipses<double> result;
  const auto& bands = transfer.bands;
  if (!bands.front().ellipses) return result;
  // Of the nearest band: what limits light is made of no glass.
  const auto nearest = std::min_element(bands.begin(), bands.end(), [&](const auto& a, const auto& b) {
    return std::abs(a.wavelength_nm - nm) < std::abs(b.wavelength_nm - nm);
  });
  const RayTransfer::Ellipses& from = *nearest->ellipses;
  result.plane_mm = from.plane_mm;
  const auto knots = static_cast<double>(from.positions_mm.size() - 1);
  result.per_step = knots / from.positions_mm.back();
  result.radius_x = from.radius_x_mm;
  result.radius_y = from.radius_y_mm;
  result.centre_y = from.centre_y_mm;
  return result;
}

/// As at(), without what is made from it.
TransferData<double> data_at(const RayTransfer& transfer, double nm) {
  const std::vector<double> weights = weights_at(transfer.bands, nm);
  TransferData<double> data;
  data.length_mm = transfer.length_mm;
  const std::vector<Powers> all = closed(transfer.terms);
  const std::size_t outputs = outputs_of(transfer);
  const std::size_t room = outputs == 4 ? 4 : outputs <= 8 ? 8 : 4 + 2 * most_transfer_apertures;
  data.back = made_of(transfer.variables, transfer.unit_mm, room, all);
  for (std::size_t t = 0; t < transfer.terms.size(); ++t) {
    const auto k =
        static_cast<std::size_t>(std::find(all.begin(), all.end(), transfer.terms[t]) - all.begin());
    for (std::size_t o = 0; o < outputs; ++o)
      for (std::size_t b = 0; b < weights.size(); ++b)
        data.back.coefficients[k * room + o] += weights[b] * transfer.bands[b].coefficients[o][t];
  }
  data.ellipses = ellipses_at(transfer, nm);
  data.stop_radius = transfer.aperture_radii_mm.front();
  for (std::size_t i = 1; i < transfer.aperture_radii_mm.size(); ++i)
    data.other_radii_sq.push_back(transfer.aperture_radii_mm[i] * transfer.aperture_radii_mm[i]);
  // Apertures that there is room for and that are not there let all light through, at their middle.
  while (room > 4 && data.other_radii_sq.size() + 1 < (room - 4) / 2) data.other_radii_sq.push_back(1);
  return data;
}

}  // namespace

struct RayTransfer::Cache {
  std::mutex mutex;
  std::map<double, std::shared_ptr<const TransferData<double>>> data;
};

std::shared_ptr<const TransferData<double>> RayTransfer::at(double wavelength_nm) const {
  const double nm = bands.size() == 1 ? bands.front().wavelength_nm : wavelength_nm;
  const std::lock_guard lock(cache_->mutex);
  std::shared_ptr<const TransferData<double>>& kept = cache_->data[nm];
  if (!kept) {
    auto data = std::make_shared<TransferData<double>>(data_at(*this, nm));
    find_jump(*data);
    fit_start(*data, largest_radius_mm);
    fit_centre(*data, largest_radius_mm);
    set_path_weights(*data);
    kept = data;
  }
  return kept;
}

RayTransfer::Paraxial RayTransfer::paraxial(double wavelength_nm) const {
  const double nm = bands.size() == 1 ? bands.front().wavelength_nm : wavelength_nm;
  const TransferData<double> data = data_at(*this, nm);
  // Coefficients of first order, of a ray against the light: place and direction in front.
  double place_place = 0, place_direction = 0, direction_place = 0, direction_direction = 0;
  Paraxial result;
  const auto coefficient = [&](const Powers& powers, std::size_t output) {
    const std::vector<Powers> all = closed(terms);
    const auto k = static_cast<std::size_t>(std::find(all.begin(), all.end(), powers) - all.begin());
    return k < all.size() ? data.back.coefficients[k * data.back.outputs + output] : 0;
  };
  if (variables == TransferVariables::invariants) {
    const Powers none{0, 0, 0};
    place_place = coefficient(none, 0), place_direction = coefficient(none, 1);
    direction_place = coefficient(none, 2), direction_direction = coefficient(none, 3);
  } else {
    const Powers r{1, 0, 0}, dy{0, 0, 1};
    place_place = coefficient(r, 1), place_direction = coefficient(dy, 1);
    direction_place = coefficient(r, 3), direction_direction = coefficient(dy, 3);
  }
  // The power, the rear and the front focus are the polynomials' own; where their determinant is off 1, it is
  // made 1 by what is left.
  result.a = direction_direction, result.c = direction_place, result.d = place_place;
  result.b = result.c != 0 ? (result.a * result.d - 1) / result.c : place_direction;
  if (data.ellipses.any()) {
    const TransferEllipses<double>& e = data.ellipses;
    // The slope of the centres over the first tenth: single ones have the noise of the fit.
    const std::size_t count = std::max<std::size_t>(2, e.centre_y.size() / 10);
    double up = 0, along = 0;
    for (std::size_t i = 1; i < count; ++i) {
      const double r = static_cast<double>(i) / e.per_step;
      up += r * e.centre_y[i], along += r * r;
    }
    result.h1 = 1 - up / along, result.h2 = -e.plane_mm;
  } else {
    const Powers none{0, 0, 0};
    result.h1 = coefficient(none, 4), result.h2 = -coefficient(none, 5);
  }
  return result;
}

std::shared_ptr<const RayTransfer> made_ready(RayTransfer transfer) {
  require_sound(transfer);
  transfer.cache_ = std::make_shared<RayTransfer::Cache>();
  for (const RayTransfer::Band& band : transfer.bands)
    require_unfolded(transfer, data_at(transfer, band.wavelength_nm), band.wavelength_nm);
  return std::make_shared<const RayTransfer>(std::move(transfer));
}

TransferredRay carried_back(const TransferData<double>& data, const TransferRay& rear) {
  const auto carried = HWY_NAMESPACE::carry_back(data, scalar(rear));
  const double radius_sq = data.stop_radius * data.stop_radius;
  const double share = (carried.stop_x * carried.stop_x + carried.stop_y * carried.stop_y) / radius_sq;
  return {rear,
          {carried.front.x, carried.front.y, carried.front.l, carried.front.m},
          share <= 1 && carried.others_sq <= 1};
}

std::vector<TransferRay> domain_rays(const TransferData<double>& data, double largest_radius_mm,
                                     std::size_t radii, std::size_t across) {
  std::vector<TransferRay> rays;
  const auto passes = [&](double y, double l, double m) {
    return l * l + m * m < 1 && carried_back(data, {0, y, l, m}).passes;
  };
  // How wide the axis sees the pupil, and from there on boxes about the last one.
  constexpr int tries = 2000;
  double half = 0, middle = 0;
  while (half < 1 && passes(0, 0, half + 1.0 / tries)) half += 1.0 / tries;
  half = std::max(half, 0.5 / tries);
  double last_middle = 0;
  for (std::size_t i = 0; i < radii; ++i) {
    const double y =
        radii == 1 ? 0 : largest_radius_mm * static_cast<double>(i) / static_cast<double>(radii - 1);
    // The box is found by a coarse grid about where it should be.
    constexpr int grid = 24;
    const double predicted = 2 * middle - last_middle, reach = 3 * half;
    double low = 1, high = -1, wide = 0;
    for (int a = 0; a <= grid / 2; ++a)
      for (int b = -grid; b <= grid; ++b) {
        const double l = reach * 2 * a / grid, m = predicted + reach * b / grid;
        if (!passes(y, l, m)) continue;
        low = std::min(low, m), high = std::max(high, m), wide = std::max(wide, l);
      }
    if (low > high) continue;
    last_middle = i == 0 ? 0 : middle;
    middle = i == 0 ? 0 : 0.5 * (low + high);
    const double cell = reach / grid, top = high + cell, bottom = low - cell, side = wide + 2 * cell;
    for (std::size_t a = 0; a < across; ++a)
      for (std::size_t b = 0; b < across; ++b) {
        const double l = side * static_cast<double>(a) / static_cast<double>(across);
        const double m =
            bottom + (top - bottom) * (static_cast<double>(b) + 0.5) / static_cast<double>(across);
        if (passes(y, l, m)) rays.push_back({0, y, l, m});
      }
  }
  return rays;
}

namespace {

std::vector<float> floats(const std::vector<double>& from) {
  return {from.begin(), from.end()};
}

TransferPolynomials<float> floats(const TransferPolynomials<double>& from) {
  TransferPolynomials<float> to;
  to.variables = from.variables;
  to.per_unit = static_cast<float>(from.per_unit);
  to.outputs = from.outputs;
  for (const auto& step : from.steps) to.steps.push_back({step.from, step.variable, step.degree});
  to.coefficients = floats(from.coefficients);
  return to;
}

}  // namespace

TransferData<float> in_float(const TransferData<double>& from) {
  TransferData<float> to;
  to.length_mm = static_cast<float>(from.length_mm);
  to.back = floats(from.back);
  to.start = floats(from.start);
  to.ellipses = {static_cast<float>(from.ellipses.plane_mm), static_cast<float>(from.ellipses.per_step),
                 floats(from.ellipses.radius_x), floats(from.ellipses.radius_y),
                 floats(from.ellipses.centre_y)};
  to.stop_radius = static_cast<float>(from.stop_radius);
  to.other_radii_sq = floats(from.other_radii_sq);
  to.centre = floats(from.centre);
  to.path_at = floats(from.path_at);
  to.path_weights = floats(from.path_weights);
  to.jump_mm = static_cast<float>(from.jump_mm);
  to.jump = static_cast<float>(from.jump);
  return to;
}

bool is_ray_transfer(const Lens& lens) {
  return std::any_of(lens.surfaces.begin(), lens.surfaces.end(),
                     [](const Surface& surface) { return surface.transfer != nullptr; });
}

void require_glass(const Lens& lens, const char* what) {
  if (!is_ray_transfer(lens)) return;
  throw InputError(fmt::format(
      "{}: {} the surfaces of a lens, and this one is known by its ray transfer alone", lens.name, what));
}

}  // namespace petzval
