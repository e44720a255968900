// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/glass/packed_catalogue.h>
#include <petzval/lens/formats/glass_lookup.h>
#include <petzval/lens/formats/retired_glasses.h>

#include <algorithm>

namespace petzval {

namespace {

/// "1.61025/56.71": nd and Vd of a glass that no catalogue has.
std::optional<Material> model_glass(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return {};
  const auto nd = parse_number(text.substr(0, slash)), vd = parse_number(text.substr(slash + 1));
  if (!nd || !vd) return {};
  return Material(Material::Model{*nd, *vd});
}

void check_name(const std::string& name) {
  constexpr std::size_t longest_name = 60;
  if (name.empty() || name.size() > longest_name || quotable(name) != name)
    throw InputError(fmt::format("\"{}\" is not the name of a glass", quotable(name)));
}

std::optional<std::string> substitute(const std::string& name, const LensReadOptions& options) {
  for (const auto& [from, to] : options.substitutions)
    if (upper_case(from) == upper_case(name)) return to;
  return {};
}

}  // namespace

const GlassCatalogue& GlassLookup::catalogue() const {
  return options_.glasses ? *options_.glasses : GlassCatalogue::bundled();
}

bool GlassLookup::is_substituted(const std::string& name) const {
  return substitute(name, options_).has_value();
}

Material GlassLookup::of_catalogue(const std::string& name, const std::vector<std::string>& preferred) const {
  check_name(name);
  try {
    return Material(catalogue().find(name, preferred));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}; `substitute` {}=… takes another", error.what(), name));
  }
}

Material GlassLookup::find(const std::string& name, const std::vector<std::string>& preferred) {
  asked_.insert(name);
  const auto instead = substitute(name, options_);
  if (!instead && notes_) return of_other_program(name, preferred);
  if (!instead) return of_catalogue(name, preferred);
  const auto model = model_glass(*instead);
  return model ? *model : of_catalogue(*instead, preferred);
}

void GlassLookup::note(const std::string& text) {
  if (noted_.insert(text).second) notes_->push_back(file_ + ": " + text);
}

std::optional<Material> GlassLookup::successor(const std::string& name,
                                               const std::vector<std::string>& preferred) {
  const auto retired = notes_ ? find_retired_glass(name) : std::nullopt;
  if (!retired) return {};
  const std::string other(retired->successor);
  if (other.empty() || !catalogue().contains(other)) {
    note(fmt::format("glass {} is in no catalogue here; nd {:.5f} and Vd {:.2f} stand for it", name,
                     retired->nd, retired->vd));
    return Material(Material::Model{retired->nd, retired->vd});
  }
  const std::string maker = other.substr(0, other.find(':'));
  const bool wanted =
      preferred.empty() || std::any_of(preferred.begin(), preferred.end(),
                                       [&](const std::string& each) { return upper_case(each) == maker; });
  const Material taken(catalogue().find(other));
  const auto& glass = std::get<std::shared_ptr<const Glass>>(taken.kind());
  const auto abbe = glass->abbe();
  note(fmt::format("glass {} is made no more: {} is taken{}{}", name, other,
                   wanted ? "" : ", of another maker than the file names",
                   !abbe              ? std::string()
                   : retired->vd == 0 ? fmt::format(", nd {:+.5f} from it", abbe->nd - retired->nd)
                                      : fmt::format(", nd {:+.5f} and Vd {:+.2f} from it",
                                                    abbe->nd - retired->nd, abbe->vd - retired->vd)));
  return taken;
}

/// The makers that a file names first; then the successor of a retired glass; then anybody's.
Material GlassLookup::of_other_program(const std::string& name, const std::vector<std::string>& preferred) {
  check_name(name);
  const auto made_by = [&](const std::string& maker) { return catalogue().contains(maker + ":" + name); };
  const bool full = name.find(':') != std::string::npos;
  if (full || std::any_of(preferred.begin(), preferred.end(), made_by)) return of_catalogue(name, preferred);
  if (const auto other = successor(name, preferred)) return *other;
  Material taken = of_catalogue(name, preferred);
  const auto* glass = std::get_if<std::shared_ptr<const Glass>>(&taken.kind());
  if (glass && !preferred.empty())
    note(fmt::format("glass {} is taken from {}; {} has none of that name", name, (*glass)->full_name(),
                     fmt::join(preferred, ", ")));
  return taken;
}

Material GlassLookup::missing(const InputError& located, const std::string& name, const std::string& where) {
  missing_.push_back({located, name, where});
  return Material(Material::Constant{1.5});
}

void GlassLookup::require_all_found() const {
  if (missing_.empty()) return;
  std::vector<std::string> others;
  std::set<std::string> named;
  for (const Missing& each : missing_)
    if (named.insert(upper_case(each.name)).second)
      others.push_back(fmt::format("{} ({})", each.name, each.where));
  if (named.size() == 1) throw missing_.front().error;
  const ErrorParts& first = missing_.front().error.parts();
  throw InputError(
      first.file, first.line,
      fmt::format("{} glasses are not to be found: {}; `substitute` {}=… takes another for one of them",
                  named.size(), fmt::join(others, ", "), missing_.front().name));
}

Material GlassLookup::find_squeezed(const std::string& name, const std::string& holder) {
  const std::string as_written = holder.empty() ? name : name + "_" + holder;
  if (is_substituted(as_written)) return find(as_written);
  check_name(name);
  std::vector<std::string> found = catalogue().names_spelled(name);
  if (!holder.empty())
    std::erase_if(found, [&](const std::string& full) {
      return upper_case(full.substr(0, full.find(':'))) != upper_case(holder);
    });
  asked_.insert(as_written);
  if (found.empty())
    if (const auto other = successor(name, {})) return *other;
  if (found.empty()) return of_catalogue(holder.empty() ? name : holder + ":" + name, {});
  const auto bare = [](const std::string& full) { return full.substr(full.find(':') + 1); };
  const bool one_name = std::all_of(found.begin(), found.end(), [&](const std::string& full) {
    return upper_case(bare(full)) == upper_case(bare(found.front()));
  });
  if (!one_name)
    throw InputError(fmt::format("glass {} is ambiguous; say which: {}", as_written, fmt::join(found, ", ")));
  return of_catalogue(found.size() == 1 ? found.front() : bare(found.front()), {});
}

void GlassLookup::require_all_used() const {
  for (const auto& [from, to] : options_.substitutions) {
    const bool used = std::any_of(asked_.begin(), asked_.end(), [&, &from = from](const std::string& name) {
      return upper_case(name) == upper_case(from);
    });
    if (used && options_.substituted) options_.substituted->insert(from);
    if (used || options_.substituted) continue;
    if (asked_.empty())
      throw InputError(fmt::format("`substitute` {}={}: the lens names no glasses", quotable(from), to));
    throw InputError(fmt::format("`substitute` {}={}: the lens has no such glass; its glasses are {}",
                                 quotable(from), quotable(to), fmt::join(asked_, ", ")));
  }
}

}  // namespace petzval
