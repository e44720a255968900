// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/report/heat_map.h>
#include <petzval/report/html.h>
#include <petzval/report/svg_plot.h>

#include "report/markup_checker.h"

namespace petzval {
namespace {

using test::Markup;
using test::markup_fault;
using test::occurrences;

std::string small_png() {
  return heat_map_png(std::vector<float>{1, 2, 3, 4}, 2, 2);
}

html::Page full_page() {
  Plot plot;
  plot.title = "plot";
  plot.line("a", {0, 1}, {0, 1});
  const html::Image image = html::embedded_image(small_png(), "a \"square\"");
  html::Page page("Lens <report>", "of `edmund-54852` & others");
  page.add(html::paragraph("Top of the page, see [the paper](https://doi.org/10.1117/12.588153)."));
  page.section("Figure 5", "Layout").add(html::figure(html::drawing(plot.svg()), "**bold** caption < 5"));
  page.section("Figures 10 and 11").add(html::before_after(image, image, "ideal", "through the lens"));
  page.add(
      html::side_by_side({html::picture(image), html::picture(html::linked_image("out/a b.png", "linked"))}));
  page.section("Numbers").add(
      html::table({{{"field", "deg", 1}, {"note", ""}}, {{14.0, std::string("a|b")}}}));
  page.add(html::facts({{"focal length", "6.000", "mm"}}));
  page.add(
      html::comparison({{"distortion", "roughly −10 %", "−8.40 %", "at 3 mm"}}, "paper (2005)", "Petzval"));
  page.footer("petzval 0.1.0");
  return page;
}

TEST(HtmlPage, IsWellFormed) {
  EXPECT_EQ(markup_fault(full_page().html(), Markup::html), "");
  EXPECT_EQ(markup_fault(html::Page("empty").html(), Markup::html), "");
  EXPECT_EQ(full_page().html(), full_page().html());
}

TEST(HtmlPage, LoadsNothingFromTheNet) {
  const std::string page = full_page().html();
  int count = 0;
  for (const char* tag : {"img", "image", "script", "link", "iframe", "source", "object", "embed"})
    for (const test::Element& element : test::elements(page, tag))
      for (const char* name : {"src", "href", "data"})
        if (const auto found = element.attributes.find(name); found != element.attributes.end()) {
          const std::string& address = found->second;
          EXPECT_TRUE(address.rfind("data:image/png;base64,", 0) == 0 || address == "out/a%20b.png")
              << address;
          ++count;
        }
  EXPECT_EQ(count, 4);
  for (const char* way_out : {"<script", "<link", "@import", "url(", "<iframe", "fetch("})
    EXPECT_EQ(page.find(way_out), std::string::npos) << way_out;
}

TEST(HtmlPage, ListsItsSections) {
  const std::string page = full_page().html();
  EXPECT_NE(page.find("<a href=\"#s1\">Layout</a>"), std::string::npos);
  EXPECT_NE(page.find("<section id=\"s3\">\n<h2>Numbers</h2>"), std::string::npos);
  EXPECT_NE(page.find("<title>Lens &lt;report&gt;</title>"), std::string::npos);
}

TEST(HtmlPage, ShowsNumbersWithUnits) {
  const std::string page = full_page().html();
  EXPECT_NE(page.find("<th class=\"number\">field <span class=\"unit\">deg</span></th>"), std::string::npos);
  EXPECT_NE(page.find("<td class=\"number\">14.0</td>"), std::string::npos);
  EXPECT_NE(page.find("<dt>focal length</dt><dd>6.000 <span class=\"unit\">mm</span></dd>"),
            std::string::npos);
  EXPECT_NE(page.find("<td>roughly −10 %</td><td>−8.40 %</td>"), std::string::npos);
}

TEST(InlineMarkup, KnowsThreeMarksAndNothingElse) {
  EXPECT_EQ(html::inline_markup("a `b<c` d"), "a <code>b&lt;c</code> d");
  EXPECT_EQ(html::inline_markup("**x** y"), "<strong>x</strong> y");
  EXPECT_EQ(html::inline_markup("[t](https://a.b/?x=1&y=2)"), "<a href=\"https://a.b/?x=1&amp;y=2\">t</a>");
  EXPECT_EQ(html::inline_markup("[a] (b) `open ** [c"), "[a] (b) `open ** [c");
  EXPECT_EQ(html::inline_markup("range [0, 1] then [t](u.html)"),
            "range [0, 1] then <a href=\"u.html\">t</a>");
  EXPECT_EQ(html::inline_markup("<b>no</b>"), "&lt;b&gt;no&lt;/b&gt;");
  EXPECT_EQ(html::inline_markup("``"), "``");
  EXPECT_EQ(html::inline_markup(""), "");
}

TEST(InlineMarkup, MakesNoLinkThatRunsCode) {
  for (const char* text : {"[x](javascript:alert(1))", "[x](data:text/html,y)", "[x](JaVaScRiPt:y)"})
    EXPECT_EQ(html::inline_markup(text).find("<a"), std::string::npos) << text;
}

TEST(Images, AreEmbeddedOrBesideThePage) {
  const html::Image image = html::embedded_image(small_png(), "d");
  EXPECT_EQ(image.columns, 2);
  EXPECT_EQ(image.rows, 2);
  EXPECT_THROW(html::embedded_image("not a png", "d"), InputError);
  for (const char* path : {"", "/etc/a.png", "https://a.b/c.png", "file:a.png"})
    EXPECT_THROW(html::linked_image(path, "d"), InputError) << path;
}

TEST(Tables, RefuseRaggedRows) {
  EXPECT_THROW(html::table({{{"a", ""}}, {{1.0, 2.0}}}), InputError);
  EXPECT_EQ(markup_fault(html::table({{{"a", ""}}, {}}).markup, Markup::html), "");
}

}  // namespace
}  // namespace petzval
