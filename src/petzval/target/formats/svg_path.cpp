// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/target/formats/svg_path.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

namespace petzval {

namespace {

constexpr std::size_t most_path_corners = 10'000'000;

/// Numbers and letters of a text, separated as SVG separates them.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  bool at_end() {
    skip_space();
    return at_ == text_.size();
  }
  bool at_number() {
    skip_space();
    return at_ < text_.size() && (std::isdigit(static_cast<unsigned char>(text_[at_])) || text_[at_] == '-' ||
                                  text_[at_] == '+' || text_[at_] == '.');
  }
  char letter() {
    skip_space();
    return at_ < text_.size() ? text_[at_++] : '\0';
  }
  double number() {
    skip_space();
    std::size_t from = at_;
    if (from < text_.size() && text_[from] == '+') ++from;
    double value = 0;
    const auto [end, error] = std::from_chars(text_.data() + from, text_.data() + text_.size(), value);
    if (error != std::errc() || !std::isfinite(value)) fail("a number should stand");
    at_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }
  /// The flags of an arc may stand without space between them.
  bool flag() {
    skip_space();
    if (at_ == text_.size() || (text_[at_] != '0' && text_[at_] != '1')) fail("a flag, 0 or 1, should stand");
    return text_[at_++] == '1';
  }
  std::string word() {
    skip_space();
    std::string result;
    while (at_ < text_.size() && std::isalpha(static_cast<unsigned char>(text_[at_]))) result += text_[at_++];
    return result;
  }
  bool take(char c) {
    skip_space();
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("at character {} of '{}{}': {}", at_ + 1, text_.substr(0, 40),
                                 text_.size() > 40 ? "..." : "", what));
  }

 private:
  void skip_space() {
    while (at_ < text_.size() && (std::isspace(static_cast<unsigned char>(text_[at_])) || text_[at_] == ','))
      ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

class PathBuilder {
 public:
  PathBuilder(Scanner& scanner, const SvgTransform& transform, double tolerance)
      : scanner_(scanner), transform_(transform), tolerance_(tolerance) {}

  std::vector<Contour> run() {
    char command = 0;
    while (!scanner_.at_end()) {
      if (!scanner_.at_number()) {
        command = scanner_.letter();
        if (std::string_view("MmLlHhVvCcSsQqTtAaZz").find(command) == std::string_view::npos)
          scanner_.fail("a path command should stand: M, L, H, V, C, S, Q, T, A or Z");
      } else if (command == 0 || command == 'Z' || command == 'z') {
        scanner_.fail("a number without a command");
      }
      if (current_.empty() && command != 'M' && command != 'm' && !restart_)
        scanner_.fail("a path begins with M");
      execute(command);
      if (command == 'M') command = 'L';
      if (command == 'm') command = 'l';
    }
    if (!current_.empty()) close(false);
    return std::move(contours_);
  }

 private:
  Vertex point(bool relative) {
    const double x = scanner_.number(), y = scanner_.number();
    return relative ? Vertex{at_.x + x, at_.y + y} : Vertex{x, y};
  }

  void execute(char command) {
    const bool relative = std::islower(static_cast<unsigned char>(command)) != 0;
    if (restart_ && command != 'M' && command != 'm' && command != 'Z' && command != 'z') begin(at_);
    std::optional<Vertex> cubic, quadratic;  // the last control point, which S and T reflect
    switch (std::toupper(static_cast<unsigned char>(command))) {
      case 'M': {
        const Vertex to = point(relative && (!current_.empty() || restart_ || !contours_.empty()));
        if (!current_.empty()) close(false);
        begin(to);
        break;
      }
      case 'L':
        line_to(point(relative));
        break;
      case 'H':
        line_to({scanner_.number() + (relative ? at_.x : 0), at_.y});
        break;
      case 'V':
        line_to({at_.x, scanner_.number() + (relative ? at_.y : 0)});
        break;
      case 'C':
      case 'S': {
        const bool smooth = command == 'S' || command == 's';
        const Vertex first = smooth ? Vertex{2 * at_.x - cubic_.x, 2 * at_.y - cubic_.y} : point(relative);
        const Vertex second = point(relative), to = point(relative);
        cubic_to(first, second, to);
        cubic = second;
        break;
      }
      case 'Q':
      case 'T': {
        const bool smooth = command == 'T' || command == 't';
        const Vertex control =
            smooth ? Vertex{2 * at_.x - quadratic_.x, 2 * at_.y - quadratic_.y} : point(relative);
        const Vertex to = point(relative), from = at_;
        cubic_to({from.x + 2 * (control.x - from.x) / 3, from.y + 2 * (control.y - from.y) / 3},
                 {to.x + 2 * (control.x - to.x) / 3, to.y + 2 * (control.y - to.y) / 3}, to);
        quadratic = control;
        break;
      }
      case 'A': {
        const double rx = scanner_.number(), ry = scanner_.number(), turn = scanner_.number();
        const bool large = scanner_.flag(), sweep = scanner_.flag();
        arc_to(std::abs(rx), std::abs(ry), turn * pi / 180, large, sweep, point(relative));
        break;
      }
      default:
        if (!current_.empty()) close(true);
    }
    cubic_ = cubic.value_or(at_);
    quadratic_ = quadratic.value_or(at_);
  }

  void begin(Vertex at) {
    restart_ = false;
    at_ = start_ = at;
    current_ = {transform_(at)};
  }
  void line_to(Vertex to) {
    add(transform_(to));
    at_ = to;
  }
  void add(Vertex v) {
    if (++corners_ > most_path_corners) scanner_.fail(fmt::format("more than {} corners", most_path_corners));
    if (!(v == current_.back())) current_.push_back(v);
  }
  void close(bool said) {
    const Vertex &a = current_.front(), &b = current_.back();
    const bool back = std::hypot(a.x - b.x, a.y - b.y) <= 1e-9 * (1 + std::abs(a.x) + std::abs(a.y));
    if (!said && !back) scanner_.fail("the subpath before this is open; close it with Z");
    if (back && current_.size() > 1) current_.pop_back();
    if (current_.size() > 2) contours_.push_back(std::move(current_));
    current_.clear();
    at_ = start_;
    restart_ = true;
  }

  void cubic_to(Vertex first, Vertex second, Vertex to) {
    const Vertex p[4] = {transform_(at_), transform_(first), transform_(second), transform_(to)};
    // A chord over 1/n of the parameter misses by at most max|P″|/(8n²), P″ within 6 times the second
    // differences.
    const double bend = 6 * std::max(std::hypot(p[0].x - 2 * p[1].x + p[2].x, p[0].y - 2 * p[1].y + p[2].y),
                                     std::hypot(p[1].x - 2 * p[2].x + p[3].x, p[1].y - 2 * p[2].y + p[3].y));
    const int n = pieces(std::sqrt(bend / (8 * tolerance_)));
    for (int i = 1; i <= n; ++i) {
      const double t = static_cast<double>(i) / n, u = 1 - t;
      const double w[4] = {u * u * u, 3 * u * u * t, 3 * u * t * t, t * t * t};
      add({w[0] * p[0].x + w[1] * p[1].x + w[2] * p[2].x + w[3] * p[3].x,
           w[0] * p[0].y + w[1] * p[1].y + w[2] * p[2].y + w[3] * p[3].y});
    }
    at_ = to;
  }

  int pieces(double wanted) const {
    if (!(wanted < 1e6)) scanner_.fail("a curve too large to be divided into chords");
    return std::max(1, static_cast<int>(std::ceil(wanted)));
  }

  /// Endpoint to centre parameters: SVG 1.1, appendix F.6.5.
  void arc_to(double rx, double ry, double turn, bool large, bool sweep, Vertex to) {
    if (rx == 0 || ry == 0) return line_to(to);
    if (to == at_) return;
    const double c = std::cos(turn), s = std::sin(turn);
    const double hx = (at_.x - to.x) / 2, hy = (at_.y - to.y) / 2;
    const double x = c * hx + s * hy, y = -s * hx + c * hy;
    const double scale = std::sqrt(x * x / (rx * rx) + y * y / (ry * ry));
    if (scale > 1) rx *= scale, ry *= scale;
    const double d = rx * rx * y * y + ry * ry * x * x;
    const double root = (large == sweep ? -1 : 1) * std::sqrt(std::max(0.0, (rx * rx * ry * ry - d) / d));
    const double cx = root * rx * y / ry, cy = -root * ry * x / rx;
    const Vertex centre{c * cx - s * cy + (at_.x + to.x) / 2, s * cx + c * cy + (at_.y + to.y) / 2};
    const double from = std::atan2((y - cy) / ry, (x - cx) / rx);
    double span = std::atan2((-y - cy) / ry, (-x - cx) / rx) - from;
    if (sweep && span < 0) span += 2 * pi;
    if (!sweep && span > 0) span -= 2 * pi;
    const double stretch =
        std::max(std::hypot(transform_.a, transform_.b), std::hypot(transform_.c, transform_.d));
    // Sagitta of a chord: r (1 − cos(step/2)).
    const int n = pieces(std::abs(span) * std::sqrt(stretch * std::max(rx, ry) / (8 * tolerance_)));
    for (int i = 1; i < n; ++i) {
      const double angle = from + span * i / n;
      const double px = rx * std::cos(angle), py = ry * std::sin(angle);
      add(transform_({centre.x + c * px - s * py, centre.y + s * px + c * py}));
    }
    line_to(to);
  }

  Scanner& scanner_;
  SvgTransform transform_;
  double tolerance_;
  Vertex at_, start_, cubic_, quadratic_;
  bool restart_ = false;
  std::size_t corners_ = 0;
  Contour current_;
  std::vector<Contour> contours_;
};

}  // namespace

SvgTransform SvgTransform::operator*(const SvgTransform& i) const {
  return {a * i.a + c * i.b, b * i.a + d * i.b,     a * i.c + c * i.d,
          b * i.c + d * i.d, a * i.e + c * i.f + e, b * i.e + d * i.f + f};
}

SvgTransform parse_svg_transform(std::string_view text) {
  Scanner scanner(text);
  SvgTransform all;
  while (!scanner.at_end()) {
    const std::string name = scanner.word();
    if (!scanner.take('(')) scanner.fail("a transform should stand, as translate(3 4)");
    std::vector<double> v;
    while (scanner.at_number() && v.size() < 6) v.push_back(scanner.number());
    if (!scanner.take(')')) scanner.fail("the transform should end with ')'");
    const std::size_t n = v.size();
    v.resize(6);
    const double angle = v[0] * pi / 180, cosine = std::cos(angle), sine = std::sin(angle);
    if (name == "matrix" && n == 6)
      all = all * SvgTransform{v[0], v[1], v[2], v[3], v[4], v[5]};
    else if (name == "translate" && (n == 1 || n == 2))
      all = all * SvgTransform{1, 0, 0, 1, v[0], v[1]};
    else if (name == "scale" && (n == 1 || n == 2))
      all = all * SvgTransform{v[0], 0, 0, n == 1 ? v[0] : v[1], 0, 0};
    else if (name == "rotate" && (n == 1 || n == 3))
      all = all * SvgTransform{1, 0, 0, 1, v[1], v[2]} * SvgTransform{cosine, sine, -sine, cosine, 0, 0} *
            SvgTransform{1, 0, 0, 1, -v[1], -v[2]};
    else if (name == "skewX" && n == 1)
      all = all * SvgTransform{1, 0, std::tan(angle), 1, 0, 0};
    else if (name == "skewY" && n == 1)
      all = all * SvgTransform{1, std::tan(angle), 0, 1, 0, 0};
    else
      scanner.fail(fmt::format("'{}' with {} numbers is no transform", name, n));
  }
  return all;
}

std::vector<Contour> parse_svg_path(std::string_view data, const SvgTransform& transform, double tolerance) {
  Scanner scanner(data);
  return PathBuilder(scanner, transform, tolerance).run();
}

}  // namespace petzval
