// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/lens/formats/zmx_keywords.h>

#include <algorithm>
#include <map>
#include <set>

namespace petzval {

namespace {

enum class Role {
  known,                ///< read by zmx_reader.cpp, or of no consequence for rays
  vignetting_factor,    ///< stands in for real clear apertures, which we trace: a note unless zero
  refused,              ///< changes rays, not modelled
  refused_unless_zero,  ///< the same, but all zeros say that it is not used
};

struct Keyword {
  Role role;
  const char* meaning = "";
};

using Keywords = std::map<std::string, Keyword, std::less<>>;

void add(Keywords& keywords, Role role, std::initializer_list<const char*> names, const char* meaning = "") {
  for (const char* name : names) keywords[name] = {role, meaning};
}

const Keywords& header_keywords() {
  static const Keywords table = [] {
    Keywords k;
    add(k, Role::known,
        {"MODE", "NAME", "UNIT", "ENPD", "FNUM", "OBNA", "FLOA", "ENVD", "GCAT", "FTYP", "XFLN", "YFLN",
         "XFLD", "YFLD", "WAVM", "WAVL", "WAVN", "PWAV"});
    // Names and notes; weights of fields and wavelengths; how a program searches, draws and evaluates.
    add(k, Role::known,
        {"VERS", "NOTE", "AUTH", "IWDP", "TITL", "LANG", "LUID", "EERA", "DBDT", "RCMF", "BLNK",
         "FWGN", "FWGT", "WWGT", "WWGN", "PUPD", "GFAC", "RAIM", "PUSH", "SDMA", "OMMA", "ROPD",
         "HYPR", "PICB", "POLS", "GLRS", "GSTD", "NSCD", "COFN", "MOFF", "MNUM"});
    add(k, Role::vignetting_factor,
        {"VDXN", "VDYN", "VCXN", "VCYN", "VANN", "ZVDX", "ZVDY", "ZVCX", "ZVCY", "ZVAN"});
    add(k, Role::refused_unless_zero, {"PFIL"}, "a pupil filter");
    return k;
  }();
  return table;
}

const Keywords& surface_keywords() {
  static const Keywords table = [] {
    Keywords k;
    add(k, Role::known,
        {"TYPE", "CURV", "DISZ", "GLAS", "STOP", "CONI", "PARM", "DIAM", "CLAP", "FLAP", "SQAP", "ELAP",
         "OBSC", "SQOB", "ELOB", "SPID", "OBDC"});
    // Names, coatings, drawing, mechanics, physical optics, solves and pickups (their present values are
    // written out), and extra data that none of the surface types read here uses.
    add(k, Role::known, {"COMM", "COAT", "FIMP", "HIDE", "MIRR", "SLAB", "MEMA", "OEMA", "MAZH",
                         "POPS", "SSID", "VDSZ", "PZUP", "PPAR", "PKUP", "PRAM", "GLCZ", "TCOM",
                         "TOLE", "MARA", "CHRA", "XDAT", "BLNK", "BRDF", "SCAT", "PRIN"});
    add(k, Role::refused, {"UDAD", "USAP", "UAPF"}, "a user-defined aperture");
    add(k, Role::refused, {"NSCS", "NSCO", "NSOA", "NSOO", "NSOP", "NSOD"}, "non-sequential objects");
    add(k, Role::refused_unless_zero, {"SCBD"}, "a tilted or decentred surface");
    add(k, Role::refused_unless_zero, {"IGNR"}, "a surface that is to be ignored");
    return k;
  }();
  return table;
}

bool all_zero(const ZmxRecord& record) {
  return std::all_of(record.values.begin(), record.values.end(),
                     [](const std::string& word) { return parse_number(word).value_or(0) == 0; });
}

/// What the records of all blocks have to say.
struct Findings {
  std::set<std::string> unknown;
  bool vignetting = false;
};

void check_block(const ZmxFile& file, const ZmxBlock& block, const Keywords& keywords, Findings& findings) {
  for (const ZmxRecord& record : block.records) {
    const auto keyword = keywords.find(record.keyword);
    if (keyword == keywords.end()) {
      findings.unknown.insert(quotable(record.keyword));
      continue;
    }
    const auto [role, meaning] = keyword->second;
    if (role == Role::refused || (role == Role::refused_unless_zero && !all_zero(record)))
      file.fail(block, record.line,
                fmt::format("{} ({}) is not modelled; remove it from the file", record.keyword, meaning));
    if (role == Role::vignetting_factor && !all_zero(record)) findings.vignetting = true;
  }
}

}  // namespace

std::vector<std::string> check_zmx_keywords(const ZmxFile& file) {
  Findings findings;
  check_block(file, file.header, header_keywords(), findings);
  for (const ZmxBlock& block : file.surfaces) check_block(file, block, surface_keywords(), findings);
  std::vector<std::string> notes;
  if (findings.vignetting)
    notes.push_back(file.name +
                    ": vignetting factors are not used; the clear apertures vignette by themselves");
  constexpr std::size_t most_named = 12;
  std::vector<std::string> unknown(findings.unknown.begin(), findings.unknown.end());
  if (unknown.size() > most_named) unknown.resize(most_named);
  if (!unknown.empty())
    notes.push_back(fmt::format("{}: passed over keywords that are not known here: {}{}", file.name,
                                fmt::join(unknown, ", "), findings.unknown.size() > most_named ? " …" : ""));
  return notes;
}

}  // namespace petzval
