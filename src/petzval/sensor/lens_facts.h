// SPDX-License-Identifier: BSD-3-Clause
// What a camera would note of its lens.
#pragma once

#include <petzval/image/spectral_image.h>
#include <petzval/lens/first_order.h>

#include <string>

namespace petzval {

/// Name, focal length, working f-number and exit pupil; what is infinite or not known is 0.
LensFacts lens_facts(const std::string& name, const FirstOrder& lens);

}  // namespace petzval
