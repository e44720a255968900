// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/isp/bayer.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace petzval {

namespace {

constexpr int strip_rows = 64;

/// A piece of a plane with a margin around it on all sides.
class Patch {
 public:
  Patch(int rows, int columns)
      : columns_(columns), values_(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns)) {}
  float* row(int r) { return values_.data() + static_cast<std::ptrdiff_t>(r) * columns_; }
  const float* row(int r) const { return values_.data() + static_cast<std::ptrdiff_t>(r) * columns_; }
  int stride() const { return columns_; }

 private:
  int columns_;
  std::vector<float> values_;
};

/// The light itself is interpolated.
struct LightCurve {
  float in(float light) const { return light; }
};

/// Interpolation by gradients as it was published.
struct PublishedGradients : LightCurve {
  float out(float value) const { return value; }
  /// The mean of the differences from p on along a step.
  float difference(const float* p, std::ptrdiff_t step) const {
    return (p[0] + p[step] + p[2 * step] + p[3 * step] + p[4 * step]) / 5;
  }
  float weight(float change) const {
    constexpr float floor = 1e-10f;  // where nothing changes, all directions count alike
    return 1 / (change * change + floor);
  }
  /// Of a difference from the four nearest and the eight next ones on diagonals.
  float from_diagonals(float near, float far) const { return (10 * near - far) / 32; }
};

/// In the root of the light, of values below black likewise with their sign, so that noise about black keeps
/// its mean. The toe keeps the slope finite there. Differences are averaged over two pixels, as few as even
/// out what the two kinds of rows or columns differ by, for in a picture that a lens has blurred they change
/// as smoothly as all else and a longer mean is biased; weights and the share of the far ones were chosen on
/// photographs (docs/ACCURACY.md).
class RootGradients {
 public:
  explicit RootGradients(double toe)
      : toe_(static_cast<float>(toe)), root_(static_cast<float>(std::sqrt(toe))) {}
  float in(float light) const { return std::copysign(std::sqrt(std::abs(light) + toe_) - root_, light); }
  float out(float value) const { return value * (std::abs(value) + 2 * root_); }
  float difference(const float* p, std::ptrdiff_t step) const { return (p[0] + p[step]) / 2; }
  float weight(float change) const {
    const float inverse = PublishedGradients().weight(change);
    return inverse * inverse;
  }
  float from_diagonals(float near, float far) const { return (8 * near - far) / 24; }

 private:
  float toe_, root_;
};

/// Some rows of the mosaic, mirrored into a margin on all four sides. Local row r is row first + r − margin.
struct Strip {
  int first, rows, columns, margin;
  Patch values;

  template <typename Curve>
  Strip(const LinearMosaic& mosaic, int first_row, int row_count, int margin_pixels, const Curve& curve)
      : first(first_row),
        rows(row_count + 2 * margin_pixels),
        columns(mosaic.columns + 2 * margin_pixels),
        margin(margin_pixels),
        values(rows, columns) {
    for (int r = 0; r < rows; ++r) {
      const std::span<const float> from = mosaic.row(mirrored(first + r - margin, mosaic.rows));
      float* into = values.row(r);
      for (int c = 0; c < mosaic.columns; ++c) into[margin + c] = curve.in(from[static_cast<std::size_t>(c)]);
      for (int c = 0; c < margin; ++c) {
        into[c] = into[margin + mirrored(c - margin, mosaic.columns)];
        into[columns - 1 - c] = into[margin + mirrored(mosaic.columns + margin - 1 - c, mosaic.columns)];
      }
    }
  }
  /// The channel of a local pixel.
  int channel(const Mosaic& mosaic, int r, int c) const {
    const int even = 2 * margin;  // keeps numbers positive
    return mosaic.channel(first + r - margin + even, c - margin + even);
  }
};

Planes empty_colours(const LinearMosaic& mosaic) {
  return {mosaic.columns, mosaic.rows,
          std::vector<std::vector<float>>(3, std::vector<float>(mosaic.values.size()))};
}

/// Calls work(strip, rows of the picture in it) for all strips of the picture.
template <typename Curve, typename Work>
void for_strips(const LinearMosaic& mosaic, int margin, const Curve& curve, const Work& work) {
  const int strips = (mosaic.rows + strip_rows - 1) / strip_rows;
  parallel_for(static_cast<std::size_t>(strips), [&](std::size_t i) {
    const int first = static_cast<int>(i) * strip_rows;
    const int count = std::min(strip_rows, mosaic.rows - first);
    work(Strip(mosaic, first, count, margin, curve), count);
  });
}

// ---- Malvar, He & Cutler; all filters have the sum 8

float cross(const float* p, std::ptrdiff_t w) {
  return p[-1] + p[1] + p[-w] + p[w];
}
float far_cross(const float* p, std::ptrdiff_t w) {
  return p[-2] + p[2] + p[-2 * w] + p[2 * w];
}
float diagonal(const float* p, std::ptrdiff_t w) {
  return p[-w - 1] + p[-w + 1] + p[w - 1] + p[w + 1];
}

/// Green at red or blue.
float malvar_green(const float* p, std::ptrdiff_t w) {
  return (4 * p[0] + 2 * cross(p, w) - far_cross(p, w)) / 8;
}
/// At green: the colour whose neighbours lie along `a` (1: in the row, w: in the column); b is the other
/// direction.
float malvar_at_green(const float* p, std::ptrdiff_t a, std::ptrdiff_t b) {
  const float diagonals = p[-a - b] + p[-a + b] + p[a - b] + p[a + b];
  return (5 * p[0] + 4 * (p[-a] + p[a]) - (p[-2 * a] + p[2 * a]) - diagonals +
          0.5f * (p[-2 * b] + p[2 * b])) /
         8;
}
/// Red at blue, blue at red.
float malvar_opposite(const float* p, std::ptrdiff_t w) {
  return (6 * p[0] + 2 * diagonal(p, w) - 1.5f * far_cross(p, w)) / 8;
}

// ---- gradients

/// Green minus the other colour of the line, along a direction of step w: Hamilton and Adams's estimates.
void line_differences(const Strip& strip, const Mosaic& mosaic, std::ptrdiff_t w, Patch& differences) {
  for (int r = 2; r < strip.rows - 2; ++r) {
    const float* p = strip.values.row(r);
    float* out = differences.row(r);
    const float even = strip.channel(mosaic, r, 0) == 1 ? -1.0f : 1.0f;
    const float signs[2] = {even, -even};
    for (int c = 2; c < strip.columns - 2; ++c) {
      const float t = 0.5f * (p[c - w] + p[c + w]) + 0.25f * (2 * p[c] - p[c - 2 * w] - p[c + 2 * w]) - p[c];
      out[c] = signs[c & 1] * t;
    }
  }
}

/// Sum over the five samples from `from` on, in steps of w.
float five(const float* p, std::ptrdiff_t from, std::ptrdiff_t w) {
  return p[from] + p[from + w] + p[from + 2 * w] + p[from + 3 * w] + p[from + 4 * w];
}

/// How much the differences along w change, summed over five pixels across.
Patch changes(const Patch& differences, const Strip& strip, std::ptrdiff_t w, std::ptrdiff_t across) {
  Patch change(strip.rows, strip.columns), sums(strip.rows, strip.columns);
  for (int r = 3; r < strip.rows - 3; ++r) {
    const float* d = differences.row(r);
    float* out = change.row(r);
    for (int c = 3; c < strip.columns - 3; ++c) out[c] = std::abs(d[c - w] - d[c + w]);
  }
  for (int r = 5; r < strip.rows - 5; ++r) {
    const float* d = change.row(r);
    float* out = sums.row(r);
    for (int c = 5; c < strip.columns - 5; ++c) out[c] = five(d + c, -2 * across, across);
  }
  return sums;
}

/// Green minus red at red pixels, green minus blue at blue ones: four directions, weighted.
template <typename Rule>
void weighted_differences(const Strip& strip, const Patch& dh, const Patch& dv, const Patch& ch,
                          const Patch& cv, const Rule& rule, Patch& differences) {
  const std::ptrdiff_t w = strip.columns;
  for (int r = 9; r < strip.rows - 9; ++r) {
    const float *h = dh.row(r), *v = dv.row(r), *gh = ch.row(r), *gv = cv.row(r);
    float* out = differences.row(r);
    for (int c = 9; c < strip.columns - 9; ++c) {
      const float north = rule.weight(five(gv + c, -4 * w, w)), south = rule.weight(five(gv + c, 0, w));
      const float west = rule.weight(five(gh + c, -4, 1)), east = rule.weight(five(gh + c, 0, 1));
      const float sum = north * rule.difference(v + c, -w) + south * rule.difference(v + c, w) +
                        west * rule.difference(h + c, -1) + east * rule.difference(h + c, 1);
      out[c] = sum / (north + south + west + east);
    }
  }
}

/// The difference of the other kind at a red or blue pixel, from the diagonal ones.
template <typename Rule>
float opposite_difference(const float* d, std::ptrdiff_t w, const Rule& rule) {
  const float near = d[-w - 1] + d[-w + 1] + d[w - 1] + d[w + 1];
  const float far = d[-3 * w - 1] + d[-3 * w + 1] + d[3 * w - 1] + d[3 * w + 1] + d[-w - 3] + d[-w + 3] +
                    d[w - 3] + d[w + 3];
  return rule.from_diagonals(near, far);
}

template <typename Rule>
Planes interpolated_by_gradients(const LinearMosaic& mosaic, const Rule& rule) {
  Planes planes = empty_colours(mosaic);
  // 2 for the line estimates, 1 and 2 for their changes, 4 for the directions, 3 for the other colour, 1 for
  // green pixels.
  constexpr int margin = 14;
  for_strips(mosaic, margin, rule, [&](const Strip& strip, int count) {
    const std::ptrdiff_t w = strip.columns;
    Patch dh(strip.rows, strip.columns), dv(strip.rows, strip.columns), d(strip.rows, strip.columns);
    line_differences(strip, mosaic.mosaic, 1, dh);
    line_differences(strip, mosaic.mosaic, w, dv);
    weighted_differences(strip, dh, dv, changes(dh, strip, 1, w), changes(dv, strip, w, 1), rule, d);

    // d holds green − own at red and blue pixels; `other` gets green minus the other colour there.
    Patch other(strip.rows, strip.columns);
    for (int r = 12; r < strip.rows - 12; ++r) {
      const int start = strip.channel(mosaic.mosaic, r, 12) == 1 ? 13 : 12;
      for (int c = start; c < strip.columns - 12; c += 2)
        other.row(r)[c] = opposite_difference(d.row(r) + c, w, rule);
    }
    for (int r = margin; r < margin + count; ++r) {
      const float *p = strip.values.row(r), *own_d = d.row(r), *other_d = other.row(r);
      const std::size_t base =
          static_cast<std::size_t>(strip.first + r - margin) * static_cast<std::size_t>(mosaic.columns);
      float* out[3] = {planes.values[0].data() + base, planes.values[1].data() + base,
                       planes.values[2].data() + base};
      const std::span<const float> measured = mosaic.row(strip.first + r - margin);
      for (int c = margin; c < strip.columns - margin; ++c) {
        const int own = strip.channel(mosaic.mosaic, r, c), x = c - margin;
        if (own != 1) {
          const float green = p[c] + own_d[c];
          out[own][x] = measured[static_cast<std::size_t>(x)];
          out[1][x] = rule.out(green);
          out[2 - own][x] = rule.out(green - other_d[c]);
          continue;
        }
        // Neighbours in the row are of one colour, those in the column of the other.
        const int in_row = strip.channel(mosaic.mosaic, r, c + 1);
        const float row_own = own_d[c - 1] + own_d[c + 1], row_other = other_d[c - 1] + other_d[c + 1];
        const float column_own = own_d[c - w] + own_d[c + w], column_other = other_d[c - w] + other_d[c + w];
        out[1][x] = measured[static_cast<std::size_t>(x)];
        out[in_row][x] = rule.out(p[c] - 0.25f * (row_own + column_other));
        out[2 - in_row][x] = rule.out(p[c] - 0.25f * (column_own + row_other));
      }
    }
  });
  return planes;
}

/// The mean magnitude of the mosaic, the same for any number of threads.
double mean_magnitude(const LinearMosaic& mosaic) {
  std::vector<double> sums(static_cast<std::size_t>(mosaic.rows));
  parallel_for(sums.size(), [&](std::size_t row) {
    const std::span<const float> values = mosaic.row(static_cast<int>(row));
    sums[row] = std::accumulate(values.begin(), values.end(), 0.0, [](double sum, float value) {
      return sum + std::abs(static_cast<double>(value));
    });
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0) / static_cast<double>(mosaic.values.size());
}

}  // namespace

Planes bayer_malvar(const LinearMosaic& mosaic) {
  Planes planes = empty_colours(mosaic);
  constexpr int margin = 2;
  for_strips(mosaic, margin, LightCurve(), [&](const Strip& strip, int count) {
    const std::ptrdiff_t w = strip.columns;
    for (int r = margin; r < margin + count; ++r)
      for (int c = margin; c < strip.columns - margin; ++c) {
        const float* p = strip.values.row(r) + c;
        const int own = strip.channel(mosaic.mosaic, r, c);
        float rgb[3];
        rgb[own] = p[0];
        if (own == 1) {
          const int in_row = strip.channel(mosaic.mosaic, r, c + 1);
          rgb[in_row] = malvar_at_green(p, 1, w);
          rgb[2 - in_row] = malvar_at_green(p, w, 1);
        } else {
          rgb[1] = malvar_green(p, w);
          rgb[2 - own] = malvar_opposite(p, w);
        }
        const std::size_t at =
            static_cast<std::size_t>(strip.first + r - margin) * static_cast<std::size_t>(mosaic.columns) +
            static_cast<std::size_t>(c - margin);
        for (std::size_t k = 0; k < 3; ++k) planes.values[k][at] = rgb[k];
      }
  });
  return planes;
}

Planes bayer_gradient(const LinearMosaic& mosaic) {
  return interpolated_by_gradients(mosaic, PublishedGradients());
}

Planes bayer_root_gradient(const LinearMosaic& mosaic) {
  constexpr double share = 1.0 / 64, least = 1e-9;
  return interpolated_by_gradients(mosaic, RootGradients(std::max(least, share * mean_magnitude(mosaic))));
}

}  // namespace petzval
