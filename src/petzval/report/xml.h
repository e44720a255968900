// SPDX-License-Identifier: BSD-3-Clause
// Well-formed XML, for the drawings and pages of a report.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace petzval {

/// Text made safe for element content and for attributes in double quotes: & < > " ' become entities,
/// characters that XML 1.0 forbids and bytes that are not UTF-8 become U+FFFD.
std::string xml_escape(std::string_view text);

/// A coordinate as text: at most two decimals, no trailing zeros, never an exponent: "12.5", "-3", "0".
/// A drawing holds finite numbers only: NaN becomes 0, and anything beyond ±10⁶ becomes ±10⁶ (out of any
/// picture).
std::string svg_number(double value);

/// Number of characters (code points) in UTF-8 text.
std::size_t character_count(std::string_view text);

/// An attribute: its value is text (escaped when written) or a coordinate.
struct XmlAttribute {
  std::string name, value;
  XmlAttribute(std::string_view attribute, std::string_view text) : name(attribute), value(text) {}
  XmlAttribute(std::string_view attribute, const char* text) : name(attribute), value(text) {}
  XmlAttribute(std::string_view attribute, const std::string& text) : name(attribute), value(text) {}
  XmlAttribute(std::string_view attribute, double number) : name(attribute), value(svg_number(number)) {}
};

/// Writes elements so that the result is well-formed whatever the text in it:
///
///     XmlWriter xml;
///     xml.open("g", {{"class", "axis"}}).leaf("line", {{"x2", 10.0}}).text("text", {{"x", 5.0}}, "a <
///     b").close(); std::string out = std::move(xml).finish();
///
/// Attributes whose value is empty are left out.
class XmlWriter {
 public:
  using Attributes = std::initializer_list<XmlAttribute>;
  XmlWriter& open(std::string_view tag, Attributes attributes = {});
  /// Closes the innermost open element; nothing when none is open.
  XmlWriter& close();
  /// An element without content.
  XmlWriter& leaf(std::string_view tag, Attributes attributes = {});
  /// An element that holds text only.
  XmlWriter& text(std::string_view tag, Attributes attributes, std::string_view content);
  /// All that was written; elements still open are closed.
  std::string finish() &&;

 private:
  void begin(std::string_view tag, Attributes attributes);
  std::string out_;
  std::vector<std::string> open_;
};

/// Opens the root element of a drawing of this size: viewBox, a size that shrinks with the page, the style
/// sheet that all drawings share (light and dark), and the paper. \param description  for those who cannot
/// see it.
void open_svg(XmlWriter& xml, double width_px, double height_px, std::string_view description);

}  // namespace petzval
