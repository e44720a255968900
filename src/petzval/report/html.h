// SPDX-License-Identifier: BSD-3-Clause
// One HTML page that opens anywhere, without a network: reports and the demonstration.
#pragma once

#include <petzval/report/table.h>

#include <string>
#include <string_view>
#include <vector>

namespace petzval::html {

/// A piece of a page, made by the functions below; already markup.
struct Block {
  std::string markup;
};

/// A raster image, inside the page or in a file beside it.
struct Image {
  std::string source;       ///< data URI or relative URL
  std::string description;  ///< for those who cannot see it
  int columns = 0, rows = 0;
  bool pixelated = false;  ///< show pixels as squares when enlarged
};

/// An image within the page. \throws InputError if the bytes are not a PNG.
Image embedded_image(std::string_view png, std::string description);
/// An image in a file, named relative to the page. \throws InputError for an absolute path or a URL.
Image linked_image(std::string_view relative_path, std::string description);

/// Text in which `code`, **strong** and [text](https://address) are marked as in Markdown; everything else is
/// taken literally. This is how all texts of a page are read.
std::string inline_markup(std::string_view text);

Block paragraph(std::string_view text);
/// \param svg  as Plot::svg(), draw_lens() and image_strip_svg() make it.
Block drawing(std::string_view svg);
Block picture(const Image& image);
/// A drawing, picture or table with its caption beneath.
Block figure(const Block& content, std::string_view caption);
/// A link that saves `bytes` as a file: the data behind a plot. Not on paper. \param label  "data (CSV)".
Block download(std::string_view file_name, std::string_view mime, std::string_view bytes,
               std::string_view label);
/// Blocks in a row of equal columns; one below the other on a narrow screen.
Block side_by_side(const std::vector<Block>& blocks);
/// Two images of one size on top of each other with a handle to draw across; side by side on paper.
Block before_after(const Image& before, const Image& after, std::string_view before_label,
                   std::string_view after_label);
/// \throws InputError as Table::validate.
Block table(const Table& table);

/// A name and what belongs to it: "focal length", "6.000", "mm".
struct Fact {
  std::string name, value, unit{};
};
/// Lines as they are, in letters of one width: commands.
Block listing(std::string_view text);
Block facts(const std::vector<Fact>& list);

/// A quantity as somebody else reports it and as it is computed here.
struct Comparison {
  std::string quantity, reported, computed, remark{};
};
Block comparison(const std::vector<Comparison>& rows, std::string_view reported_by,
                 std::string_view computed_by);

/// A page of sections, with a list of contents:
///
///     html::Page page("edmund-54852", "Report of 1 May");
///     page.section("Layout").add(html::figure(html::drawing(draw_lens(lens, rays)), "Rays at 0°, 14° and
///     20°.")); write_whole_file("report.html", page.html());
class Page {
 public:
  explicit Page(std::string title, std::string subtitle = {});
  /// Begins a section; `contents` is its short name in the list of contents (absent: the title).
  Page& section(std::string title, std::string contents = {});
  /// Adds to the section begun last (before the first: to the top of the page).
  Page& add(const Block& block);
  /// A line at the end of the page: program, version, options.
  Page& footer(std::string text);
  /// To be printed on one sheet of A4: smaller letters, two columns, figures no higher than they must be.
  Page& one_sheet();
  std::string html() const;

 private:
  struct Section {
    std::string title, contents, markup;
  };
  std::string title_, subtitle_, lead_, footer_;
  std::vector<Section> sections_;
  bool one_sheet_ = false;
};

}  // namespace petzval::html
