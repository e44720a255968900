// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/isp/bayer.h>
#include <petzval/isp/demosaic.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// For one cell of the mosaic: which neighbours make up each channel, and with what weights.
struct Tap {
  int row, column, channel;
  float weight;
};

/// Triangles of one period's half width, so that every channel is met; weights of a channel sum to 1.
std::vector<Tap> triangle_taps(const Mosaic& mosaic, int channels, int r0, int c0) {
  std::vector<Tap> taps;
  std::vector<double> sums(static_cast<std::size_t>(channels));
  for (int r = 1 - mosaic.rows; r < mosaic.rows; ++r)
    for (int c = 1 - mosaic.columns; c < mosaic.columns; ++c) {
      const int channel = mosaic.channel(r0 + r + mosaic.rows, c0 + c + mosaic.columns);
      const bool own = channel == mosaic.channel(r0, c0);
      if (own && (r != 0 || c != 0)) continue;  // a measured value is kept
      const double weight = (1 - std::abs(r) / static_cast<double>(mosaic.rows)) *
                            (1 - std::abs(c) / static_cast<double>(mosaic.columns));
      taps.push_back({r, c, channel, static_cast<float>(weight)});
      sums[static_cast<std::size_t>(channel)] += weight;
    }
  for (Tap& tap : taps) tap.weight /= static_cast<float>(sums[static_cast<std::size_t>(tap.channel)]);
  return taps;
}

Planes empty_planes(const LinearMosaic& mosaic) {
  return {mosaic.columns, mosaic.rows,
          std::vector<std::vector<float>>(mosaic.channels.size(), std::vector<float>(mosaic.values.size()))};
}

Planes bilinear(const LinearMosaic& mosaic) {
  Planes planes = empty_planes(mosaic);
  const Mosaic& cells = mosaic.mosaic;
  std::vector<std::vector<Tap>> taps;
  for (int r = 0; r < cells.rows; ++r)
    for (int c = 0; c < cells.columns; ++c)
      taps.push_back(triangle_taps(cells, static_cast<int>(mosaic.channels.size()), r, c));
  const auto columns = static_cast<std::size_t>(mosaic.columns);
  parallel_for(static_cast<std::size_t>(mosaic.rows), [&](std::size_t row) {
    const int r = static_cast<int>(row);
    for (int c = 0; c < mosaic.columns; ++c)
      for (const Tap& tap :
           taps[static_cast<std::size_t>(r % cells.rows * cells.columns + c % cells.columns)]) {
        // Mirroring may change the channel in mosaics of longer periods; then the nearest place a period
        // further in has it.
        int from_row = mirrored(r + tap.row, mosaic.rows),
            from_column = mirrored(c + tap.column, mosaic.columns);
        if (cells.channel(from_row, from_column) != tap.channel) {
          from_row = r + tap.row < 0              ? r + tap.row + cells.rows
                     : r + tap.row >= mosaic.rows ? r + tap.row - cells.rows
                                                  : r + tap.row;
          from_column = c + tap.column < 0                 ? c + tap.column + cells.columns
                        : c + tap.column >= mosaic.columns ? c + tap.column - cells.columns
                                                           : c + tap.column;
          from_row = mirrored(from_row, mosaic.rows), from_column = mirrored(from_column, mosaic.columns);
        }
        planes.values[static_cast<std::size_t>(tap.channel)][row * columns + static_cast<std::size_t>(c)] +=
            tap.weight * mosaic.row(from_row)[static_cast<std::size_t>(from_column)];
      }
  });
  return planes;
}

/// Local means of every channel over one period and its edge, all of them at every pixel.
Planes local_means(const LinearMosaic& mosaic) {
  Planes planes = empty_planes(mosaic);
  const int reach_r = mosaic.mosaic.rows, reach_c = mosaic.mosaic.columns;
  const auto columns = static_cast<std::size_t>(mosaic.columns);
  parallel_for(static_cast<std::size_t>(mosaic.rows), [&](std::size_t row) {
    std::vector<float> sums(mosaic.channels.size()), weights(mosaic.channels.size());
    for (int c = 0; c < mosaic.columns; ++c) {
      std::fill(sums.begin(), sums.end(), 0.0f);
      std::fill(weights.begin(), weights.end(), 0.0f);
      for (int dr = -reach_r; dr <= reach_r; ++dr)
        for (int dc = -reach_c; dc <= reach_c; ++dc) {
          const int r = mirrored(static_cast<int>(row) + dr, mosaic.rows),
                    k = mirrored(c + dc, mosaic.columns);
          const auto channel = static_cast<std::size_t>(mosaic.mosaic.channel(r, k));
          const float weight =
              static_cast<float>((reach_r + 1 - std::abs(dr)) * (reach_c + 1 - std::abs(dc)));
          sums[channel] += weight * mosaic.row(r)[static_cast<std::size_t>(k)];
          weights[channel] += weight;
        }
      for (std::size_t i = 0; i < sums.size(); ++i)
        planes.values[i][row * columns + static_cast<std::size_t>(c)] =
            weights[i] > 0 ? sums[i] / weights[i] : 0;
    }
  });
  return planes;
}

/// Where the own channel lies above its local mean, so do the others: their mean takes its detail.
Planes general(const LinearMosaic& mosaic) {
  Planes planes = local_means(mosaic);
  const auto columns = static_cast<std::size_t>(mosaic.columns);
  parallel_for(static_cast<std::size_t>(mosaic.rows), [&](std::size_t row) {
    for (std::size_t c = 0; c < columns; ++c) {
      const std::size_t at = row * columns + c;
      const auto own =
          static_cast<std::size_t>(mosaic.mosaic.channel(static_cast<int>(row), static_cast<int>(c)));
      const float detail = mosaic.values[at] - planes.values[own][at];
      for (auto& plane : planes.values) plane[at] += detail;
      planes.values[own][at] = mosaic.values[at];
    }
  });
  return planes;
}

}  // namespace

const std::vector<DemosaicMethod>& demosaic_methods() {
  static const std::vector<DemosaicMethod> methods{
      {"bilinear", "mean of the nearest of each channel, weighted by a triangle", false, bilinear},
      {"malvar", "Malvar, He & Cutler 2004: bilinear with Laplacian corrections, linear", true, bayer_malvar},
      {"hamilton-adams", "Hamilton & Adams 1997: along the edge, with the curvature of the other colour",
       true, bayer_hamilton_adams},
      {"gradient", "Pekkucuksen & Altunbasak 2010: colour differences, weighted by their gradients", true,
       bayer_gradient},
      {"root-gradient",
       "gradient, in the root of the light: even noise, and differences as the eye sees them", true,
       bayer_root_gradient},
      {"general", "bilinear, and the detail of the pixel's own channel handed to the others", false,
       general}};
  return methods;
}

const DemosaicMethod& demosaic_method(const std::string& name) {
  std::vector<std::string> names;
  for (const DemosaicMethod& method : demosaic_methods()) {
    if (method.name == name) return method;
    names.push_back(method.name);
  }
  throw InputError(fmt::format("no demosaic \"{}\"; {} would be right", name, fmt::join(names, ", ")));
}

const DemosaicMethod& usual_demosaic_method(const LinearMosaic& mosaic) {
  return demosaic_method(is_bayer(mosaic) ? "root-gradient" : "general");
}

bool is_bayer(const LinearMosaic& mosaic) {
  const Mosaic& cells = mosaic.mosaic;
  if (mosaic.channels != std::vector<std::string>{"red", "green", "blue"} || cells.rows != 2 ||
      cells.columns != 2)
    return false;
  const auto& c = cells.cells;
  const auto other = [](int a, int b) { return (a == 0 && b == 2) || (a == 2 && b == 0); };
  return (c[0] == 1 && c[3] == 1 && other(c[1], c[2])) || (c[1] == 1 && c[2] == 1 && other(c[0], c[3]));
}

Planes demosaiced(const LinearMosaic& mosaic, const std::string& name) {
  const DemosaicMethod& method = demosaic_method(name);
  if (mosaic.channels.size() == 1) return {mosaic.columns, mosaic.rows, {mosaic.values}};
  if (method.bayer_only && !is_bayer(mosaic))
    throw InputError(
        "this demosaic is for Bayer mosaics of red, green and blue; general or bilinear would be right");
  return method.interpolate(mosaic);
}

}  // namespace petzval
