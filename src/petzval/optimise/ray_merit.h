// SPDX-License-Identifier: BSD-3-Clause
// What an optimiser makes small, as a list of numbers whose squares sum to the merit, with derivatives.
#pragma once

#include <petzval/analysis/field_tracer.h>
#include <petzval/optimise/optimise.h>

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace petzval {

/// At which fields count [degrees]: those asked for, else four if the lens is not round about its axis or may
/// lose that, else the one of its fields. Field 0 counts at the first alone.
std::vector<double> azimuths_of(const Lens& lens, const OptimiseRequest& request);

/// The rays by which a lens is judged for one round: launched through its pupils as they are at the start,
/// and kept while its numbers are altered.
class RayMerit {
 public:
  /// \throws InputError naming a field at which no ray passes.
  RayMerit(const Lens& lens, const OptimiseRequest& request);

  /// One row a number, [µm] of place, [nm] of path or [%] of lost MTF (tangential, sagittal), weighted so
  /// that the squares of a field sum to its mean square times its weight; nothing if a ray of the lens does
  /// not arrive. \param slopes  if given, gains a row a number and a column a variable.
  std::optional<Eigen::VectorXd> residuals(const Lens& lens, Eigen::MatrixXd* slopes) const;
  /// Root mean square of the fields, from what residuals() gave.
  double merit(const Eigen::VectorXd& residuals) const;
  std::vector<double> by_field(const Eigen::VectorXd& residuals) const;
  Eigen::Index rows() const;

 private:
  struct FieldRay {
    std::size_t wavelength;
    Ray launch;
    double weight;       ///< of all wavelengths of a field these sum to 1
    bool mirrored;       ///< stands for its mirror image in x too
    double alpha, beta;  ///< direction cosines at the image, at the start
  };
  /// Of one field at one azimuth.
  struct FieldRays {
    std::size_t field;
    double weight;
    double cosine, sine;  ///< of the azimuth
    /// Where on the sensor the light lands at the start, of a lens that is not round [mm]: paths are about
    /// this point, and so feel the sensor turn.
    double x_mm = 0, y_mm = 0;
    std::vector<FieldRay> rays = {};
  };
  struct Columns;

  void spot_rows(const FieldRays& field, const Columns& columns, Columns& rows) const;
  void wave_rows(const FieldRays& field, const Columns& columns, Columns& rows) const;
  void mtf_rows(const FieldRays& field, const Columns& columns, Columns& rows) const;
  Eigen::Index rows_of(const FieldRays& field) const;
  /// Adds the rays of a wavelength. \param whole  the lens may lose its symmetry: both halves of a pupil.
  void launch(FieldTracer& tracer, const FieldTableRequest& at, std::size_t wavelength, bool whole,
              FieldRays& field) const;

  OptimiseMerit kind_;
  double frequency_cpmm_;
  std::vector<double> wavelengths_nm_;
  std::vector<LensNumber> numbers_;
  std::vector<FieldRays> fields_;
};

}  // namespace petzval
