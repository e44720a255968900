// SPDX-License-Identifier: BSD-3-Clause
// One image by several processes: each forms some of its bands.
#pragma once

#include <petzval/imaging/image_formation.h>
#include <petzval/simulate/image.h>

#include <string>
#include <vector>

namespace petzval {

/// Forms the bands `plan.options.bands` and writes them to `plan.options.checkpoint`. Every process plans the
/// whole image, so that a band is the same whoever forms it:
///
///     plan.options.bands = {0, 16};
///     plan.options.checkpoint = "left.bands";
///     image_piece(plan);
///
/// \throws InputError for bands that the image has not, and as image(); Failure; Cancelled.
void image_piece(const ImagePlan& plan, const Context& context = {}, ImageReport* report = nullptr);

/// Whether a file begins as those of image_piece() do.
bool is_image_piece(const std::string& path);

/// Puts the pieces of one image together, in any order: image() of the same plan with the file as its
/// checkpoint, and without `bands`, is the image that one process would have formed, bit for bit.
/// \throws InputError for a damaged piece, one of another image or another version, and for bands that two
/// pieces have, or none; Failure; Cancelled.
void merge_images(const std::vector<std::string>& pieces, const std::string& checkpoint,
                  const Context& context = {});

/// What a checkpoint knows of an image: all of its bands. Nothing is read without one. \throws InputError for
/// the checkpoint of another image, one that is damaged, and one that lacks bands.
BandShare known_bands(const ImagePlan& plan);

}  // namespace petzval
