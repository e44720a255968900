// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/target/far_field.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr int points = 10;  // of the interpolating polynomial

/// A regular row of places that covers [½, count − ½] with room for the polynomial at both ends, and for
/// every pixel the first of its points and their weights (Lagrange).
struct Interpolation {
  double origin, spacing;
  int nodes;
  std::vector<int> first;
  std::vector<std::array<double, points>> weights;

  Interpolation(int count, double step) : spacing(step) {
    origin = 0.5 - spacing * (points / 2 - 1);
    nodes = static_cast<int>(std::floor((count - 1) / spacing)) + points;
    for (int i = 0; i < count; ++i) {
      const double at = (i + 0.5 - origin) / spacing;
      const int begin = std::clamp(static_cast<int>(at) - points / 2 + 1, 0, nodes - points);
      first.push_back(begin);
      std::array<double, points> weight;
      for (int j = 0; j < points; ++j) {
        double product = 1;
        for (int m = 0; m < points; ++m)
          if (m != j) product *= (at - begin - m) / (j - m);
        weight[static_cast<std::size_t>(j)] = product;
      }
      weights.push_back(weight);
    }
  }
};

/// ∫ of the kernel's flux through a side, up to the foot coordinate s: atan(s/d) − atan(a s/(d ρ)), d the
/// distance from the side's line and ρ = √(d² + s² + a²), as one arctangent that does not cancel.
double view_angle(double s, double d, double a) {
  const double near2 = d * d + s * s, rho = std::sqrt(near2 + a * a);
  const double denominator = (rho + a) * (d * d * rho + a * s * s);
  return denominator > 0 ? std::atan(s * d * near2 / denominator) : 0;
}

struct Moments {
  Vertex centre;
  double area = 0, xx = 0, xy = 0, yy = 0;  ///< ∬ dA and the central second moments
};

/// By triangles from the first corner: ∬ over one is its area times the mean over its side midpoints,
/// exactly.
Moments moments_of(const Contour& contour) {
  const Vertex& o = contour[0];
  double area = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 1; i + 1 < contour.size(); ++i) {
    const double ax = contour[i].x - o.x, ay = contour[i].y - o.y;
    const double bx = contour[i + 1].x - o.x, by = contour[i + 1].y - o.y;
    const double third = (ax * by - bx * ay) / 6;
    area += 3 * third;
    for (const auto& [mx, my] :
         {std::pair{ax / 2, ay / 2}, {bx / 2, by / 2}, {(ax + bx) / 2, (ay + by) / 2}}) {
      x += third * mx, y += third * my;
      xx += third * mx * mx, xy += third * mx * my, yy += third * my * my;
    }
  }
  if (area == 0) return {o};
  const double cx = x / area, cy = y / area;
  return {{o.x + cx, o.y + cy}, area, xx - cx * x, xy - cx * y, yy - cy * y};
}

/// How far a run of edges may be seen as its chord and the sliver between the two, by the sliver's moments:
/// at most half the lowest height long, and so flat that its third moments count for nothing: sagitta
/// [pixels] · (chord/height)³ up to 1e-3. A picture full of such slivers is then wrong by less than 2e-7.
/// \returns the corner at which it ends.
std::size_t end_of_run(const Contour& contour, std::size_t begin, double height_px) {
  constexpr double longest = 0.5, flattest = 1e-3;
  constexpr std::size_t least_edges = 3;  // a sliver costs a tenth of an edge
  const Vertex& a = contour[begin];
  std::size_t end = begin + 1;
  for (std::size_t next = begin + 2; next <= contour.size(); ++next) {
    const Vertex& b = contour[next % contour.size()];
    const double ex = b.x - a.x, ey = b.y - a.y, length = std::hypot(ex, ey), share = length / height_px;
    if (!(share <= longest) || length == 0) break;
    double sagitta = 0;
    for (std::size_t i = begin + 1; i < next; ++i) {
      const double along = ((contour[i].x - a.x) * ex + (contour[i].y - a.y) * ey) / length;
      if (along < 0 || along > length) sagitta = HUGE_VAL;  // it turns back
      sagitta = std::max(sagitta, std::abs((contour[i].x - a.x) * ey - (contour[i].y - a.y) * ex) / length);
    }
    if (!(sagitta * share * share * share <= flattest)) break;
    end = next;
  }
  return end - begin >= least_edges ? end : begin + 1;
}

}  // namespace

double extent_of(const Contour& contour) {
  Vertex low = contour[0], high = contour[0];
  for (const Vertex& v : contour) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y)};
  }
  return std::max(high.x - low.x, high.y - low.y);
}

double FarKernel::transform(double frequency_cpp) const {
  double sum = 0;
  for (std::size_t j = 0; j < height_px.size(); ++j)
    sum += weight[j] * std::exp(-2 * pi * height_px[j] * frequency_cpp);
  return sum;
}

FarKernel far_kernel(const PsfTail& tail, double pitch_um, double smallest_px) {
  FarKernel kernel;
  kernel.height_px = {smallest_px, 1.5 * smallest_px, 2 * smallest_px};
  // m_j = q_j a_j/2π: Σ m = K3, −3/2 Σ m a² = K5, Σ m a⁴ = 0, by Lagrange's formula in a².
  const double k3 = tail.k3_um / pitch_um, k5 = tail.k5_um3 / (pitch_um * pitch_um * pitch_um);
  const double second = -k5 / 1.5;
  for (std::size_t j = 0; j < 3; ++j) {
    const double a = kernel.height_px[j], b = kernel.height_px[(j + 1) % 3],
                 c = kernel.height_px[(j + 2) % 3];
    const double a2 = a * a, b2 = b * b, c2 = c * c;
    const double m = (k3 * b2 * c2 - second * (b2 + c2)) / ((a2 - b2) * (a2 - c2));
    kernel.weight[j] = 2 * pi * m / a;
  }
  return kernel;
}

FarField::FarField(const std::vector<Region>& regions, const FarKernel& kernel) : kernel_(kernel) {
  for (const Region& region : regions)
    for (const Contour& contour : region.contours) {
      if (extent_of(contour) <= spot_extent * kernel.height_px[0]) {
        const Moments m = moments_of(contour);
        spots_.push_back(
            {m.centre, region.step * m.area, region.step * m.xx, region.step * m.xy, region.step * m.yy});
        continue;
      }
      for (std::size_t i = 0; i < contour.size();) {
        const std::size_t end = end_of_run(contour, i, kernel.height_px[0]);
        sides_.push_back({contour[i], contour[end % contour.size()], region.step});
        if (end > i + 1) {
          // Between the run and its chord there is a sliver.
          Contour sliver(contour.begin() + static_cast<std::ptrdiff_t>(i),
                         contour.begin() + static_cast<std::ptrdiff_t>(std::min(end + 1, contour.size())));
          if (end == contour.size()) sliver.push_back(contour[0]);
          const Moments m = moments_of(sliver);
          spots_.push_back(
              {m.centre, region.step * m.area, region.step * m.xx, region.step * m.xy, region.step * m.yy});
        }
        i = end;
      }
    }
}

double FarField::of_side(const Side& side, Vertex place) const {
  const double ax = side.a.x - place.x, ay = side.a.y - place.y;
  const double ex = side.b.x - side.a.x, ey = side.b.y - side.a.y;
  const double length = std::sqrt(ex * ex + ey * ey);
  if (length == 0) return 0;
  const double d = (ax * ey - ay * ex) / length;
  const double from = (ax * ex + ay * ey) / length, to = from + length;
  double one = 0;
  for (std::size_t j = 0; j < kernel_.weight.size(); ++j)
    one += kernel_.weight[j] *
           (view_angle(to, d, kernel_.height_px[j]) - view_angle(from, d, kernel_.height_px[j]));
  return side.step * one;
}

double FarField::of_spot(const Spot& spot, Vertex place) const {
  const double x = spot.centre.x - place.x, y = spot.centre.y - place.y, r2 = x * x + y * y;
  double sum = 0;
  for (std::size_t j = 0; j < kernel_.weight.size(); ++j) {
    // a/ρ³ and its second derivatives, ρ² = r² + a².
    const double a = kernel_.height_px[j], inverse2 = 1 / (r2 + a * a);
    const double value = a * inverse2 * std::sqrt(inverse2);
    const double bend =
        7.5 * inverse2 * inverse2 * (spot.xx * x * x + 2 * spot.xy * x * y + spot.yy * y * y) -
        1.5 * inverse2 * (spot.xx + spot.yy);
    sum += kernel_.weight[j] * value * (spot.area + bend);
  }
  return sum;
}

double FarField::at(Vertex place) const {
  double sum = 0;
  for (const Side& side : sides_) sum += of_side(side, place);
  for (const Spot& spot : spots_) sum += of_spot(spot, place);
  return sum / (2 * pi);
}

void FarField::add_to(std::vector<double>& values, int columns, int rows) const {
  if (kernel_.is_zero() || (sides_.empty() && spots_.empty())) return;
  const double spacing = kernel_.height_px[0] / 5;
  const Interpolation across(columns, spacing), down(rows, spacing);
  const auto width = static_cast<std::size_t>(columns);
  std::vector<std::vector<double>> lines(static_cast<std::size_t>(down.nodes));  // [node row][column]
  parallel_for(lines.size(), [&](std::size_t r) {
    std::vector<double> nodes;
    for (int c = 0; c < across.nodes; ++c)
      nodes.push_back(
          at({across.origin + c * across.spacing, down.origin + static_cast<double>(r) * down.spacing}));
    lines[r].resize(width);
    for (std::size_t c = 0; c < width; ++c)
      for (int j = 0; j < points; ++j)
        lines[r][c] += across.weights[c][static_cast<std::size_t>(j)] *
                       nodes[static_cast<std::size_t>(across.first[c] + j)];
  });
  parallel_for(static_cast<std::size_t>(rows), [&](std::size_t r) {
    for (int j = 0; j < points; ++j) {
      const std::vector<double>& line = lines[static_cast<std::size_t>(down.first[r] + j)];
      const double weight = down.weights[r][static_cast<std::size_t>(j)];
      for (std::size_t c = 0; c < width; ++c) values[r * width + c] += weight * line[c];
    }
  });
}

}  // namespace petzval
