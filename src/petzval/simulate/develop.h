// SPDX-License-Identifier: BSD-3-Clause
// From a raw image to a picture.
#pragma once

#include <petzval/base/context.h>
#include <petzval/colour/spectrum.h>
#include <petzval/image/formats/jpeg_output.h>
#include <petzval/image/picture_inset.h>
#include <petzval/isp/develop.h>
#include <petzval/sensor/raw_image.h>
#include <petzval/sensor/sensor.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// What is taken for white.
struct WhiteBalance {
  enum class Kind {
    as_shot,     ///< what the raw image says
    grey_world,  ///< the mean of the picture
    light,       ///< a surface under `light`
    neutral      ///< these responses of the channels
  };
  Kind kind = Kind::as_shot;
  std::optional<Spectrum> light = {};
  std::vector<double> neutral = {};
  /// With a light: the sensor that the colour matrix is fitted to under this very light. Absent: the matrices
  /// of the raw image.
  std::optional<Sensor> sensor = {};

  /// "as-shot", "grey-world", a light ("D65", "A", "3200K", a file), or responses ("0.5,1,0.7").
  /// \throws InputError for a light that there is not.
  static WhiteBalance parse(const std::string& text);
};

struct Development {
  WhiteBalance white_balance = {};
  std::optional<RawImage> flat = {};  ///< of a uniform surface, to correct the shading by
  DevelopOptions options = {};        ///< its flat field, neutral and matrix follow from the two above
};

/// A developed picture: linear light of a display.
struct Picture {
  Planes planes;
  DisplaySpace space = DisplaySpace::srgb;
  DevelopReport report = {};
  std::string provenance = {};
  CameraFacts facts = {};  ///< what the raw file says of its exposure
};

/// Develops a raw image.
///
///     Development development;
///     development.white_balance = WhiteBalance::parse("D65");
///     write_picture("shot.tif", develop(raw, development), 16);
///
/// \param step  told of each step with what it made (develop_step_names()); may be
/// empty. \throws InputError for options that do not fit the image; Cancelled.
Picture develop(const RawImage& raw, const Development& development = {}, const Context& context = {},
                const DevelopStep& step = {});

/// The picture with parts of it enlarged beside it, on white. \throws InputError as InsetSheet.
Picture with_insets(const Picture& picture, const std::vector<PictureInset>& insets);

/// Writes it as .png or .tif (8 or 16 bits, with the display's profile), .jpg (8 bits, with EXIF too), or
/// linear as .exr or .npy. \throws InputError for another extension; Failure.
void write_picture(const std::string& path, const Picture& picture, int bits = 8);

}  // namespace petzval
