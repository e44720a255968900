// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/report/xml.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace petzval {

namespace {

constexpr std::string_view replacement_character = "\xEF\xBF\xBD";

/// Length of the well-formed UTF-8 sequence at the start of `text` (Unicode 15, table 3-7), 0 if there is
/// none.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xC2 && lead < 0xE0   ? 2
                             : (lead & 0xF0) == 0xE0       ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  const bool overlong = (lead == 0xE0 && byte(1) < 0xA0) || (lead == 0xF0 && byte(1) < 0x90);
  const bool surrogate = lead == 0xED && byte(1) >= 0xA0;
  const bool beyond = lead == 0xF4 && byte(1) >= 0x90;
  return overlong || surrogate || beyond ? 0 : length;
}

void append_escaped(std::string& out, std::string_view sequence) {
  const char c = sequence[0];
  if (c == '&')
    out += "&amp;";
  else if (c == '<')
    out += "&lt;";
  else if (c == '>')
    out += "&gt;";
  else if (c == '"')
    out += "&quot;";
  else if (c == '\'')
    out += "&#39;";
  else if ((static_cast<std::uint8_t>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7F ||
           sequence == "\xEF\xBF\xBE" || sequence == "\xEF\xBF\xBF")  // U+FFFE, U+FFFF
    out += replacement_character;
  else
    out += sequence;
}

/// Ink, paper and lines by class, so that one drawing serves a light page, a dark page and a printer. No ids
/// and no clip paths: several drawings can stand in one page.
constexpr std::string_view style =
    ".pz-paper{fill:#fff}.pz-ink{fill:#1f2328}.pz-soft{fill:#59636e}.pz-line{stroke:#1f2328;fill:none}"
    ".pz-frame{stroke:#8c959f;fill:none}.pz-grid{stroke:#e4e7eb;fill:none}.pz-glass{fill:#b9d7f0;fill-"
    "opacity:.62;"
    "stroke:#2f5d86}.pz-note{paint-order:stroke;stroke:#fff;stroke-width:3px;stroke-linejoin:round}"
    "@media screen and (prefers-color-scheme:dark){.pz-paper{fill:#15181d}.pz-ink{fill:#e6e9ee}"
    ".pz-soft{fill:#9aa4b0}.pz-line{stroke:#e6e9ee}.pz-frame{stroke:#6b7580}.pz-grid{stroke:#2a2f37}"
    ".pz-glass{fill:#3b6c99;fill-opacity:.5;stroke:#9cc4e8}.pz-note{stroke:#15181d}.pz-data{filter:"
    "brightness(1.35)}}";

}  // namespace

std::string xml_escape(std::string_view text) {
  std::string out;
  out.reserve(text.size() + text.size() / 8);
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    if (length == 0)
      out += replacement_character;
    else
      append_escaped(out, text.substr(0, length));
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

std::string svg_number(double value) {
  constexpr double limit = 1e6;
  if (std::isnan(value)) value = 0;
  std::string text = fmt::format("{:.2f}", std::clamp(value, -limit, limit));
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::size_t character_count(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<std::uint8_t>(c) & 0xC0) != 0x80; }));
}

void XmlWriter::begin(std::string_view tag, Attributes attributes) {
  out_ += '<';
  out_ += tag;
  for (const XmlAttribute& attribute : attributes)
    if (!attribute.value.empty())
      out_ += fmt::format(" {}=\"{}\"", attribute.name, xml_escape(attribute.value));
}

XmlWriter& XmlWriter::open(std::string_view tag, Attributes attributes) {
  begin(tag, attributes);
  out_ += ">\n";
  open_.emplace_back(tag);
  return *this;
}

XmlWriter& XmlWriter::close() {
  if (open_.empty()) return *this;
  out_ += "</" + open_.back() + ">\n";
  open_.pop_back();
  return *this;
}

XmlWriter& XmlWriter::leaf(std::string_view tag, Attributes attributes) {
  begin(tag, attributes);
  out_ += "/>\n";
  return *this;
}

XmlWriter& XmlWriter::text(std::string_view tag, Attributes attributes, std::string_view content) {
  begin(tag, attributes);
  out_ += fmt::format(">{}</{}>\n", xml_escape(content), tag);
  return *this;
}

std::string XmlWriter::finish() && {
  while (!open_.empty()) close();
  return std::move(out_);
}

void open_svg(XmlWriter& xml, double width_px, double height_px, std::string_view description) {
  xml.open("svg",
           {{"xmlns", "http://www.w3.org/2000/svg"},
            {"width", width_px},
            {"height", height_px},
            {"viewBox", fmt::format("0 0 {} {}", svg_number(width_px), svg_number(height_px))},
            {"role", "img"},
            {"aria-label", description},
            {"font-family", "system-ui, 'Segoe UI', 'Helvetica Neue', Arial, 'DejaVu Sans', sans-serif"},
            {"font-size", 12.0}});
  xml.text("style", {}, style);
  xml.leaf("rect", {{"class", "pz-paper"}, {"width", width_px}, {"height", height_px}});
}

}  // namespace petzval
