// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/report/xml.h>

#include <cmath>
#include <limits>
#include <random>

#include "report/markup_checker.h"

namespace petzval {
namespace {

using test::markup_fault;

// The checker that the other tests lean on must itself find faults.
TEST(MarkupChecker, FindsWhatIsWrong) {
  EXPECT_EQ(markup_fault("<a><b x=\"1\"/>t &amp; u</a>"), "");
  for (const char* broken :
       {"<a>", "<a></b>", "</a>", "<a>x & y</a>", "<a>1 < 2</a>", "<a b=c></a>", "<a b=\"<\"/>",
        "<a b=\"1\" b=\"2\"/>", "<a/><b/>", "<a/>text", "<a>\x01</a>", "<a>&nbsp;</a>", ""})
    EXPECT_NE(markup_fault(broken), "") << broken;
  EXPECT_EQ(
      markup_fault("<!DOCTYPE html><html><meta x=\"1\"><style>a>b{}</style></html>", test::Markup::html), "");
}

TEST(XmlEscape, TurnsMarkupIntoEntities) {
  EXPECT_EQ(xml_escape("a < b & \"c\" > 'd'"), "a &lt; b &amp; &quot;c&quot; &gt; &#39;d&#39;");
  EXPECT_EQ(xml_escape("λ = 587.6 nm, 6 µm, f′ → ∞ 𝛌"), "λ = 587.6 nm, 6 µm, f′ → ∞ 𝛌");
  EXPECT_EQ(xml_escape(""), "");
}

TEST(XmlEscape, ReplacesWhatXmlForbids) {
  const std::string u = "\xEF\xBF\xBD";
  EXPECT_EQ(xml_escape(std::string_view("a\0b\x1f\x7f", 5)), "a" + u + "b" + u + u);
  EXPECT_EQ(xml_escape("\xff\xfe"), u + u);
  EXPECT_EQ(xml_escape("\xc3"), u);                          // truncated
  EXPECT_EQ(xml_escape("\xc0\xaf"), u + u);                  // overlong '/'
  EXPECT_EQ(xml_escape("\xed\xa0\x80"), u + u + u);          // a surrogate
  EXPECT_EQ(xml_escape("\xf4\x90\x80\x80"), u + u + u + u);  // beyond U+10FFFF
  EXPECT_EQ(xml_escape("\xef\xbf\xbf"), u);                  // U+FFFF is not a character
}

TEST(SvgNumber, IsShortAndFinite) {
  EXPECT_EQ(svg_number(12.5), "12.5");
  EXPECT_EQ(svg_number(-3), "-3");
  EXPECT_EQ(svg_number(100), "100");
  EXPECT_EQ(svg_number(-0.001), "0");
  EXPECT_EQ(svg_number(0.005 + 1e-9), "0.01");
  EXPECT_EQ(svg_number(std::nan("")), "0");
  EXPECT_EQ(svg_number(std::numeric_limits<double>::infinity()), "1000000");
  EXPECT_EQ(svg_number(-1e300), "-1000000");
}

TEST(CharacterCount, CountsCodePoints) {
  EXPECT_EQ(character_count("µm"), 2u);
  EXPECT_EQ(character_count("10⁻⁵"), 4u);
}

TEST(XmlWriter, ClosesWhatItOpensAndEscapes) {
  XmlWriter xml;
  xml.open("svg", {{"a", "1 < 2"}})
      .open("g")
      .leaf("line", {{"x", 1.5}, {"omitted", ""}})
      .text("text", {}, "\"<&>\"");
  const std::string out = std::move(xml).finish();
  EXPECT_EQ(markup_fault(out), "");
  EXPECT_EQ(out.find("omitted"), std::string::npos);
  EXPECT_NE(out.find("<line x=\"1.5\"/>"), std::string::npos);
}

// Any bytes in texts and attributes leave the document well-formed.
TEST(XmlWriter, StandsAnyBytes) {
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    std::string bytes(random() % 40, ' ');
    for (char& c : bytes) c = static_cast<char>(random());
    XmlWriter xml;
    xml.open("svg").text("text", {{"title", bytes}}, bytes).close().close();
    EXPECT_EQ(markup_fault(std::move(xml).finish()), "");
  }
}

}  // namespace
}  // namespace petzval
