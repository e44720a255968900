// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/whole_file.h>
#include <petzval/target/crossings.h>
#include <petzval/target/formats/svg_path.h>
#include <petzval/target/formats/svg_shapes.h>
#include <petzval/target/formats/svg_style.h>
#include <petzval/target/visible_regions.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <pugixml.hpp>
#include <string_view>

namespace petzval {

namespace {

double linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// Rec. 709 luminance of sRGB code values 0 to 255.
double luminance(double r, double g, double b) {
  return 0.2126 * linear(r / 255) + 0.7152 * linear(g / 255) + 0.0722 * linear(b / 255);
}

/// The level of a fill; nothing for "none".
std::optional<double> level_of(const std::string& fill) {
  if (fill == "none" || fill == "transparent") return std::nullopt;
  if (fill == "black") return 0;
  if (fill == "white") return 1;
  if (fill == "gray" || fill == "grey") return luminance(128, 128, 128);
  if (fill.size() > 1 && fill[0] == '#') {
    unsigned value = 0;
    const auto [end, error] = std::from_chars(fill.data() + 1, fill.data() + fill.size(), value, 16);
    const bool whole = error == std::errc() && end == fill.data() + fill.size();
    if (whole && fill.size() == 7) return luminance(value >> 16, (value >> 8) & 255, value & 255);
    if (whole && fill.size() == 4)
      return luminance((value >> 8) * 17, ((value >> 4) & 15) * 17, (value & 15) * 17);
  }
  int r = 0, g = 0, b = 0;
  char end = 0;
  if (std::sscanf(fill.c_str(), " rgb( %d , %d , %d %c", &r, &g, &b, &end) == 4 && end == ')' &&
      std::min({r, g, b}) >= 0 && std::max({r, g, b}) <= 255)
    return luminance(r, g, b);
  throw InputError(fmt::format("fill '{}': none, black, white, grey, #rgb, #rrggbb or rgb(r, g, b) is right",
                               quotable(fill)));
}

/// What an element inherits.
struct Style {
  std::string fill = "black", fill_rule = "nonzero";
  SvgTransform transform;
};

double number(const pugi::xml_node& node, const char* name, double otherwise) {
  const pugi::xml_attribute attribute = node.attribute(name);
  if (!attribute) return otherwise;
  const std::string_view text = attribute.value();
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (error != std::errc() || !(unit.empty() || unit == "px") || !std::isfinite(value))
    throw InputError(fmt::format("{}=\"{}\": a number of pixels is right", name, quotable(text)));
  return value;
}

/// A length in pixels, 96 to the inch as CSS has it; nothing for shares of the page or where there is none.
std::optional<double> pixel_length(const pugi::xml_node& node, const char* name) {
  const std::string_view text = node.attribute(name).value();
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (text.empty() || unit == "%") return std::nullopt;
  constexpr double inch = 96;
  for (const auto& [known, pixels] : {std::pair<std::string_view, double>{"", 1},
                                      {"px", 1},
                                      {"mm", inch / 25.4},
                                      {"cm", inch / 2.54},
                                      {"in", inch},
                                      {"pt", inch / 72},
                                      {"pc", inch / 6}})
    if (error == std::errc() && unit == known && value > 0 && std::isfinite(value)) return value * pixels;
  throw InputError(
      fmt::format("{}=\"{}\": a positive length in px, mm, cm, in, pt or pc is right", name, quotable(text)));
}

/// What makes pixels of the drawing's units: the viewBox fills width and height, in the middle and as large
/// as both allow (SVG 1.1, section 7.8). Without these a unit is a pixel.
SvgTransform pixels_of(const pugi::xml_node& root) {
  const std::optional<double> width = pixel_length(root, "width"), height = pixel_length(root, "height");
  const std::string box = root.attribute("viewBox").value();
  if (box.empty() || (!width && !height)) return {};
  double x = 0, y = 0, w = 0, h = 0;
  std::string plain = box;
  std::replace(plain.begin(), plain.end(), ',', ' ');
  char end = 0;
  if (std::sscanf(plain.c_str(), "%lf %lf %lf %lf %c", &x, &y, &w, &h, &end) != 4 || !(w > 0 && h > 0) ||
      !std::isfinite(x + y + w + h))
    throw InputError(
        fmt::format("viewBox=\"{}\": four numbers, the last two positive, are right", quotable(box)));
  const double across = width ? *width / w : HUGE_VAL, down = height ? *height / h : HUGE_VAL;
  const double scale = std::min(across, down);
  SvgTransform transform;
  transform.a = transform.d = scale;
  transform.e = -x * scale + (width ? 0.5 * (*width - w * scale) : 0);
  transform.f = -y * scale + (height ? 0.5 * (*height - h * scale) : 0);
  return transform;
}

/// The path data that says the same as a basic shape; empty for what is no shape.
std::string path_data(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  if (name == "path") return node.attribute("d").value();
  if (name == "polygon") return fmt::format("M {} Z", node.attribute("points").value());
  if (name == "rect") {
    const double w = number(node, "width", 0), h = number(node, "height", 0);
    // A radius that is not given is the other one; neither is more than half a side (SVG 1.1, section 9.2).
    double rx = number(node, "rx", number(node, "ry", 0)), ry = number(node, "ry", rx);
    rx = std::min(rx, w / 2), ry = std::min(ry, h / 2);
    if (rx > 0 && ry > 0) {
      const std::string arc = fmt::format("a {} {} 0 0 1", rx, ry);
      return fmt::format("M {} {} h {} {} {} {} v {} {} {} {} h {} {} {} {} v {} {} {} {} Z",
                         number(node, "x", 0) + rx, number(node, "y", 0), w - 2 * rx, arc, rx, ry, h - 2 * ry,
                         arc, -rx, ry, 2 * rx - w, arc, -rx, -ry, 2 * ry - h, arc, rx, -ry);
    }
    return fmt::format("M {} {} h {} v {} h {} Z", number(node, "x", 0), number(node, "y", 0), w, h, -w);
  }
  if (name == "circle" || name == "ellipse") {
    const double rx = number(node, name == "circle" ? "r" : "rx", 0),
                 ry = number(node, name == "circle" ? "r" : "ry", 0);
    return fmt::format("M {} {} a {} {} 0 0 1 {} 0 a {} {} 0 0 1 {} 0 Z", number(node, "cx", 0) - rx,
                       number(node, "cy", 0), rx, ry, 2 * rx, rx, ry, -2 * rx);
  }
  return {};
}

class Drawing {
 public:
  Drawing(TargetScene& scene, SvgStyleSheet sheet) : scene_(scene), sheet_(std::move(sheet)) {}

  void walk(const pugi::xml_node& node, Style style, int depth) {
    constexpr int deepest = 200;
    const std::string name = node.name();
    try {
      if (depth > deepest) throw InputError("groups nested too deeply");
      if (const std::string fill = styled(node, "fill"); !fill.empty()) style.fill = fill;
      if (const std::string rule = styled(node, "fill-rule"); !rule.empty()) style.fill_rule = rule;
      if (node.attribute("transform"))
        style.transform = style.transform * parse_svg_transform(node.attribute("transform").value());
      if (name == "text" || name == "image" || name == "use" || name == "line" || name == "polyline")
        throw InputError(
            "only filled shapes are read: path, polygon, rect, circle, ellipse; convert it to a path");
      const std::string stroke = styled(node, "stroke");
      if (!stroke.empty() && stroke != "none")
        throw InputError("strokes are not read; convert them to paths");
      add(path_data(node), style);
    } catch (const InputError& error) {
      throw InputError(scene_.source, fmt::format("<{}>{}: {}", name, id_of(node), error.what()));
    }
    for (const pugi::xml_node& child : node.children())
      if (child.type() == pugi::node_element && !is_silent(child.name())) walk(child, style, depth + 1);
  }

 private:
  static std::string id_of(const pugi::xml_node& node) {
    const std::string id = node.attribute("id").value();
    return id.empty() ? "" : " '" + id.substr(0, 40) + "'";
  }
  static bool is_silent(std::string_view name) {
    return name == "defs" || name == "style" || name == "title" || name == "desc" || name == "metadata" ||
           name.find(':') != std::string_view::npos;
  }

  void add(const std::string& data, const Style& style) {
    const std::optional<double> level = data.empty() ? std::nullopt : level_of(style.fill);
    if (!level) return;
    Polygon polygon{parse_svg_path(data, style.transform), *level, 0};
    if (polygon.contours.empty()) throw InputError("it encloses nothing");
    const FillRule rule = style.fill_rule == "evenodd" ? FillRule::evenodd : FillRule::nonzero;
    const bool resolved =
        (rule == FillRule::nonzero && polygon.contours.size() > 1) || find_crossing(polygon);
    if (!resolved) return scene_.polygons.push_back(std::move(polygon));
    for (std::vector<Contour>& part : simple_parts(polygon.contours, rule))
      scene_.polygons.push_back({std::move(part), *level, 0});
  }

  /// style="…" counts more than the style sheet, and that more than attributes.
  std::string styled(const pugi::xml_node& node, const char* name) const {
    if (const std::string own = declared(node.attribute("style").value(), name); !own.empty()) return own;
    if (const std::string rule =
            sheet_.property(node.name(), node.attribute("id").value(), node.attribute("class").value(), name);
        !rule.empty())
      return rule;
    return node.attribute(name).value();
  }

  TargetScene& scene_;
  SvgStyleSheet sheet_;
};

}  // namespace

TargetScene parse_svg_shapes(const std::string& text, const std::string& name) {
  TargetScene scene;
  scene.source = name;
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
  if (!result)
    throw InputError(name, fmt::format("no sound XML: {} at byte {}", result.description(), result.offset));
  const pugi::xml_node root = document.document_element();
  if (std::string_view(root.name()) != "svg") throw InputError(name, "no SVG drawing: its root is not <svg>");
  Style style;
  SvgStyleSheet sheet;
  try {
    style.transform = pixels_of(root);
    for (const pugi::xpath_node& each : root.select_nodes("//*[local-name()='style']"))
      sheet.add(each.node().text().get());
  } catch (const InputError& error) {
    throw InputError(name, error.what());
  }
  Drawing(scene, std::move(sheet)).walk(root, style, 0);
  if (scene.polygons.empty()) throw InputError(name, "no filled shape in it");
  return scene;
}

TargetScene read_svg_shapes(const std::string& path) {
  return parse_svg_shapes(read_whole_file(path, std::size_t{1} << 28), path);
}

}  // namespace petzval
