// SPDX-License-Identifier: BSD-3-Clause
// Interpolation in the frequency domain, to show what it does.
#pragma once

#include <petzval/imaging/psf_kernel.h>

namespace petzval {

/// The kernel whose OTF has modulus and phase interpolated linearly, each by itself, between those of two
/// kernels of one size (the difference of phase taken the short way round). Maeda, Catrysse & Wandell 2005
/// found that interpolating PSFs gives the better picture; this is what they compared with. The result may
/// have negative weights; what falls outside the kernel's square is cut off.
Kernel between_otfs(const Kernel& low, const Kernel& high, double weight_high);

}  // namespace petzval
