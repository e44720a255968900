// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/report/data_uri.h>
#include <petzval/report/html.h>
#include <petzval/report/html_style.h>
#include <petzval/report/xml.h>

#include <cctype>
#include <cstdint>

namespace petzval::html {

namespace {

/// Addresses that a reader may be sent to: the web, or a place beside or within the page.
bool is_harmless_link(std::string_view address) {
  const std::size_t colon = address.find(':');
  return colon == std::string_view::npos || address.substr(0, colon) == "https" ||
         address.substr(0, colon) == "http";
}

/// A span that begins and ends with `mark`; if `text` starts with one, its length and content.
struct Marked {
  std::size_t length = 0;
  std::string_view content;
};

Marked marked_span(std::string_view text, std::string_view mark) {
  if (text.substr(0, mark.size()) != mark) return {};
  const std::size_t end = text.find(mark, mark.size());
  if (end == std::string_view::npos || end == mark.size()) return {};
  return {end + mark.size(), text.substr(mark.size(), end - mark.size())};
}

struct Link {
  std::size_t length = 0;
  std::string_view content, address;
};

Link link_at(std::string_view text) {
  if (text[0] != '[') return {};
  const std::size_t middle = text.find("](");
  const std::size_t end = middle == std::string_view::npos ? middle : text.find(')', middle);
  if (end == std::string_view::npos || text.substr(0, middle).find('[', 1) != std::string_view::npos)
    return {};
  return {end + 1, text.substr(1, middle - 1), text.substr(middle + 2, end - middle - 2)};
}

std::string percent_encoded(std::string_view path) {
  constexpr std::string_view kept = "-._~/";
  std::string out;
  for (const char c : path) {
    const auto byte = static_cast<std::uint8_t>(c);
    const bool keep = (byte < 0x80 && std::isalnum(byte) != 0) || kept.find(c) != std::string_view::npos;
    out += keep ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return out;
}

std::string image_tag(const Image& image) {
  const std::string size =
      image.columns > 0 ? fmt::format(" width=\"{}\" height=\"{}\"", image.columns, image.rows) : "";
  return fmt::format("<img src=\"{}\" alt=\"{}\"{}{}>", xml_escape(image.source),
                     xml_escape(image.description), size, image.pixelated ? " class=\"pixelated\"" : "");
}

std::string with_unit(std::string_view text, std::string_view unit) {
  const std::string name = inline_markup(text);
  return unit.empty() ? name : fmt::format("{} <span class=\"unit\">{}</span>", name, xml_escape(unit));
}

}  // namespace

Image embedded_image(std::string_view png, std::string description) {
  const PixelSize size = png_size(png);
  return {data_uri("image/png", png), std::move(description), size.columns, size.rows, false};
}

Image linked_image(std::string_view relative_path, std::string description) {
  if (relative_path.empty() || relative_path[0] == '/' || relative_path.find(':') != std::string_view::npos)
    throw InputError(std::string(relative_path),
                     "a picture of a page must be a file named relative to the page");
  return {percent_encoded(relative_path), std::move(description), 0, 0, false};
}

std::string inline_markup(std::string_view text) {
  std::string out;
  std::size_t plain = 0;  // how many characters at the start of `text` are not markup
  const auto take = [&](std::size_t marked_length, const std::string& markup) {
    out += xml_escape(text.substr(0, plain)) + markup;
    text.remove_prefix(plain + marked_length);
    plain = 0;
  };
  while (plain < text.size()) {
    const std::string_view rest = text.substr(plain);
    if (const Marked code = marked_span(rest, "`"); code.length > 0) {
      take(code.length, "<code>" + xml_escape(code.content) + "</code>");
    } else if (const Marked strong = marked_span(rest, "**"); strong.length > 0) {
      take(strong.length, "<strong>" + xml_escape(strong.content) + "</strong>");
    } else if (const Link link = link_at(rest); link.length > 0 && is_harmless_link(link.address)) {
      take(link.length,
           fmt::format("<a href=\"{}\">{}</a>", xml_escape(link.address), xml_escape(link.content)));
    } else {
      ++plain;
    }
  }
  return out + xml_escape(text);
}

Block paragraph(std::string_view text) {
  return {"<p>" + inline_markup(text) + "</p>\n"};
}

Block drawing(std::string_view svg) {
  if (svg.substr(0, 5) == "<?xml") svg.remove_prefix(std::min(svg.find('\n'), svg.size()));
  return {std::string(svg)};
}

Block picture(const Image& image) {
  return {image_tag(image) + "\n"};
}

Block figure(const Block& content, std::string_view caption) {
  return {fmt::format("<figure>\n{}<figcaption>{}</figcaption>\n</figure>\n", content.markup,
                      inline_markup(caption))};
}

Block download(std::string_view file_name, std::string_view mime, std::string_view bytes,
               std::string_view label) {
  return {fmt::format("<p class=\"download\"><a download=\"{}\" href=\"{}\">{}</a></p>\n",
                      xml_escape(file_name), data_uri(mime, bytes), xml_escape(label))};
}

Block side_by_side(const std::vector<Block>& blocks) {
  std::string markup = "<div class=\"row\">\n";
  for (const Block& block : blocks) markup += "<div>\n" + block.markup + "</div>\n";
  return {markup + "</div>\n"};
}

Block before_after(const Image& before, const Image& after, std::string_view before_label,
                   std::string_view after_label) {
  return {fmt::format(
      "<div class=\"wipe\">{}{}<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" step=\"0.1\" "
      "aria-label=\"{} to {}\" oninput=\"this.parentNode.style.setProperty('--at',this.value+'%')\">"
      "<i></i><b>{}</b><b>{}</b></div>\n",
      image_tag(before), image_tag(after), xml_escape(before_label), xml_escape(after_label),
      xml_escape(before_label), xml_escape(after_label))};
}

Block table(const Table& table) {
  table.validate();
  std::string markup = "<div class=\"scroll\"><table>\n<thead><tr>";
  const auto is_number = [&](std::size_t column) {
    return !table.rows.empty() && std::holds_alternative<double>(table.rows[0][column]);
  };
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    if (!table.columns[i].name.empty()) shown.push_back(i);
  for (const std::size_t i : shown)
    markup += fmt::format("<th{}>{}</th>", is_number(i) ? " class=\"number\"" : "",
                          with_unit(table.columns[i].name, table.columns[i].unit));
  markup += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    markup += "<tr>";
    for (const std::size_t i : shown)
      markup += fmt::format("<td{}>{}</td>", is_number(i) ? " class=\"number\"" : "",
                            inline_markup(cell_text(row[i], table.columns[i].decimals)));
    markup += "</tr>\n";
  }
  return {markup + "</tbody>\n</table></div>\n"};
}

Block listing(std::string_view text) {
  return {fmt::format("<pre>{}</pre>\n", xml_escape(text))};
}

Block facts(const std::vector<Fact>& list) {
  std::string markup = "<dl>\n";
  for (const Fact& fact : list)
    markup +=
        fmt::format("<dt>{}</dt><dd>{}</dd>\n", inline_markup(fact.name), with_unit(fact.value, fact.unit));
  return {markup + "</dl>\n"};
}

Block comparison(const std::vector<Comparison>& rows, std::string_view reported_by,
                 std::string_view computed_by) {
  std::string markup = fmt::format(
      "<div class=\"scroll\"><table class=\"comparison\">\n<thead><tr><th>quantity</th><th>{}</th><th>{}</th>"
      "<th>remark</th></tr></thead>\n<tbody>\n",
      inline_markup(reported_by), inline_markup(computed_by));
  for (const Comparison& row : rows)
    markup +=
        fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", inline_markup(row.quantity),
                    inline_markup(row.reported), inline_markup(row.computed), inline_markup(row.remark));
  return {markup + "</tbody>\n</table></div>\n"};
}

Page::Page(std::string title, std::string subtitle)
    : title_(std::move(title)), subtitle_(std::move(subtitle)) {}

Page& Page::section(std::string title, std::string contents) {
  if (contents.empty()) contents = title;
  sections_.push_back({std::move(title), std::move(contents), {}});
  return *this;
}

Page& Page::add(const Block& block) {
  (sections_.empty() ? lead_ : sections_.back().markup) += block.markup;
  return *this;
}

Page& Page::footer(std::string text) {
  footer_ = std::move(text);
  return *this;
}

Page& Page::one_sheet() {
  one_sheet_ = true;
  return *this;
}

std::string Page::html() const {
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n"
      "<style>{}</style>\n</head>\n<body{}>\n<header>\n<h1>{}</h1>\n",
      xml_escape(title_), page_style, one_sheet_ ? " class=\"sheet\"" : "", inline_markup(title_));
  if (!subtitle_.empty()) out += "<p>" + inline_markup(subtitle_) + "</p>\n";
  out += "</header>\n";
  if (sections_.size() > 1 && !one_sheet_) {
    out += "<nav aria-label=\"Contents\">\n";
    for (std::size_t i = 0; i < sections_.size(); ++i)
      out += fmt::format("<a href=\"#s{}\">{}</a>\n", i + 1, inline_markup(sections_[i].contents));
    out += "</nav>\n";
  }
  if (!lead_.empty()) out += "<main>\n" + lead_ + "</main>\n";
  for (std::size_t i = 0; i < sections_.size(); ++i)
    out += fmt::format("<section id=\"s{}\">\n<h2>{}</h2>\n{}</section>\n", i + 1,
                       inline_markup(sections_[i].title), sections_[i].markup);
  if (!footer_.empty()) out += "<footer>" + inline_markup(footer_) + "</footer>\n";
  return out + "</body>\n</html>\n";
}

}  // namespace petzval::html
