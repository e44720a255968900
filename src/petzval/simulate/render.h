// SPDX-License-Identifier: BSD-3-Clause
// The second way to the sensor: a three-dimensional scene, path-traced through every surface of the lens.
#pragma once

#include <petzval/base/context.h>
#include <petzval/image/picture.h>
#include <petzval/render/lights/light_change.h>
#include <petzval/render/rendering.h>
#include <petzval/simulate/autofocus.h>
#include <petzval/simulate/camera.h>
#include <petzval/simulate/flare.h>

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// The irradiance on the sensor, and what the first surfaces are.
using Rendering = render::Rendering;

/// A scene in three dimensions, and how it is seen.
///
///     RenderRequest request{.scene = "spheres"};
///     request.camera.lens = read_lens("dgauss-50mm").lens;
///     request.camera.focus = Focus::at_m(1.2);
///     request.samples_per_pixel = 256;
///     const Rendering picture = render_scene(request);
struct RenderRequest {
  /// Where directions from a point of the film are drawn from.
  enum class Sampling {
    exit_pupil,  ///< the region that holds the pupil as that point sees it
    rear_disk    ///< the disk of the last surface, as in 2006: the same picture, with more noise
  };
  /// What stands where the scene puts its camera.
  enum class Origin { film, front };

  /// A file in the text format of pbrt-v4 or in glTF 2.0 (.gltf, .glb), or the name of a bundled scene.
  std::string scene = {};
  /// What moves in it (pbrt's ActiveTransform) stands where it is at this time, in the unit of its
  /// TransformTimes; before and after these it rests. A clip of a scene counts seconds.
  double scene_time = 0;
  /// Without surfaces, its lens is the one of the scene's camera, if that has one. Without a sensor the film
  /// is the scene's. Automatic focus is autofocus on the zones below; an ideal camera has none.
  Camera camera = Camera();  // "= {}" makes g++ 12 warn of what it does not see through
  /// What this pixel (column, row) of the picture sees is to be sharp, whatever `camera.focus` says.
  std::optional<std::array<double, 2>> focus_pixel = {};
  /// The focus is the one in the scene's file, or the prescription's where there is none, whatever
  /// `camera.focus` says.
  bool focus_as_in_scene = false;
  AutofocusOptions autofocus = {};
  bool pinhole = false;                        ///< the scene's perspective through a pinhole, for comparison
  std::optional<int> columns = {}, rows = {};  ///< of the picture; with a sensor, of its middle
  std::optional<double> film_diagonal_mm = {};
  std::optional<double> aperture_diameter_mm = {};  ///< of the stop, in place of an f-number

  /// Where the camera stands and what is in the middle of its picture [scene units, world space]; absent: as
  /// in the scene, or, with one of them alone, the middle of the scene.
  std::optional<std::array<double, 3>> camera_at = {}, look_at = {};
  /// How the camera moves from there while its shutter is open, and what is in the middle of its picture
  /// [scene units, world space]; absent: not.
  std::optional<std::array<double, 3>> camera_move = {}, look_move = {};
  /// Of the time from the first row's beginning to the last row's end: by how much the last row begins later
  /// than the first, from 0, all at once, to below 1. For a camera that moves.
  double rolling_shutter = 0;
  std::optional<double> field_of_view_deg = {};  ///< of a camera without a lens, across the picture's width

  std::vector<double> wavelengths_nm = {};  ///< empty: 400 to 700 in steps of 10
  double scene_unit_mm = 1000;              ///< length of the scene's unit
  bool absolute_spectra = false;  ///< spectra of lights are radiances [W·m⁻²·sr⁻¹·nm⁻¹] as they stand
  double light_scale = 1;         ///< all lights of the scene this much stronger
  std::vector<render::LightChange> light_changes = {};  ///< of single ones, in order (parse_light_change)
  std::optional<double> sky_cd_m2 = {};  ///< white light from all around, added to that of the scene
  bool skip_unsupported = false;  ///< leave out what the scene has and Petzval has not, instead of refusing

  Sampling sampling = Sampling::exit_pupil;
  Origin camera_origin = Origin::film;
  bool diffraction = false;  ///< light of what is about in focus lands as waves do (render::WaveImage)
  std::optional<int> max_depth = {};  ///< times that light is scattered; absent: the scene's, or 5
  /// Surfaces outside of these planes are not seen [scene units from the camera's place]; absent: the
  /// scene's.
  std::optional<double> near_distance = {}, far_distance = {};
  std::optional<int> samples_per_pixel = {};  ///< absent: 64, with `noise` at most 4096
  /// If positive: ends when nine of ten tiles are estimated to be this close to the picture without noise,
  /// RMS error over mean light.
  double noise = 0;
  /// The picture without most of its noise (render/film/denoise.h): light of surfaces that are alike is
  /// shared among them. `irradiance.provenance` says so; the checkpoint keeps the light as it was. At least
  /// four samples a pixel for every eight wavelengths are taken. Not of pieces, and not with light groups.
  bool denoise_light = false;
  bool first_surfaces = false;  ///< depth, normals and albedo, too
  bool light_groups = false;    ///< what each light gives of the picture, too
  /// A file to go on from and to save to, on the way, when the picture is done and when it is stopped; more
  /// samples may then be asked for. Empty: none.
  std::string checkpoint = {};
  double checkpoint_seconds = 60;
  /// A piece of the picture for one of several processes, whose checkpoints merge_renderings() puts together:
  /// pixels (column, row, columns, rows), and samples a pixel from the first up to the second. Absent: all.
  std::optional<std::array<int, 4>> region = {};
  std::optional<std::array<int, 2>> sample_range = {};

  bool is_piece() const { return region || sample_range; }
};

/// What only the library's own files look into.
struct PreparedWorld;

/// A scene read, its world built, its camera set up. A value: the world is shared by copies, and what `lens`
/// and the sampling in `request` say may be altered between renderings.
struct PreparedScene {
  RenderRequest request;
  SensorGeometry film;
  Photosite photosite;
  std::optional<Lens> lens;        ///< as it is used; absent: a pinhole or a thin lens
  std::optional<FocusRun> focus;   ///< once autofocus has placed the film
  std::vector<std::string> files;  ///< of the scene: its own, and those that it names
  std::shared_ptr<const PreparedWorld> world;

  bool wants_autofocus() const;
  /// From the last vertex to the film; 0 without a lens.
  double film_distance_mm() const;
};

/// "dgauss-50mm, film 37.75 mm behind the last surface, stop 17.1 mm wide".
std::string camera_text(const PreparedScene& scene);

/// Reads the scene and builds its world. Notes tell what was chosen or left out. \throws InputError with
/// file, line and column for what is wrong in the scene; Failure; Cancelled.
PreparedScene prepare_scene(const RenderRequest& request, const Context& context = {});

/// The same scene as another request has its camera: lens, focus, stop, place, samples. The world is kept if
/// what is asked of it is the same, and else built anew.
PreparedScene prepare_scene(const RenderRequest& request, const PreparedScene& before,
                            const Context& context = {});

/// Something in a scene that is not supported, and where.
struct UnsupportedFeature {
  std::string file;
  int line = 0, column = 0;         ///< of a text file
  std::optional<std::string> path;  ///< of an entry of a JSON file
  std::string place;                ///< "scene.pbrt:12:7" or "scene.gltf: materials[2].normalTexture"
  std::string what;
};
std::vector<UnsupportedFeature> unsupported_features(RenderRequest request, const Context& context = {});

/// Moves the film to where the zones are sharpest. Only the zones are rendered, twice over with different
/// random numbers so that noise cancels in the measure, and with the same random numbers for every film
/// distance. \throws InputError for a camera without a lens and for zones of fewer than 4 × 4 pixels;
/// Cancelled.
const FocusRun& autofocus(PreparedScene& scene, const Context& context = {});
/// The zones that autofocus looks at, in pixels of the picture. \throws InputError for those of fewer than
/// 4 × 4.
std::vector<PictureFrame> frames_of_zones(const PreparedScene& scene);

/// The film distance at which the zones of a scene are sharpest. Without wavelengths, light is followed at
/// eight of them, which one path serves.
FocusRun autofocus(RenderRequest request, const Context& context = {});

/// Shown a picture that is not done yet.
struct PictureWatch {
  /// `stopped`: the work ends here, with Cancelled; else it goes on.
  std::function<void(const Rendering& so_far, bool stopped)> show;
  double every_s = std::numeric_limits<double>::infinity();  ///< while it goes on; infinite: not at all
};

/// The light on the sensor, with its provenance and the lens's facts, after autofocus if that is asked and
/// has not been. The seed is the context's. \throws InputError; Failure; Cancelled.
Rendering render_scene(const PreparedScene& scene, const Context& context = {},
                       const PictureWatch& watch = {});
/// Suns that the scene does not hold, and ghosts of them and of its own lights, to be added to its picture
/// (add_layers). A sun is hidden if something stands between it and the lens. \throws InputError for a camera
/// without a lens, and as flare_layers(); Cancelled.
FlareLayers scene_flare(const PreparedScene& scene, const FlareOptions& options, const Context& context = {});
/// Adds them to its picture, and what the lens scatters, if that is asked. \throws InputError as
/// add_scatter(); Cancelled.
void add_scene_flare(const PreparedScene& scene, const FlareOptions& options, FlareLayers& layers,
                     SpectralImage& light, const Context& context = {});
/// Puts the pieces of one picture together, given by their checkpoints in any order: the file becomes the
/// checkpoint that one process would have left, bit for bit, and the same request without a piece goes on
/// from there. \throws InputError for pieces of different pictures or versions, and for pixels and samples
/// that two of them have, or none; Failure; Cancelled.
void merge_renderings(const std::vector<std::string>& pieces, const std::string& checkpoint,
                      const Context& context = {});
/// prepare_scene() and render_scene() in one.
Rendering render_scene(const RenderRequest& request, const Context& context = {});

}  // namespace petzval
