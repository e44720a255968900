// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/glass/catalogue.h>
#include <petzval/glass/packed_catalogue.h>

#include <algorithm>
#include <map>
#include <set>

namespace petzval {

namespace {

using Name = PackedCatalogue::Name;

/// Largest file that is taken for a catalogue; the bundled one has half a megabyte.
constexpr std::size_t largest_file = std::size_t{64} << 20;

bool same_dispersion(const Glass& a, const Glass& b) {
  return a.formula == b.formula && a.coefficients == b.coefficients && a.n_table == b.n_table &&
         a.shortest_nm == b.shortest_nm && a.longest_nm == b.longest_nm;
}

bool is_control(char c) {
  return static_cast<unsigned char>(c) < ' ' || c == '\x7f';
}

/// "BK7" of "N-BK7", "LAK10" of "H-LAK10": makers put a letter or two for the kind in front.
std::string_view without_prefix(std::string_view bare) {
  constexpr std::size_t longest_prefix = 2;
  const std::size_t dash = bare.find('-');
  return dash <= longest_prefix ? bare.substr(dash + 1) : bare;
}

}  // namespace

struct GlassCatalogue::Impl {
  PackedCatalogue packed;

  const Name* find_full(const std::string& folded) const;
  std::vector<const Name*> find_bare(const std::string& folded) const;
  const Name* the_one(const std::string& name, const std::vector<const Name*>& found) const;
  [[noreturn]] void unknown(const std::string& name) const;
  std::vector<std::string> nearest(const std::string& bare, const std::string& folded_catalogue) const;
};

const Name* GlassCatalogue::Impl::find_full(const std::string& folded) const {
  const auto& names = packed.names();
  const auto found = std::lower_bound(names.begin(), names.end(), folded,
                                      [](const Name& a, const std::string& b) { return a.folded < b; });
  return found != names.end() && found->folded == folded ? &*found : nullptr;
}

std::vector<const Name*> GlassCatalogue::Impl::find_bare(const std::string& folded) const {
  std::vector<const Name*> found;
  for (const Name& name : packed.names())
    if (name.folded_bare() == folded) found.push_back(&name);
  return found;
}

/// The glass that all of `found` agree on.
const Name* GlassCatalogue::Impl::the_one(const std::string& name,
                                          const std::vector<const Name*>& found) const {
  const Glass first = packed.glass(found.front()->glass);
  std::vector<std::string> candidates;
  bool all_same = true;
  for (const Name* candidate : found) {
    candidates.push_back(candidate->full);
    all_same = all_same && same_dispersion(first, packed.glass(candidate->glass));
  }
  if (!all_same)
    throw InputError(fmt::format("glass {} is ambiguous; say which: {}", name, fmt::join(candidates, ", ")));
  return found.front();
}

/// Full names of the glasses whose bare names, with or without the maker's prefix, are nearest, within one
/// catalogue or ("") in all.
std::vector<std::string> GlassCatalogue::Impl::nearest(const std::string& bare,
                                                       const std::string& folded_catalogue) const {
  constexpr std::size_t most = 6;
  std::multimap<std::string, const Name*> by_name;
  for (const Name& name : packed.names()) {
    if (!folded_catalogue.empty() && name.folded_catalogue() != folded_catalogue) continue;
    by_name.emplace(name.folded_bare(), &name);
    if (const auto core = without_prefix(name.folded_bare()); core != name.folded_bare())
      by_name.emplace(core, &name);
  }
  std::vector<std::string> candidates, full;
  for (const auto& [name, glass] : by_name)
    if (candidates.empty() || candidates.back() != name) candidates.push_back(name);
  for (const std::string& near : nearest_names(bare, candidates)) {
    const auto [first, last] = by_name.equal_range(near);
    for (auto entry = first; entry != last && full.size() < most; ++entry)
      if (std::find(full.begin(), full.end(), entry->second->full) == full.end())
        full.push_back(entry->second->full);
  }
  return full;
}

void GlassCatalogue::Impl::unknown(const std::string& name) const {
  // Longer than any name, or not a word at all: nothing to compare, and not to be repeated.
  constexpr std::size_t longest_name = 100;
  if (name.empty() || name.size() > longest_name || std::any_of(name.begin(), name.end(), is_control))
    throw InputError("that is not the name of a glass; one is SCHOTT:N-BK7");
  const std::size_t colon = name.find(':');
  if (colon == name.npos)
    throw InputError(
        fmt::format("unknown glass {}; the nearest known are {}", name, fmt::join(nearest(name, ""), ", ")));
  const std::string bare = name.substr(colon + 1);
  std::set<std::string> catalogues;
  for (const Name& known : packed.names()) catalogues.emplace(known.folded_catalogue());
  const std::string catalogue = upper_case(name.substr(0, colon));
  if (catalogues.count(catalogue) == 0)
    throw InputError(fmt::format(
        "unknown glass {}: there is no catalogue {} (known: {}); the nearest glasses are {}", name,
        name.substr(0, colon), fmt::join(catalogues, ", "), fmt::join(nearest(bare, ""), ", ")));
  throw InputError(fmt::format("unknown glass {}; the nearest known are {}", name,
                               fmt::join(nearest(bare, catalogue), ", ")));
}

GlassCatalogue GlassCatalogue::open(const std::string& path) {
  GlassCatalogue catalogue;
  catalogue.impl_ =
      std::make_shared<const Impl>(Impl{PackedCatalogue(read_whole_file(path, largest_file), path)});
  return catalogue;
}

const GlassCatalogue& GlassCatalogue::bundled() {
  static const GlassCatalogue catalogue = open(data_directory() + "/glass/catalogue.pgc");
  return catalogue;
}

std::size_t GlassCatalogue::size() const {
  return impl_->packed.glass_count();
}

std::vector<std::string> GlassCatalogue::full_names() const {
  std::vector<std::string> names;
  for (const Name& name : impl_->packed.names())
    if (name.proper) names.push_back(name.full);
  return names;
}

std::vector<std::string> GlassCatalogue::catalogues() const {
  std::set<std::string> known;
  for (const Name& name : impl_->packed.names()) known.insert(name.full.substr(0, name.full.find(':')));
  return {known.begin(), known.end()};
}

std::shared_ptr<const Glass> GlassCatalogue::find(const std::string& name,
                                                  const std::vector<std::string>& preferred) const {
  const std::string folded = upper_case(name);
  const Name* found = nullptr;
  if (folded.find(':') != folded.npos) {
    found = impl_->find_full(folded);
  } else {
    for (std::size_t i = 0; i < preferred.size() && !found; ++i)
      found = impl_->find_full(upper_case(preferred[i]) + ":" + folded);
    if (const auto candidates = impl_->find_bare(folded); !found && !candidates.empty())
      found = impl_->the_one(name, candidates);
  }
  if (!found) impl_->unknown(name);
  return std::make_shared<const Glass>(impl_->packed.glass(found->glass));
}

bool GlassCatalogue::contains(const std::string& full_name) const {
  return impl_->find_full(upper_case(full_name)) != nullptr;
}

}  // namespace petzval
