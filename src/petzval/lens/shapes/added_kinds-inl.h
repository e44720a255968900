// SPDX-License-Identifier: BSD-3-Clause
// The kinds of surface beside conics and powers of r. A new one is added here, in two lines: its file, and
// its name in the list. Included once per instruction set.
#if defined(PETZVAL_LENS_SHAPES_ADDED_KINDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PETZVAL_LENS_SHAPES_ADDED_KINDS_INL_H_
#undef PETZVAL_LENS_SHAPES_ADDED_KINDS_INL_H_
#else
#define PETZVAL_LENS_SHAPES_ADDED_KINDS_INL_H_
#endif

#include <petzval/lens/shapes/biconic-inl.h>
#include <petzval/lens/shapes/numbers-inl.h>
#include <petzval/lens/shapes/qcon-inl.h>
#include <petzval/lens/shapes/toroid-inl.h>
#include <petzval/lens/shapes/xy_polynomial-inl.h>
#include <petzval/lens/shapes/zernike_sag-inl.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

template <class... Kind>
struct KindList {};

using AddedKinds = KindList<Qcon, Biconic, Toroid, XyPolynomial, ZernikeSag>;

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PETZVAL_LENS_SHAPES_ADDED_KINDS_INL_H_
