// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/colour/spectra_files.h>
#include <petzval/scene/charts.h>
#include <petzval/scene/lettering.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace petzval {

namespace {

constexpr double white = 0.88, light = 0.62, middle_grey = 0.19, black = 0.03;

/// The layout, in thirds of the chart's height (4 × 3 of them at 4:3), origin in the middle of the picture.
class Studio {
 public:
  explicit Studio(ChartCanvas& canvas)
      : canvas_(canvas),
        patches_(read_spectrum_set("colorchecker_reflectance")),
        unit_(std::min(canvas.columns() / 4.0, canvas.rows() / 3.0)),
        middle_{canvas.columns() / 2.0, canvas.rows() / 2.0} {}

  void draw();

 private:
  void draw_background();
  void draw_line_grid();
  void draw_star(Point centre, double radius);
  void draw_slanted_square(Point centre, double side, double angle_deg, const Paint& ground,
                           const Paint& square);
  void draw_grey_steps(double left, double top, double right, double bottom, int steps);
  void draw_bars(double left, double top, double right, double bottom);
  void draw_text(const char* text, double top, double height);

  Point at(double x, double y) const { return {middle_.x + unit_ * x, middle_.y + unit_ * y}; }
  Paint patch(const char* name) const { return canvas_.paint(patches_.find(name)); }
  /// A grey of this reflectance at 555 nm, with the spectrum of the chart's most neutral patch.
  Paint grey(double reflectance) const {
    const Spectrum& neutral = patches_.find("neutral 5");
    return canvas_.paint(neutral.scaled(reflectance / neutral.at(555)));
  }
  void add_rectangle(Shape& shape, double left, double top, double right, double bottom) const {
    const Point a = at(left, top), b = at(right, bottom);
    shape.add_rectangle(a.x, a.y, b.x, b.y);
  }
  void draw_rectangle(double left, double top, double right, double bottom, const Paint& paint) {
    Shape shape;
    add_rectangle(shape, left, top, right, bottom);
    canvas_.draw(shape, paint);
  }
  double texture(double x, double y) const;

  ChartCanvas& canvas_;
  SpectrumSet patches_;
  double unit_;
  Point middle_;
};

/// A number in [−1, 1) for each point of a lattice, always the same (the finaliser of SplitMix64, Steele et
/// al. 2014).
double lattice_value(std::int64_t x, std::int64_t y, std::uint64_t octave) {
  std::uint64_t z = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u +
                    static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fu + octave * 0x165667b19e3779f9u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-52 - 1;
}

/// Lattice values with smooth transitions between them (value noise).
double smooth_noise(double x, double y, std::uint64_t octave) {
  const double x0 = std::floor(x), y0 = std::floor(y);
  const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
  const double u = smooth(x - x0), v = smooth(y - y0);
  const auto value = [&](int i, int j) {
    return lattice_value(static_cast<std::int64_t>(x0) + i, static_cast<std::int64_t>(y0) + j, octave);
  };
  return (1 - v) * ((1 - u) * value(0, 0) + u * value(1, 0)) + v * ((1 - u) * value(0, 1) + u * value(1, 1));
}

/// Around 1, even on average everywhere; the finest grain is 1/24 of a unit, 8 pixels of 576 rows.
double Studio::texture(double x, double y) const {
  double value = 1, cells = 6;
  for (std::uint64_t octave = 0; octave < 3; ++octave, cells *= 2)
    value += 0.07 * smooth_noise(x * cells, y * cells, octave);
  return value;
}

void Studio::draw_background() {
  canvas_.modulate(grey(middle_grey), [&](int row, std::span<double> factors) {
    for (std::size_t x = 0; x < factors.size(); ++x)
      factors[x] =
          texture((static_cast<double>(x) + 0.5 - middle_.x) / unit_, (row + 0.5 - middle_.y) / unit_);
  });
}

/// White lines every eighth of a unit over the whole picture, every fourth one stronger.
void Studio::draw_line_grid() {
  constexpr double spacing = 0.125;
  const double half_width = middle_.x / unit_, half_height = middle_.y / unit_;
  Shape upright, level;
  const auto line_half = [](int i) { return i % 4 == 0 ? 0.0065 : 0.0032; };
  for (int i = static_cast<int>(-half_width / spacing); i <= half_width / spacing; ++i)
    add_rectangle(upright, i * spacing - line_half(i), -half_height, i * spacing + line_half(i), half_height);
  for (int i = static_cast<int>(-half_height / spacing); i <= half_height / spacing; ++i)
    add_rectangle(level, -half_width, i * spacing - line_half(i), half_width, i * spacing + line_half(i));
  canvas_.draw(upright, grey(white));
  canvas_.draw(level, grey(white));
}

/// A Siemens star of 36 dark sectors on a light disc.
void Studio::draw_star(Point centre, double radius) {
  constexpr int sectors = 36, arc_steps = 4;
  const Point middle = at(centre.x, centre.y);
  Shape disc, star;
  disc.add_disc(middle, 1.1 * radius * unit_);
  for (int sector = 0; sector < sectors; ++sector) {
    std::vector<Point> wedge = {middle};
    for (int step = 0; step <= arc_steps; ++step) {
      const double angle = pi / sectors * (2 * sector + static_cast<double>(step) / arc_steps);
      wedge.push_back(
          {middle.x + radius * unit_ * std::cos(angle), middle.y + radius * unit_ * std::sin(angle)});
    }
    star.add_polygon(wedge);
  }
  canvas_.draw(disc, grey(white));
  canvas_.draw(star, grey(black));
}

void Studio::draw_slanted_square(Point centre, double side, double angle_deg, const Paint& ground,
                                 const Paint& square) {
  draw_rectangle(centre.x - 0.8 * side, centre.y - 0.8 * side, centre.x + 0.8 * side, centre.y + 0.8 * side,
                 ground);
  Shape shape;
  shape.add_square(at(centre.x, centre.y), side * unit_, radians(angle_deg));
  canvas_.draw(shape, square);
}

/// From white down to 2 % of it, by equal factors. Each step is painted over the rest of the strip, so that
/// no background shows between two. Their common edges, above and below, would mix all of them where they
/// cover a sample in part; a frame painted last covers these.
void Studio::draw_grey_steps(double left, double top, double right, double bottom, int steps) {
  constexpr double darkest = 0.02, frame = 0.04, beyond = 0.02;
  draw_rectangle(left - frame, top - frame, right + frame, bottom + frame, grey(black));
  for (int step = 0; step < steps; ++step)
    draw_rectangle(left + (right - left) * step / steps, top - beyond, right + beyond, bottom + beyond,
                   grey(white * std::pow(darkest, static_cast<double>(step) / (steps - 1))));
  Shape edges;
  add_rectangle(edges, left - beyond, top - 1.5 * beyond, right + 1.5 * beyond, top);
  add_rectangle(edges, left - beyond, bottom, right + 1.5 * beyond, bottom + 1.5 * beyond);
  add_rectangle(edges, right, top, right + 1.5 * beyond, bottom);
  canvas_.draw(edges, grey(black));
}

/// Groups of five dark bars, upright and level, each group finer than the one before.
void Studio::draw_bars(double left, double top, double right, double bottom) {
  draw_rectangle(left - 0.04, top - 0.04, right + 0.04, bottom + 0.04, grey(white));
  const double height = bottom - top;
  Shape bars;
  double x = left;
  for (double bar = height / 9; x + 2 * 9 * bar + height / 6 < right; bar *= 0.62) {
    const double size = 9 * bar, middle = (top + bottom) / 2;
    for (int i = 0; i < 5; ++i) {
      add_rectangle(bars, x + 2 * i * bar, middle - size / 2, x + (2 * i + 1) * bar, middle + size / 2);
      add_rectangle(bars, x + size + 2 * bar, middle - size / 2 + 2 * i * bar, x + 2 * size + 2 * bar,
                    middle - size / 2 + (2 * i + 1) * bar);
    }
    x += 2 * size + 6 * bar;
  }
  canvas_.draw(bars, grey(black));
}

void Studio::draw_text(const char* text, double top, double height) {
  Shape letters;
  const Point corner = at(-text_width(text, height) / 2, top);
  add_text(letters, text, corner.x, corner.y, height * unit_);
  canvas_.draw(letters, grey(black));
}

/// The parts of the chart, from the back to the front.
void Studio::draw() {
  draw_background();
  draw_line_grid();
  for (const double side : {-1.0, 1.0}) {
    for (const double end : {-1.0, 1.0}) {
      draw_star({1.62 * side, 1.12 * end}, 0.29);
      draw_slanted_square({1.05 * side, 1.22 * end}, 0.2, 5 * side * end, grey(light), grey(light / 4));
    }
    draw_slanted_square({1.62 * side, 0}, 0.4, 5 * side, grey(white), grey(black));
  }
  draw_slanted_square({-1.05, -0.35}, 0.2, 5, grey(white), patch("red"));
  draw_slanted_square({-1.05, 0.35}, 0.2, -5, grey(white), patch("green"));
  draw_slanted_square({1.05, -0.35}, 0.2, -5, grey(white), patch("blue"));
  draw_slanted_square({1.05, 0.35}, 0.2, 5, grey(black), patch("yellow"));

  draw_rectangle(-0.8, -1.42, 0.8, -0.96, grey(light));
  draw_text("PETZVAL", -1.36, 0.22);
  draw_text("COMPUTED BEFORE IT WAS GROUND", -1.08, 0.06);
  draw_colorchecker(canvas_, at(-0.8, -0.88), 1.6 * unit_);
  draw_grey_steps(-0.76, 0.3, 0.76, 0.5, 12);
  draw_bars(-0.76, 0.62, 0.76, 0.84);
  draw_rectangle(-0.8, 0.94, 0.8, 1.42, grey(light));
  draw_text("SPHINX OF BLACK", 0.98, 0.11);
  draw_text("QUARTZ JUDGE MY VOW", 1.13, 0.08);
  draw_text("THE QUICK BROWN FOX JUMPS OVER", 1.25, 0.05);
  draw_text("THE LAZY DOG - 0123456789", 1.335, 0.035);
}

}  // namespace

Scene studio_chart(const ChartOptions& options) {
  ChartCanvas canvas(options);
  Studio(canvas).draw();
  return std::move(canvas).lit();
}

}  // namespace petzval
