// SPDX-License-Identifier: BSD-3-Clause
// The Fourier transform of polygons, by their outlines.
#pragma once

#include <petzval/numeric/nonuniform_fft.h>
#include <petzval/target/visible_regions.h>

#include <complex>
#include <functional>

namespace petzval {

/// A rectangle of `columns` × `rows` pixels with its corner at `origin`, over which scenes are made periodic.
struct Period {
  int columns = 0, rows = 0;
  Vertex origin;
};

/// Visits F(k/columns, l/rows) = ∬ S(x) exp(−2πi f·(x − origin)) d²x of S = Σ step over the regions, clipped
/// to the period, for |f| up to `cutoff_cpp`: by Gauss' theorem F = i/(2πf_x) ∮ step·exp(−2πi f·x) n_x ds,
/// with Gauss-Legendre nodes on every edge that are enough for the highest frequency, spread by a non-uniform
/// FFT; the column f_x = 0 takes n_y in place of n_x. Columns are visited as by NonuniformFft2.
void transform_outlines(
    const std::vector<Region>& regions, const Period& period, double cutoff_cpp, std::size_t working_bytes,
    const std::function<void(int k, int l_max, std::span<const std::complex<double>>)>& visit);

}  // namespace petzval
