// SPDX-License-Identifier: BSD-3-Clause
// Digital negatives (Adobe DNG 1.4).
#pragma once

#include <petzval/sensor/raw_image.h>

#include <string>

namespace petzval {

/// Writes a raw image as DNG: 16-bit samples without compression; mosaic, levels, linearization, two colour
/// and forward matrices, white balance, noise profile; exposure, ISO, f-number, focal length and lens in
/// EXIF. One channel is written as linear raw, without a mosaic. Laid out as by cameras: a preview (at most
/// 256 pixels long, white balanced) comes first, the raw picture stands below it (in a SubIFD). The same
/// bytes for the same image: no date but that of the image. \throws InputError for an image that contradicts
/// itself, or with channels that DNG has no number for (it knows red, green, blue, cyan, magenta, yellow and
/// white or clear); as WholeFile; Failure.
void write_dng(const std::string& path, const RawImage& raw);
/// Whether DNG has numbers for all channels of the image.
bool fits_dng(const RawImage& raw);
/// What other programs make of that file's mosaic, if they do not know it: a line to tell; empty for Bayer
/// mosaics, X-Trans and none.
std::string mosaic_note(const RawImage& raw);
/// The bytes of that file. \param path  for messages.
std::string dng_bytes(const RawImage& raw, const std::string& path);

/// Reads uncompressed and Deflate-compressed DNG files of 8 or 16 bits a sample with one black level: those
/// of write_dng and many of others. \throws InputError for anything else, and for damaged files.
RawImage read_dng(const std::string& path);
/// The same of a file's bytes. \param path  for messages.
RawImage parse_dng(std::string bytes, const std::string& path);

}  // namespace petzval
