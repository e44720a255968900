// SPDX-License-Identifier: BSD-3-Clause
// Scenes by name: files and built-in charts.
#pragma once

#include <petzval/image/photograph.h>
#include <petzval/scene/scene.h>
#include <petzval/scene/spectral_cube.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// What the user may say about a scene; what is left open comes from the file or is the chart's own default.
struct SceneOptions {
  /// Charts only; a file has its size. Absent: 768 × 576 samples and, of most charts, their drawing
  /// (Scene::drawing).
  std::optional<int> columns = {}, rows = {};
  std::vector<double> wavelengths_nm = {};  ///< empty: the file's bands; default_bands_nm() where it has none
  std::optional<double> horizontal_angle_deg = {};  ///< replaces the file's; 40 for charts and photographs
  std::optional<double> width_m = {};               ///< of the scene at its distance, in place of its angle
  std::optional<double> distance_m = {};  ///< replaces the file's; they stand at infinity. inf: at infinity
  std::optional<double> tilt_deg = {};    ///< turns a plane about its upright middle line: tilted()
  std::string illuminant = {};  ///< of charts, photographs (D65) and reflectances; swapped for that of a
                                ///< scene whose light is known
  std::optional<double> mean_luminance_cd_m2 =
      {};  ///< of the whole spectrum, whatever wavelengths are then taken
           ///< from it; replaces the file's; 100 for charts, photographs
  /// On the scene, in place of a mean luminance: what a perfect white gives back, over the light's whole
  /// spectrum. One of the two; the second is for light that no eye sees.
  std::optional<double> illuminance_lx = {}, irradiance_w_m2 = {};
  std::optional<double> band_width_nm = {};         ///< of every band, as behind filters (band_light)
  std::optional<PhotographEncoding> encoding = {};  ///< photographs only; absent: as the file says

  std::optional<PanoramaView> panorama = {};  ///< the samples are an equirectangular panorama

  std::string depth = {};  ///< a file (read_depth_file); "none": as if the scene had no depth; empty: its own
  std::optional<double> depth_scale = {};    ///< times every depth
  std::optional<DepthFrom> depth_from = {};  ///< replaces what the file says

  // Files of bare numbers only: ENVI, NumPy, spectral OpenEXR (CubeOptions).
  std::optional<SceneQuantity> quantity = {};  ///< absent: as the file says
  std::string radiance_unit = {};              ///< empty: the file's, or W·m⁻²·sr⁻¹·nm⁻¹
  std::optional<double> scale = {};            ///< times every number
  std::vector<double> file_bands_nm = {};      ///< wavelengths of a file that does not say them
  bool negative_is_zero = false;               ///< instead of an error
  ThermalOptions thermal = {};                 ///< of emissivities and temperatures
};

/// Reads a scene.
///
///     const Scene chart = read_scene("slanted-edge:5", {.wavelengths_nm = {450, 550, 650}, .distance_m =
///     2});
///
///   a file     .mat (ISET), .exr (spectral OpenEXR), .hdr (ENVI) or .npy (NumPy), or the name of a bundled
///   one
///              (data/scenes)
///   a photograph  .png, .jpg or .tif: photograph_scene()
///   a chart    "checkerboard", "checkerboard:16", "slanted-edge:5" … as builtin_scenes() lists them
/// \throws InputError for an unknown name, a bad parameter, a damaged file, an option that does not apply.
Scene read_scene(const std::string& path_or_name, const SceneOptions& options = {});

/// The file that read_scene reads with this one: of an ENVI header its numbers, of such numbers their header,
/// of a .npy the .json of its name. Empty if there is none.
std::string scene_companion(const std::string& path);

/// A chart that read_scene makes from its name.
struct BuiltinScene {
  std::string name = {};         ///< "checkerboard[:N]"
  std::string description = {};  ///< one line
};
std::vector<BuiltinScene> builtin_scenes();
/// Whether a scene can be taken to be as wide and as far away as is wanted: a chart, or the name of a
/// photograph.
bool is_open_scene(const std::string& path_or_name);
/// Whether it is a chart that has depth.
bool is_deep_chart(const std::string& path_or_name);
/// Whether it is a chart of the sky, all of it lights on a faint ground.
bool is_sky_chart(const std::string& path_or_name);
/// Whether a scene is another one at another angle, not the same one smaller or larger: stars, a tilted
/// plane.
bool is_drawn_to_angle(const std::string& path_or_name, const SceneOptions& options);
/// Whether read_scene makes a chart of this name: it is one's name, and no file is called so.
bool is_builtin_scene(const std::string& path_or_name);

}  // namespace petzval
