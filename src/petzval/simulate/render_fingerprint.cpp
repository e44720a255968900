// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/version.h>
#include <petzval/render/pbrt/scene_files.h>
#include <petzval/simulate/lens_fingerprint.h>
#include <petzval/simulate/prepared_world.h>

namespace petzval {

std::string render_fingerprint(const PreparedScene& scene, const render::RenderOptions& options) {
  const RenderRequest& request = scene.request;
  const render::SceneCamera camera = scene_camera(scene);
  const std::vector<double>& nm = scene.world->world->groups.wavelengths_nm();
  std::string text = fmt::format("petzval {}\n", version());
  text += fmt::format("seed {}\n", options.seed);
  // Fewer samples are the beginning of more, and a picture that ends at a noise that of one that ends at
  // less.
  text += options.denoise     ? "samples in two halves, to be denoised\n"
          : options.noise > 0 ? "samples in two halves\n"
                              : "samples in turn\n";
  text += fmt::format("max-depth {}\nnear {} far {}\n", options.path.max_depth, options.clipping.near,
                      options.clipping.far);
  text += fmt::format("first-surfaces {}\nlight-groups {}\n", options.first_surfaces || options.denoise,
                      options.light_groups);
  text += fmt::format("film {}x{} pixels of {} um\n", camera.film.columns, camera.film.rows,
                      camera.film.pitch_um);
  text += fmt::format("photosite {}\n", camera.photosite.text());
  text += fmt::format("wavelengths {}\n", fmt::join(nm, ","));
  text +=
      fmt::format("camera {}\nsampling {}\n",
                  !camera.lens ? fmt::format("perspective, lens radius {}", camera.perspective.lens_radius)
                  : camera.options.origin_at_front ? "lens, its origin at the front"
                                                   : "lens, its origin at the film",
                  request.sampling == RenderRequest::Sampling::rear_disk ? "rear-disk" : "exit-pupil");
  if (camera.lens)
    text += fmt::format("focus: film {} mm behind the last surface\nstop {} mm wide\n",
                        scene.film_distance_mm(), 2 * stop_radius_mm(*camera.lens));
  else
    text += fmt::format("field of view {}\n", camera.perspective.field_of_view_deg);
  for (const auto& row : camera.world_from_camera.matrix())
    text += fmt::format("camera's place {}\n", fmt::join(row, " "));
  if (const auto& motion = camera.motion)
    text += fmt::format(
        "camera looks at {} {} {}, moves {} {} {} and looks {} {} {} further, rolling shutter {}\n",
        motion->target.x, motion->target.y, motion->target.z, motion->eye_move.x, motion->eye_move.y,
        motion->eye_move.z, motion->target_move.x, motion->target_move.y, motion->target_move.z,
        motion->row_share);
  const StopBlades blades = camera.lens ? camera.lens->stop_blades() : StopBlades{};
  text += fmt::format("blades {} turned by {}\ndiffraction {}\n", blades.count, blades.rotation_deg,
                      request.diffraction);
  text +=
      fmt::format("scene-unit {}\nabsolute-spectra {}\n", request.scene_unit_mm, request.absolute_spectra);
  for (const render::LightChange& change : request.light_changes)
    text += fmt::format("light {}\n", change.text());
  if (request.scene_time != 0) text += fmt::format("scene-time {}\n", request.scene_time);
  text += fmt::format("light-scale {} sky {} skip-unsupported {}\n", request.light_scale,
                      request.sky_cd_m2.value_or(0), request.skip_unsupported);
  if (camera.lens) text += lens_fingerprint(*camera.lens, nm);
  text += losses_fingerprint(camera.lens ? camera.options.losses.of(*camera.lens) : camera.options.losses);
  return text + render::scene_files_fingerprint(*scene.world->description);
}

}  // namespace petzval
