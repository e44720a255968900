// SPDX-License-Identifier: BSD-3-Clause
// A ColorChecker's light through a sensor and a DNG file, developed by LibRaw's own pipeline.
#include <gtest/gtest.h>
#include <libraw/libraw.h>
#include <petzval/colour/cielab.h>
#include <petzval/colour/display.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/observer.h>
#include <petzval/colour/spectra_files.h>
#include <petzval/sensor/capture.h>
#include <petzval/sensor/colour_calibration.h>
#include <petzval/sensor/exposure.h>
#include <petzval/sensor/formats/dng.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scratch.h"

namespace petzval {
namespace {

constexpr int pitch = 24, columns = 6 * pitch, rows = 4 * pitch;

SpectralImage chart_light(const SpectrumSet& chart, const Spectrum& light, double pitch_um) {
  std::vector<double> nm;
  for (double at = 400; at <= 700; at += 10) nm.push_back(at);
  SpectralImage image(columns, rows, nm, pitch_um);
  for (int band = 0; band < image.bands(); ++band)
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const auto patch = static_cast<std::size_t>(row / pitch * 6 + column / pitch);
        const double at = nm[static_cast<std::size_t>(band)];
        image.at(band, row, column) =
            static_cast<float>(1e-4 * light.at(at) * chart.spectra[patch].spectrum.at(at));
      }
  return image;
}

/// Linear sRGB by dcraw's pipeline as LibRaw has it: the camera's white balance, its matrix for D65, AHD.
std::vector<std::uint16_t> developed_by_libraw(const std::string& path) {
  LibRaw libraw;
  libraw.imgdata.params.use_camera_wb = 1;
  libraw.imgdata.params.output_color = 1;
  libraw.imgdata.params.output_bps = 16;
  libraw.imgdata.params.no_auto_bright = 1;
  libraw.imgdata.params.gamm[0] = libraw.imgdata.params.gamm[1] = 1;
  EXPECT_EQ(libraw.open_file(path.c_str()), LIBRAW_SUCCESS);
  EXPECT_EQ(libraw.unpack(), LIBRAW_SUCCESS);
  EXPECT_EQ(libraw.dcraw_process(), LIBRAW_SUCCESS);
  int error = 0;
  libraw_processed_image_t* picture = libraw.dcraw_make_mem_image(&error);
  EXPECT_EQ(error, LIBRAW_SUCCESS);
  EXPECT_EQ(picture->width, columns);
  EXPECT_EQ(picture->height, rows);
  EXPECT_EQ(picture->colors, 3);
  const auto* samples = reinterpret_cast<const std::uint16_t*>(picture->data);
  std::vector<std::uint16_t> values(samples, samples + 3 * columns * rows);
  LibRaw::dcraw_clear_mem(picture);
  return values;
}

Xyz patch_mean(const std::vector<std::uint16_t>& picture, int patch) {
  constexpr int rim = 6;  // of each patch, where demosaicing mixes neighbours
  std::array<double, 3> sum{};
  for (int row = patch / 6 * pitch + rim; row < (patch / 6 + 1) * pitch - rim; ++row)
    for (int column = patch % 6 * pitch + rim; column < (patch % 6 + 1) * pitch - rim; ++column)
      for (std::size_t k = 0; k < 3; ++k)
        sum[k] += picture[3 * static_cast<std::size_t>(row * columns + column) + k];
  return xyz_of(LinearRgb{sum[0], sum[1], sum[2]});
}

TEST(LibRawPipeline, BringsColourCheckerBack) {
  const SpectrumSet chart = read_spectrum_set("colorchecker_reflectance");
  const Spectrum light = illuminant("D65");
  const Observer& eye = Observer::cie_1931();
  const Xyz white = eye.xyz(light);
  for (const char* name : {"third-inch-1280x960", "full-frame-24mp"}) {
    const Sensor sensor = read_sensor(name);
    const PhotoCurrent current = photo_current(chart_light(chart, light, sensor.geometry.pitch_um), sensor);
    const double saturation = sensor.electronics->saturation_e(sensor.electronics->gain_modes[0], 1);
    RawImage raw = capture(current, sensor, metered_exposure_s(current, saturation, {}), {});
    raw.calibrations = standard_calibrations(sensor);
    raw.as_shot_neutral = neutral_of(sensor, light);
    const test::Scratch scratch;
    const std::string path = scratch.path("raw.dng");
    write_dng(path, raw);
    const std::vector<std::uint16_t> picture = developed_by_libraw(path);

    // The exposure is free: the greys give it.
    std::vector<Xyz> seen, wanted;
    double seen_wanted = 0, seen_seen = 0;
    for (int patch = 0; patch < 24; ++patch) {
      std::vector<double> values;
      const Spectrum& reflectance = chart.spectra[static_cast<std::size_t>(patch)].spectrum;
      for (const double nm : light.wavelengths_nm())
        values.push_back(light.at(nm) * reflectance.at_extended(nm));
      wanted.push_back((1 / white.y) * eye.xyz(Spectrum(light.wavelengths_nm(), values)));
      seen.push_back(patch_mean(picture, patch));
      if (patch < 18) continue;
      seen_wanted += seen.back().y * wanted.back().y, seen_seen += seen.back().y * seen.back().y;
    }
    double mean = 0;
    for (std::size_t patch = 0; patch < 24; ++patch)
      mean += delta_e_2000(cielab((seen_wanted / seen_seen) * seen[patch], display_white()),
                           cielab(wanted[patch], display_white())) /
              24;
    RecordProperty(name, std::to_string(mean));
    // What our own development is held to (measure/colour_chain_test.cpp), from the same file.
    EXPECT_LT(mean, 3) << name;
  }
}

}  // namespace
}  // namespace petzval
