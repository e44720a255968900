// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/flare/scatter_light.h>
#include <petzval/flare/scatter_spread.h>
#include <petzval/numeric/fft.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace petzval {

namespace {

/// Cells of the frame and beyond; cell (0, 0) is the frame's first.
struct ScatterCells {
  int pixels = 1;  ///< along a side of a cell
  int columns = 1, rows = 1, margin_columns = 0, margin_rows = 0;
  double side_mm = 1;
  SensorGeometry frame;

  double x_mm(double column) const { return frame.x_mm(column * pixels); }
  double y_mm(double row) const { return frame.y_mm(row * pixels); }
  double area_mm2() const { return side_mm * side_mm; }
};

ScatterCells cells_of(const SensorGeometry& frame, const ScatterLightOptions& options) {
  ScatterCells cells;
  cells.frame = frame;
  cells.pixels = (std::max(frame.columns, frame.rows) + options.cells - 1) / options.cells;
  cells.columns = (frame.columns + cells.pixels - 1) / cells.pixels;
  cells.rows = (frame.rows + cells.pixels - 1) / cells.pixels;
  cells.side_mm = cells.pixels * frame.pitch_um * mm_per_um;
  if (options.surround == ScatterLightOptions::Surround::mean)
    cells.margin_columns = cells.columns / 2, cells.margin_rows = cells.rows / 2;
  return cells;
}

/// The scatter of places of the frame; of a centred lens those of one quarter, which the others mirror.
class NodeFields {
 public:
  NodeFields(const Lens& lens, const ScatterTracer& tracer, const SensorGeometry& frame,
             const ScatterLightOptions& options)
      : nodes_(options.nodes),
        mirrors_(tracer.tracer().is_centred()),
        known_(mirrors_ ? (options.nodes + 1) / 2 : options.nodes),
        frame_(frame) {
    const double reach = 1 + 2.0 / (nodes_ - 1);
    for (int row = 0; row < known_; ++row)
      for (int column = 0; column < known_; ++column)
        fields_.emplace_back(tracer, source_imaged_at(lens, tracer, x_mm(column), y_mm(row)), frame, reach,
                             options.across);
  }

  int count() const { return nodes_; }
  /// Rows and columns of those that no other mirrors.
  int known() const { return known_; }
  bool mirrors() const { return mirrors_; }
  /// Of the columns from the left, rows from the top.
  double x_mm(int column) const {
    return frame_.width_mm() * (0.5 - static_cast<double>(column) / (nodes_ - 1));
  }
  double y_mm(int row) const { return frame_.height_mm() * (static_cast<double>(row) / (nodes_ - 1) - 0.5); }
  int mirrored(int index) const { return mirrors_ ? std::min(index, nodes_ - 1 - index) : index; }
  const ScatterField& field(int column, int row) const {
    return fields_[static_cast<std::size_t>(mirrored(row) * known_ + mirrored(column))];
  }
  /// The share of a node's hat at a place of the frame, in 0…1 from its left or top; beyond, as at the edge.
  double hat(int index, double place) const {
    return std::max(0.0, 1 - std::abs(std::clamp(place, 0.0, 1.0) * (nodes_ - 1) - index));
  }

 private:
  int nodes_;
  bool mirrors_;
  int known_;
  SensorGeometry frame_;
  std::vector<ScatterField> fields_;
};

/// Irradiance about the image of a unit of light, in cells; the kernel of a node that no other mirrors.
class CellKernel {
 public:
  CellKernel(const ScatterField& field, const LensBsdfs& bsdfs, const ScatterCells& cells, int reach_columns,
             int reach_rows)
      : reach_columns_(reach_columns), reach_rows_(reach_rows), columns_(2 * reach_columns + 1) {
    const SourceImage& image = field.image();
    values_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(2 * reach_rows + 1), 0);
    if (!(image.clear_flux_mm2 > 0)) return;
    const double scale = 1 / image.clear_flux_mm2;
    const std::vector<ScatterShares> shares = field.shares(bsdfs);
    each_row([&](int row) {
      for (int column = -reach_columns_; column <= reach_columns_; ++column)
        if (!is_between(column, row))
          value(column, row) = scale * mean_over_cell(field, bsdfs, shares, cells.side_mm, column, row);
    });
    each_row([&](int row) {
      for (int column = -reach_columns_; column <= reach_columns_; ++column)
        if (is_between(column, row)) value(column, row) = mean_of_neighbours(column, row);
    });
  }
  /// At a displacement in cells to the right and downwards.
  double at(int column, int row) const { return values_[index(column, row)]; }

 private:
  template <typename Use>
  void each_row(const Use& use) {
    parallel_for(static_cast<std::size_t>(2 * reach_rows_ + 1),
                 [&](std::size_t i) { use(static_cast<int>(i) - reach_rows_); });
  }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row + reach_rows_) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column + reach_columns_);
  }
  double& value(int column, int row) { return values_[index(column, row)]; }
  /// Far from the image, where light falls off by less than its distance over a cell's, three cells of four
  /// lie between others: their light is linear to (1/16)²·s(s + 1)/2, under a hundredth.
  bool is_between(int column, int row) const {
    constexpr int far = 16;
    if (std::max(std::abs(column), std::abs(row)) <= far) return false;
    if (std::abs(column) == reach_columns_ || std::abs(row) == reach_rows_) return false;
    return column % 2 != 0 || row % 2 != 0;
  }
  double mean_of_neighbours(int column, int row) const {
    const int c = column % 2 != 0 ? 1 : 0, r = row % 2 != 0 ? 1 : 0;
    return (at(column - c, row - r) + at(column + c, row - r) + at(column - c, row + r) +
            at(column + c, row + r)) /
           4;
  }

  static double mean_over_cell(const ScatterField& field, const LensBsdfs& bsdfs,
                               const std::vector<ScatterShares>& shares, double side_mm, int column,
                               int row) {
    // A cell that holds the image is the disc of its area.
    if (column == 0 && row == 0) return field.core(bsdfs, side_mm / std::sqrt(pi));
    constexpr int near = 4, parts = 6;
    const int split = std::max(std::abs(column), std::abs(row)) <= near ? parts : 1;
    const SourceImage& image = field.image();
    double sum = 0;
    for (int j = 0; j < split; ++j)
      for (int i = 0; i < split; ++i)
        sum += field.at(bsdfs, shares, image.x_mm - side_mm * (column - 0.5 + (i + 0.5) / split),
                        image.y_mm + side_mm * (row - 0.5 + (j + 0.5) / split), true);
    return sum / (split * split);
  }

  int reach_columns_, reach_rows_, columns_;
  std::vector<double> values_;
};

/// The light of a band in cells [W·m⁻²·nm⁻¹ times mm²], margin included.
std::vector<double> light_in_cells(std::span<const float> pixels, const ScatterCells& cells) {
  const int wide = cells.columns + 2 * cells.margin_columns, tall = cells.rows + 2 * cells.margin_rows;
  double sum = 0;
  std::vector<double> light(static_cast<std::size_t>(wide) * static_cast<std::size_t>(tall), 0);
  const double pixel_mm2 = std::pow(cells.frame.pitch_um * mm_per_um, 2);
  const auto at = [&](int column, int row) -> double& {
    return light[static_cast<std::size_t>(row + cells.margin_rows) * static_cast<std::size_t>(wide) +
                 static_cast<std::size_t>(column + cells.margin_columns)];
  };
  for (int row = 0; row < cells.frame.rows; ++row)
    for (int column = 0; column < cells.frame.columns; ++column) {
      const double value =
          pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(cells.frame.columns) +
                 static_cast<std::size_t>(column)];
      at(column / cells.pixels, row / cells.pixels) += value * pixel_mm2;
      sum += value;
    }
  const double mean = sum / (static_cast<double>(cells.frame.columns) * cells.frame.rows) * cells.area_mm2();
  for (int row = -cells.margin_rows; row < cells.rows + cells.margin_rows; ++row)
    for (int column = -cells.margin_columns; column < cells.columns + cells.margin_columns; ++column)
      if (row < 0 || row >= cells.rows || column < 0 || column >= cells.columns) at(column, row) = mean;
  return light;
}

/// What the frame's cells receive of light in cells: node by node, its share of the light with its kernel.
std::vector<double> scattered_in_cells(const std::vector<double>& light, const NodeFields& nodes,
                                       const LensBsdfs& bsdfs, const ScatterCells& cells) {
  const int wide = cells.columns + 2 * cells.margin_columns, tall = cells.rows + 2 * cells.margin_rows;
  const int reach_columns = cells.columns + cells.margin_columns - 1,
            reach_rows = cells.rows + cells.margin_rows - 1;
  const RealFft2<double> transform(good_fft_size(tall + reach_rows + 1),
                                   good_fft_size(wide + reach_columns + 1));
  AlignedVector<double> plane(transform.size());
  AlignedVector<std::complex<double>> source(transform.spectrum_size()), kernel(transform.spectrum_size()),
      sum(transform.spectrum_size());
  const auto place = [&](int column, int row) -> double& {
    const int c = column < 0 ? column + transform.columns() : column,
              r = row < 0 ? row + transform.rows() : row;
    return plane[static_cast<std::size_t>(r) * static_cast<std::size_t>(transform.columns()) +
                 static_cast<std::size_t>(c)];
  };
  const auto add_node = [&](const CellKernel& spread, int column, int row) {
    std::ranges::fill(plane, 0.0);
    for (int r = 0; r < tall; ++r)
      for (int c = 0; c < wide; ++c)
        place(c, r) = light[static_cast<std::size_t>(r) * static_cast<std::size_t>(wide) +
                            static_cast<std::size_t>(c)] *
                      nodes.hat(column, (c - cells.margin_columns + 0.5) / cells.columns) *
                      nodes.hat(row, (r - cells.margin_rows + 0.5) / cells.rows);
    transform.forward(plane, source);
    std::ranges::fill(plane, 0.0);
    const int turn_c = nodes.mirrors() && 2 * column > nodes.count() - 1 ? -1 : 1,
              turn_r = nodes.mirrors() && 2 * row > nodes.count() - 1 ? -1 : 1;
    for (int r = -reach_rows; r <= reach_rows; ++r)
      for (int c = -reach_columns; c <= reach_columns; ++c) place(c, r) = spread.at(turn_c * c, turn_r * r);
    transform.forward(plane, kernel);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += source[i] * kernel[i];
  };
  for (int row = 0; row < nodes.known(); ++row)
    for (int column = 0; column < nodes.known(); ++column) {
      const CellKernel spread(nodes.field(column, row), bsdfs, cells, reach_columns, reach_rows);
      const int last = nodes.count() - 1;
      add_node(spread, column, row);
      if (!nodes.mirrors()) continue;
      if (last - column != column) add_node(spread, last - column, row);
      if (last - row != row) add_node(spread, column, last - row);
      if (last - column != column && last - row != row) add_node(spread, last - column, last - row);
    }
  transform.inverse(sum, plane);
  std::vector<double> result;
  for (int r = 0; r < cells.rows; ++r)
    for (int c = 0; c < cells.columns; ++c)
      result.push_back(place(c + cells.margin_columns, r + cells.margin_rows) /
                       static_cast<double>(transform.size()));
  return result;
}

/// Of cells, linear between their middles.
double between_cells(const std::vector<double>& values, const ScatterCells& cells, int column, int row) {
  const auto at = [&](int c, int r) {
    return values[static_cast<std::size_t>(std::clamp(r, 0, cells.rows - 1)) *
                      static_cast<std::size_t>(cells.columns) +
                  static_cast<std::size_t>(std::clamp(c, 0, cells.columns - 1))];
  };
  const double x = (column + 0.5) / cells.pixels - 0.5, y = (row + 0.5) / cells.pixels - 0.5;
  const int c = static_cast<int>(std::floor(x)), r = static_cast<int>(std::floor(y));
  const double u = x - c, v = y - r;
  return (at(c, r) * (1 - u) + at(c + 1, r) * u) * (1 - v) +
         (at(c, r + 1) * (1 - u) + at(c + 1, r + 1) * u) * v;
}

/// What scatter takes at a pixel.
std::vector<double> shares_of_nodes(const NodeFields& nodes, const LensBsdfs& bsdfs) {
  std::vector<double> shares;
  for (int row = 0; row < nodes.count(); ++row)
    for (int column = 0; column < nodes.count(); ++column)
      shares.push_back(nodes.field(column, row).share(bsdfs));
  return shares;
}

double share_at(const std::vector<double>& shares, int nodes, double x, double y) {
  const double column = x * (nodes - 1), row = y * (nodes - 1);
  const auto c = static_cast<std::size_t>(std::min(static_cast<int>(column), nodes - 2)),
             r = static_cast<std::size_t>(std::min(static_cast<int>(row), nodes - 2)),
             n = static_cast<std::size_t>(nodes);
  const double u = column - static_cast<double>(c), v = row - static_cast<double>(r);
  return (shares[r * n + c] * (1 - u) + shares[r * n + c + 1] * u) * (1 - v) +
         (shares[(r + 1) * n + c] * (1 - u) + shares[(r + 1) * n + c + 1] * u) * v;
}

/// A source that the frame does not hold.
struct OutsideSource {
  std::vector<double> irradiance;
  ScatterField field;
};

bool is_in_frame(const SourceImage& image, const SensorGeometry& frame) {
  return image.clear_flux_mm2 > 0 && std::abs(image.x_mm) <= frame.width_mm() / 2 &&
         std::abs(image.y_mm) <= frame.height_mm() / 2;
}

double axial_transmittance(const Lens& lens, double wavelength_nm, const Losses& losses) {
  if (!losses.of(lens).any()) return 1;
  const Tracer tracer(lens, wavelength_nm);
  std::vector<Intersection> path;
  const Ray axis{{0, 0, 0}, {0, 0, 1}, 0, RayStatus::ok, -1};
  tracer.trace(axis, Tracer::Clip::none, &path);
  return LensTransmittance(lens, wavelength_nm, losses).along(axis, path);
}

LensBsdfs bsdfs_at(const Lens& lens, double wavelength_nm, Tracer::Clip clip) {
  const ScatterTracer tracer(lens, wavelength_nm, {}, clip);
  LensBsdfs bsdfs;
  for (std::size_t i = 0; i < tracer.surface_count(); ++i) bsdfs.push_back(tracer.bsdf(i));
  return bsdfs;
}

}  // namespace

void ScatterLightOptions::validate() const {
  if (cells < 8 || cells > 2048)
    throw InputError(fmt::format("{} cells along a frame; 8 to 2048 would be right", cells));
  if (nodes < 2 || nodes > 33)
    throw InputError(fmt::format("{} nodes along a frame; 2 to 33 would be right", nodes));
  if (across < 4 || across > 512)
    throw InputError(fmt::format("{} rays across what is lit; 4 to 512 would be right", across));
}

SpectralImage scatter_light(const Lens& lens, const SpectralImage& light,
                            std::span<const BrightSource> sources, const ScatterLightOptions& options,
                            const ProgressCallback& progress, ScatterLightReport* report) {
  options.validate();
  const std::vector<double>& wavelengths = light.wavelengths_nm();
  for (const BrightSource& source : sources) source.validate(wavelengths.size());
  const SensorGeometry frame{light.columns(), light.rows(), light.pitch_um()};
  const double reference_nm = lens.reference_wavelength_nm;
  const ScatterTracer tracer(lens, reference_nm, options.losses, options.clip);
  if (!tracer.scatters())
    throw InputError(
        "no surface of the lens scatters; `scatter` roughness=1.5 or a lens file that says how would be "
        "right");
  const ScatterCells cells = cells_of(frame, options);
  const NodeFields nodes(lens, tracer, frame, options);
  std::vector<OutsideSource> outside;
  for (const BrightSource& source : sources) {
    SourceImage image;
    constexpr int few_rays = 10;
    tracer.light(SourceBeam(source), few_rays, &image);
    if (!is_in_frame(image, frame))
      outside.push_back({source.irradiance, ScatterField(tracer, source, frame, 1, options.across)});
  }
  SpectralImage layer(light.columns(), light.rows(), wavelengths, light.pitch_um(), light.pixel_aperture());
  layer.photosite = light.photosite;
  const double axial = axial_transmittance(lens, reference_nm, options.losses);
  double all = 0, taken = 0, returned = 0;
  for (int band = 0; band < light.bands(); ++band) {
    const double wavelength_nm = wavelengths[static_cast<std::size_t>(band)];
    const LensBsdfs bsdfs = bsdfs_at(lens, wavelength_nm, options.clip);
    const std::span<const float> pixels = light.band(band);
    std::vector<double> received = scattered_in_cells(light_in_cells(pixels, cells), nodes, bsdfs, cells);
    const double through = axial > 0 ? axial_transmittance(lens, wavelength_nm, options.losses) / axial : 1;
    for (const OutsideSource& source : outside) {
      const std::vector<ScatterShares> shares = source.field.shares(bsdfs);
      parallel_for(static_cast<std::size_t>(cells.rows), [&](std::size_t row) {
        for (int column = 0; column < cells.columns; ++column)
          received[row * static_cast<std::size_t>(cells.columns) + static_cast<std::size_t>(column)] +=
              through * source.irradiance[static_cast<std::size_t>(band)] *
              source.field.at(bsdfs, shares, cells.x_mm(column + 0.5),
                              cells.y_mm(static_cast<double>(row) + 0.5), false);
      });
    }
    const std::vector<double> shares = shares_of_nodes(nodes, bsdfs);
    const std::span<float> out = layer.band(band);
    for (int row = 0; row < frame.rows; ++row)
      for (int column = 0; column < frame.columns; ++column) {
        const std::size_t i = static_cast<std::size_t>(row) * static_cast<std::size_t>(frame.columns) +
                              static_cast<std::size_t>(column);
        const double gain = between_cells(received, cells, column, row);
        const double loss = pixels[i] * share_at(shares, nodes.count(), (column + 0.5) / frame.columns,
                                                 (row + 0.5) / frame.rows);
        out[i] = static_cast<float>(gain - loss);
        all += pixels[i], taken += loss, returned += gain;
      }
    if (progress) progress((band + 1.0) / light.bands(), "scatter");
  }
  if (report && all > 0) *report = {taken / all, returned / all, static_cast<int>(outside.size())};
  return layer;
}

}  // namespace petzval
