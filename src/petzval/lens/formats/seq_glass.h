// SPDX-License-Identifier: BSD-3-Clause
// How glasses are named in CODE V: "NBK7_SCHOTT", "516800.641673", and private ones with tables of indices.
#pragma once

#include <petzval/lens/formats/glass_lookup.h>

#include <map>
#include <string>
#include <vector>

namespace petzval {

/// nd and Vd of a fictitious glass: "517642", or "5168.6417" for 1.5168 and 64.17. Nothing if the word is no
/// number of this form.
std::optional<Material::Model> fictitious_glass(const std::string& word);
/// The same backwards, every digit kept. \throws InputError for nd from 2, Vd from 100 and deviations from
/// the normal line.
std::string fictitious_glass_text(const Material::Model& model);

/// Private glasses by their names in upper case.
using PrivateGlasses = std::map<std::string, Material>;

/// The material that the word of a surface stands for. \throws InputError
Material seq_glass(const std::string& word, const PrivateGlasses& own, GlassLookup& glasses);

/// "NBK7_SCHOTT". \throws InputError if a reader would find another glass by this name.
std::string seq_glass_name(const Glass& glass);

}  // namespace petzval
