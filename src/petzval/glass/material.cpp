// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/glass/catalogue.h>
#include <petzval/glass/material.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

void check_index(double n, const char* what) {
  if (!(n >= 1) || !std::isfinite(n))
    throw InputError(fmt::format("{} of {}; it must be a finite number of at least 1", what, n));
}

void check(const Material::Air&) {}

void check(const std::shared_ptr<const Glass>& glass) {
  if (!glass) throw InputError("a material without its glass");
}

void check(const Material::Model& model) {
  check_index(model.nd, "a model glass with nd");
  if (!(model.vd > 0) || !std::isfinite(model.vd))
    throw InputError(fmt::format("a model glass with Vd of {}; it must be positive", model.vd));
  if (!std::isfinite(model.dpgf))
    throw InputError("a model glass with a deviation of P_gF that is not finite");
}

void check(const Material::Constant& constant) {
  check_index(constant.index, "a refractive index");
}

void check(const Material::Table& table) {
  if (table.empty()) throw InputError("an empty table of indices; at least one wavelength is needed");
  double before_nm = 0;
  for (const auto& [wavelength_nm, n] : table) {
    if (!(wavelength_nm > before_nm) || !std::isfinite(wavelength_nm))
      throw InputError(
          fmt::format("a table of indices with {} nm after {} nm; wavelengths must increase from above 0",
                      wavelength_nm, before_nm));
    check_index(n, "a table of indices with an index");
    before_nm = wavelength_nm;
  }
}

double index_in(const Material::Air&, double) {
  return 1;
}
double index_in(const std::shared_ptr<const Glass>& glass, double wavelength_nm) {
  return glass->index(wavelength_nm);
}
double index_in(const Material::Model& model, double wavelength_nm) {
  return model_glass_index(model.nd, model.vd, wavelength_nm, model.dpgf);
}
double index_in(const Material::Constant& constant, double) {
  return constant.index;
}
double index_in(const Material::Table& table, double wavelength_nm) {
  return tabulated_index(table, wavelength_nm);
}

std::string describe(const Material::Air&) {
  return "air";
}
std::string describe(const std::shared_ptr<const Glass>& glass) {
  return glass->full_name();
}
std::string describe(const Material::Model& model) {
  const std::string text = fmt::format("nd {} Vd {}", model.nd, model.vd);
  return model.dpgf == 0 ? text : fmt::format("{} dPgF {}", text, model.dpgf);
}
std::string describe(const Material::Constant& constant) {
  return fmt::format("n {}", constant.index);
}
std::string describe(const Material::Table&) {
  return "table";
}

/// The bundled glass of the nearest nd and Vd that is known at a wavelength; nothing if none is near.
std::string advice_on_substitute(const Glass& glass, double wavelength_nm) {
  constexpr double nd_per_vd = 0.01, near = 0.01;  // as in `petzval glass find`
  const std::optional<AbbeNumbers> wanted = glass.abbe();
  if (!wanted) return "";
  const GlassCatalogue& bundled = GlassCatalogue::bundled();
  std::string best;
  double least = near;
  for (const std::string& name : bundled.full_names()) {
    const std::shared_ptr<const Glass> other = bundled.find(name);
    if (wavelength_nm < other->shortest_nm || wavelength_nm > other->longest_nm) continue;
    const std::optional<AbbeNumbers> abbe = other->abbe();
    if (!abbe) continue;
    const double far = std::hypot(abbe->nd - wanted->nd, nd_per_vd * (abbe->vd - wanted->vd));
    if (far < least) least = far, best = name;
  }
  return best.empty() ? ""
                      : fmt::format("; `substitute` {}={} has nearly its nd and Vd", glass.full_name(), best);
}

}  // namespace

double Glass::index(double wavelength_nm) const {
  if (!(wavelength_nm >= shortest_nm && wavelength_nm <= longest_nm))
    throw InputError(fmt::format("the index of {} is not known at {} nm; it is valid from {} to {} nm{}",
                                 full_name(), wavelength_nm, shortest_nm, longest_nm,
                                 advice_on_substitute(*this, wavelength_nm)));
  const double air = absolute || vacuum_wavelengths ? air_index(wavelength_nm) : 1;
  const double at_nm = vacuum_wavelengths ? wavelength_nm * air : wavelength_nm;
  const double relative_to = absolute ? air : 1;
  if (formula != 0) return dispersion_formula(formula, coefficients, at_nm) / relative_to;
  if (n_table.empty())
    throw InputError(full_name() + " has neither a dispersion formula nor a table of indices");
  // A wavelength in vacuum is longer: at the end of the range it may have passed the table's.
  return tabulated_index(n_table, std::min(at_nm, n_table.back().first)) / relative_to;
}

double Glass::extinction(double wavelength_nm) const {
  if (k_table.empty()) return 0;
  const auto above = std::upper_bound(k_table.begin(), k_table.end(), wavelength_nm,
                                      [](double nm, const auto& entry) { return nm < entry.first; });
  if (above == k_table.begin()) return k_table.front().second;
  if (above == k_table.end()) return k_table.back().second;
  const auto& [before_nm, k_before] = *(above - 1);
  return std::lerp(k_before, above->second, (wavelength_nm - before_nm) / (above->first - before_nm));
}

double Glass::transmittance_10mm(double wavelength_nm) const {
  constexpr double thickness_mm = 10;
  return std::exp(-4 * pi * extinction(wavelength_nm) * thickness_mm / (wavelength_nm * mm_per_nm));
}

std::optional<AbbeNumbers> Glass::abbe() const {
  if (shortest_nm > spectral_line::f_nm || longest_nm < spectral_line::c_nm) return std::nullopt;
  return abbe_numbers([this](double wavelength_nm) { return index(wavelength_nm); });
}

Material::Material(Kind kind) : kind_(std::move(kind)) {
  std::visit([](const auto& known) { check(known); }, kind_);
}

double Material::index(double wavelength_nm) const {
  if (!(wavelength_nm > 0) || !std::isfinite(wavelength_nm))
    throw InputError(fmt::format("a wavelength of {} nm; it must be positive", wavelength_nm));
  const auto catalogued = [&](double nm) {
    return std::visit([&](const auto& known) { return index_in(known, nm); }, kind_);
  };
  if (melt_.is_none()) return catalogued(wavelength_nm);
  const double nd = catalogued(spectral_line::d_nm), melted_nd = nd + melt_.delta_nd;
  const double spread = (melted_nd - 1) / (nd - 1) / (1 + melt_.delta_vd_percent / 100);
  return melted_nd + spread * (catalogued(wavelength_nm) - nd);
}

Material Material::melted(const Melt& melt) const {
  if (!std::isfinite(melt.delta_nd) || !std::isfinite(melt.delta_vd_percent) || melt.delta_vd_percent <= -100)
    throw InputError(
        fmt::format("a melt that differs by {} in nd and {} % in Vd; finite numbers, and more than "
                    "-100 % would be right",
                    melt.delta_nd, melt.delta_vd_percent));
  if (is_air() && !melt.is_none()) throw InputError("air has no melts; a glass would be right");
  Material result = *this;
  result.melt_ = melt;
  if (!melt.is_none() && !(result.index(spectral_line::d_nm) > 1))
    throw InputError(fmt::format("a melt whose nd differs by {} has no index above 1", melt.delta_nd));
  return result;
}

std::optional<double> Material::extinction(double wavelength_nm) const {
  if (is_air()) return 0.0;
  const auto* glass = std::get_if<std::shared_ptr<const Glass>>(&kind_);
  if (!glass || (*glass)->k_table.empty()) return {};
  return (*glass)->extinction(wavelength_nm);
}

std::string Material::description() const {
  return std::visit([](const auto& known) { return describe(known); }, kind_);
}

}  // namespace petzval
