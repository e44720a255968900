// SPDX-License-Identifier: BSD-3-Clause
// What fills the gap behind a surface, and its refractive index.
#pragma once

#include <petzval/glass/dispersion.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace petzval {

/// A glass of a catalogue: a dispersion formula with its coefficients, valid range and, where known,
/// absorption. Immutable and shared. Indices are relative to air at 20 °C and 1 atm, as catalogues give them.
struct Glass {
  std::string catalogue;  ///< upper case: "SCHOTT"
  std::string name;       ///< as the maker writes it: "N-BK7"
  /// Number of the refractiveindex.info formula (dispersion.h), λ in µm; 0: a table of n in `n_table`,
  /// interpolated.
  int formula = 0;
  std::vector<double> coefficients;
  double shortest_nm = 0, longest_nm = 0;          ///< where the index is valid
  std::vector<std::pair<double, double>> n_table;  ///< (wavelength [nm], n)
  std::vector<std::pair<double, double>> k_table;  ///< (wavelength [nm], extinction coefficient)
  std::optional<double> stated_nd, stated_vd;      ///< as the maker prints them
  std::string status;                              ///< "preferred", "standard", "special" … or unknown: ""
  /// Whether formula or table give the index against vacuum, and by wavelengths in vacuum; index() converts.
  bool absolute = false, vacuum_wavelengths = false;

  /// By the formula (dispersion.h) or the table. \throws InputError outside the valid range, naming glass and
  /// range.
  double index(double wavelength_nm) const;
  /// Extinction coefficient k, linear in the table and held at its ends; 0 without a table.
  double extinction(double wavelength_nm) const;
  /// Share of the light that 10 mm of the glass let through, without reflections: exp(−4πk·10 mm/λ).
  double transmittance_10mm(double wavelength_nm) const;
  /// nd and Vd by the formula; absent where the valid range does not hold the lines F, d and C.
  std::optional<AbbeNumbers> abbe() const;
  std::string full_name() const { return catalogue + ":" + name; }
};

/// A material of a lens: air, a catalogue glass, a model glass (nd, Vd), a constant index, or a table of
/// indices. A value type; copies are cheap.
class Material {
 public:
  struct Air {};
  /// nd, Vd and the deviation of P_gF from the line of normal partial dispersion (model_glass_index in
  /// dispersion.h).
  struct Model {
    double nd, vd;
    double dpgf = 0;
  };
  struct Constant {
    double index;
  };
  /// (wavelength [nm], n), increasing; exact at the entries, monotone cubic in between, an error outside.
  using Table = std::vector<std::pair<double, double>>;
  using Kind = std::variant<Air, std::shared_ptr<const Glass>, Model, Constant, Table>;

  /// How a melt differs from its catalogue: nd by so much, and Vd by so many per cent of itself. The index
  /// becomes n'd + (n − nd)·s, with s such that V'd comes out.
  struct Melt {
    double delta_nd = 0, delta_vd_percent = 0;
    bool is_none() const { return delta_nd == 0 && delta_vd_percent == 0; }
  };

  Material() = default;  ///< air
  /// \throws InputError for indices below 1, non-finite numbers, vd ≤ 0, unsorted or empty tables.
  explicit Material(Kind kind);

  /// The same of another melt. \throws InputError for air, for numbers that are not finite and for a change
  /// of Vd to nothing or less.
  Material melted(const Melt& melt) const;
  const Melt& melt() const { return melt_; }

  const Kind& kind() const { return kind_; }
  bool is_air() const { return std::holds_alternative<Air>(kind_); }
  /// Refractive index relative to air. \throws InputError where it is not known.
  double index(double wavelength_nm) const;
  /// Extinction coefficient k; 0 for air, nothing where no data says (a catalogue glass without a table, a
  /// model glass, a given index).
  std::optional<double> extinction(double wavelength_nm) const;
  /// "air", "SCHOTT:N-BK7", "nd 1.6 Vd 60", "n 1.67", "table": for people and reports.
  std::string description() const;

 private:
  Kind kind_ = Air{};
  Melt melt_ = {};
};

}  // namespace petzval
