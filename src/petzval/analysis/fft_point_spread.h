// SPDX-License-Identifier: BSD-3-Clause
// The PSF as the plain FFT method has it: a textbook's pupil in place of the real one.
#pragma once

#include <petzval/analysis/field_tracer.h>
#include <petzval/wave/chord_sum.h>

#include <optional>

namespace petzval {

/// The approximation behind the "FFT PSF" of lens design programs (Goodman, Introduction to Fourier Optics,
/// ch. 6; what Maeda, Catrysse & Wandell 2005 found at odds with Huygens sums off axis): the entrance pupil
/// on a square grid of equally bright points, each with the wavefront aberration W of the reference sphere,
/// transformed with one scale for the whole image, λ times the paraxial working f-number on the axis,
///
///     U(s, t) = Σ_uv e^{−2πi W(u,v)} e^{iπ(u s + v t)/(λ N_w)},   u² + v² ≤ 1,
///
/// as if the image lay on a plane square to the chief ray and the pupil looked the same from everywhere. The
/// sum is taken at the samples of `grid`; an FFT is a fast way of taking it at samples of its own. \param
/// pupil_samples  across the pupil; the image repeats itself after so many λ N_w. \returns nothing where no
/// ray passes. `captured` is the share of the sum's own light.
std::optional<Psf> fft_point_spread(const FieldTracer& tracer, const ChiefRay& chief, const PsfGrid& grid,
                                    int pupil_samples = 256);

}  // namespace petzval
