// SPDX-License-Identifier: BSD-3-Clause
// Several exposures, or readings of one, made into one raw image.
#pragma once

#include <petzval/sensor/raw_image.h>

#include <vector>

namespace petzval {

/// Several exposures of one scene made into one raw image of 16 bits: each pixel is the sum of the electrons
/// of all frames in which it stays below 90 % of saturation, over the sum of their exposure times (the
/// estimate of greatest likelihood under shot noise); pixels that saturate in all frames are white. Levels
/// are those of the shortest exposure. The shot noise that is stated is the geometric mean of that of all
/// frames (of shadows) and that of the shortest (of highlights): off by at most the root of the ratio of
/// times. \throws InputError unless the frames are of one sensor at one gain.
RawImage merge_bracket(const std::vector<RawImage>& frames);

/// Merges readings of one exposure at several conversion gains: the mean of those below 90 % of their
/// saturation, weighted by their read noise, and never without the one of the widest range. Below the least
/// saturation the noise is √(μ + 1/Σ(1/σ²)) electrons, above the greatest that of the widest reading.
/// \throws InputError for exposures that differ.
RawImage merge_readings(const std::vector<RawImage>& readings);

}  // namespace petzval
