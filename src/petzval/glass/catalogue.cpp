// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/glass/catalogue.h>
#include <petzval/glass/packed_catalogue.h>

#include <algorithm>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <unordered_map>

namespace petzval {

namespace {

using Name = PackedCatalogue::Name;

/// Largest file that is taken for a catalogue; the bundled one has half a megabyte.
constexpr std::size_t largest_file = std::size_t{64} << 20;

bool same_dispersion(const Glass& a, const Glass& b) {
  return a.formula == b.formula && a.coefficients == b.coefficients && a.n_table == b.n_table &&
         a.shortest_nm == b.shortest_nm && a.longest_nm == b.longest_nm && a.absolute == b.absolute &&
         a.vacuum_wavelengths == b.vacuum_wavelengths;
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

/// A table of names, sorted by `folded`, and the glasses that they are numbers of.
struct Shelf {
  const std::vector<Name>& names;
  std::function<std::shared_ptr<const Glass>(std::size_t)> glass;

  const Name* find_full(const std::string& folded) const {
    const auto found = std::lower_bound(names.begin(), names.end(), folded,
                                        [](const Name& a, const std::string& b) { return a.folded < b; });
    return found != names.end() && found->folded == folded ? &*found : nullptr;
  }
  std::vector<const Name*> find_bare(const std::string& folded) const {
    std::vector<const Name*> found;
    for (const Name& name : names)
      if (name.folded_bare() == folded) found.push_back(&name);
    return found;
  }
  const Name* the_one(const std::string& name, const std::vector<const Name*>& found) const;
  const Name* find(const std::string& name, const std::vector<std::string>& preferred) const;
};

/// The glass that all of `found` agree on.
const Name* Shelf::the_one(const std::string& name, const std::vector<const Name*>& found) const {
  const auto first = glass(found.front()->glass);
  std::vector<std::string> candidates;
  bool all_same = true;
  for (const Name* candidate : found) {
    candidates.push_back(candidate->full);
    all_same = all_same && same_dispersion(*first, *glass(candidate->glass));
  }
  if (!all_same)
    throw InputError(fmt::format("glass {} is ambiguous; say which: {}", name, fmt::join(candidates, ", ")));
  return found.front();
}

const Name* Shelf::find(const std::string& name, const std::vector<std::string>& preferred) const {
  const std::string folded = upper_case(name);
  if (folded.find(':') != folded.npos) return find_full(folded);
  for (const std::string& catalogue : preferred)
    if (const Name* found = find_full(upper_case(catalogue) + ":" + folded)) return found;
  const auto candidates = find_bare(folded);
  return candidates.empty() ? nullptr : the_one(name, candidates);
}

std::string squeezed(std::string_view text) {
  std::string letters;
  for (const char c : upper_case(text))
    if ((c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9')) letters += c;
  return letters;
}

}  // namespace

struct GlassCatalogue::Impl {
  std::shared_ptr<const PackedCatalogue> packed;  ///< may be absent
  std::vector<std::shared_ptr<const Glass>> own;
  std::vector<Name> own_names;
  /// Letters and digits of a bare name → full names; made when it is first wanted.
  mutable std::once_flag spelled_once;
  mutable std::unordered_map<std::string, std::vector<std::string>> spelled;

  Shelf own_shelf() const {
    return {own_names, [this](std::size_t i) { return own[i]; }};
  }
  Shelf packed_shelf() const {
    static const std::vector<Name> none;
    return {packed ? packed->names() : none,
            [this](std::size_t i) { return std::make_shared<const Glass>(packed->glass(i)); }};
  }
  template <class Work>
  void for_each_name(Work work) const {
    for (const Name& name : own_names) work(name);
    for (const Name& name : packed_shelf().names) work(name);
  }
  [[noreturn]] void unknown(const std::string& name) const;
  std::vector<std::string> nearest(const std::string& bare, const std::string& folded_catalogue) const;
};

/// Full names of the glasses whose bare names, with or without the maker's prefix, are nearest, within one
/// catalogue or ("") in all.
std::vector<std::string> GlassCatalogue::Impl::nearest(const std::string& bare,
                                                       const std::string& folded_catalogue) const {
  constexpr std::size_t most = 6;
  std::multimap<std::string, const Name*> by_name;
  for_each_name([&](const Name& name) {
    if (!folded_catalogue.empty() && name.folded_catalogue() != folded_catalogue) return;
    by_name.emplace(name.folded_bare(), &name);
    if (const auto core = without_prefix(name.folded_bare()); core != name.folded_bare())
      by_name.emplace(core, &name);
  });
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
  for_each_name([&](const Name& known) { catalogues.emplace(known.folded_catalogue()); });
  const std::string catalogue = upper_case(name.substr(0, colon));
  if (catalogues.count(catalogue) == 0)
    throw InputError(fmt::format(
        "unknown glass {}: there is no catalogue {} (known: {}); the nearest glasses are {}", name,
        name.substr(0, colon), fmt::join(catalogues, ", "), fmt::join(nearest(bare, ""), ", ")));
  throw InputError(fmt::format("unknown glass {}; the nearest known are {}", name,
                               fmt::join(nearest(bare, catalogue), ", ")));
}

GlassCatalogue GlassCatalogue::open(const std::string& path) {
  auto impl = std::make_shared<Impl>();
  impl->packed = std::make_shared<const PackedCatalogue>(read_whole_file(path, largest_file), path);
  GlassCatalogue catalogue;
  catalogue.impl_ = std::move(impl);
  return catalogue;
}

const GlassCatalogue& GlassCatalogue::bundled() {
  static const GlassCatalogue catalogue = open(data_directory() + "/glass/catalogue.pgc");
  return catalogue;
}

GlassCatalogue GlassCatalogue::of(std::vector<Glass> glasses) {
  GlassCatalogue empty;
  empty.impl_ = std::make_shared<Impl>();
  return empty.with(std::move(glasses));
}

GlassCatalogue GlassCatalogue::with(std::vector<Glass> glasses) const {
  auto impl = std::make_shared<Impl>();
  impl->packed = impl_->packed;
  impl->own = impl_->own;
  std::set<std::string> taken;
  for (const auto& glass : impl->own) taken.insert(upper_case(glass->full_name()));
  for (Glass& glass : glasses) {
    const std::string full = glass.full_name();
    if (glass.catalogue.empty() || glass.name.empty() || std::any_of(full.begin(), full.end(), is_control) ||
        std::count(full.begin(), full.end(), ':') != 1)
      throw InputError("a glass without a name, or with one that cannot be written as CATALOGUE:NAME");
    if (taken.insert(upper_case(full)).second) impl->own.push_back(std::make_shared<Glass>(std::move(glass)));
  }
  for (std::size_t i = 0; i < impl->own.size(); ++i) {
    const std::string full = impl->own[i]->full_name();
    impl->own_names.push_back({full, upper_case(full), i, true});
  }
  std::sort(impl->own_names.begin(), impl->own_names.end(),
            [](const Name& a, const Name& b) { return a.folded < b.folded; });
  GlassCatalogue catalogue;
  catalogue.impl_ = std::move(impl);
  return catalogue;
}

std::size_t GlassCatalogue::size() const {
  return full_names().size();
}

std::vector<std::string> GlassCatalogue::full_names() const {
  const Shelf own = impl_->own_shelf();
  std::vector<std::string> names;
  impl_->for_each_name([&](const Name& name) {
    const Name* hiding = own.find_full(name.folded);
    if (name.proper && (!hiding || hiding == &name)) names.push_back(name.full);
  });
  std::sort(names.begin(), names.end(),
            [](const std::string& a, const std::string& b) { return upper_case(a) < upper_case(b); });
  return names;
}

std::vector<std::string> GlassCatalogue::catalogues() const {
  std::set<std::string> known;
  impl_->for_each_name([&](const Name& name) { known.insert(name.full.substr(0, name.full.find(':'))); });
  return {known.begin(), known.end()};
}

std::shared_ptr<const Glass> GlassCatalogue::find(const std::string& name,
                                                  const std::vector<std::string>& preferred) const {
  for (const Shelf& shelf : {impl_->own_shelf(), impl_->packed_shelf()})
    if (const Name* found = shelf.find(name, preferred)) return shelf.glass(found->glass);
  impl_->unknown(name);
}

bool GlassCatalogue::contains(const std::string& full_name) const {
  const std::string folded = upper_case(full_name);
  return impl_->own_shelf().find_full(folded) || impl_->packed_shelf().find_full(folded);
}

std::vector<std::string> GlassCatalogue::names_spelled(const std::string& letters_and_digits) const {
  std::call_once(impl_->spelled_once, [this] {
    const Shelf own = impl_->own_shelf();
    impl_->for_each_name([&](const Name& name) {
      const Name* hiding = own.find_full(name.folded);
      if (!hiding || hiding == &name) impl_->spelled[squeezed(name.folded_bare())].push_back(name.full);
    });
  });
  const auto found = impl_->spelled.find(squeezed(letters_and_digits));
  return found == impl_->spelled.end() ? std::vector<std::string>() : found->second;
}

Material glass_material(const std::string& name, const GlassCatalogue& glasses) {
  return Material(glasses.find(name));
}

}  // namespace petzval
