// SPDX-License-Identifier: BSD-3-Clause
#include "cube_formats.h"

#include <petzval/image/formats/depth_exr.h>
#include <petzval/image/photograph.h>
#include <petzval/scene/formats/envi.h>
#include <petzval/scene/formats/iset_mat.h>
#include <petzval/scene/formats/npy_scene.h>
#include <petzval/scene/formats/scene_exr.h>

#include <cmath>
#include <optional>

#include "memory_file.h"
#include "require.h"

namespace petzval::fuzz {

namespace {

/// What a user would say of a file that leaves things open.
CubeOptions answers_for(const SpectralCube& cube) {
  CubeOptions options;
  if (!cube.quantity) options.quantity = SceneQuantity::radiance;
  if (cube.quantity == SceneQuantity::reflectance) options.illuminant = Spectrum({100, 1e5}, {1, 1});
  if (cube.quantity == SceneQuantity::temperature) options.wavelengths_nm = {9000, 11000};
  if (cube.quantity != SceneQuantity::temperature) options.thermal.temperature_k = 300;
  if (!cube.horizontal_angle_deg) options.horizontal_angle_deg = 20;
  if (cube.wavelengths_nm.empty() && cube.quantity != SceneQuantity::temperature)
    for (int band = 0; band < cube.bands; ++band) options.file_bands_nm.push_back(400.0 + band);
  options.negative_is_zero = true;
  return options;
}

void require_light(const Scene& scene) {
  require(scene.bands() > 0 && scene.columns() > 0 && scene.rows() > 0, "a scene without samples");
  scene.validate();
}

/// The part before a line "DATA", and the part after it.
std::pair<std::string_view, std::string_view> parted(std::string_view bytes) {
  constexpr std::string_view mark = "\nDATA\n";
  const std::size_t at = bytes.find(mark);
  if (at == bytes.npos) return {bytes, {}};
  return {bytes.substr(0, at + 1), bytes.substr(at + mark.size())};
}

}  // namespace

bool try_photograph(std::string_view bytes) {
  const MemoryFile file(bytes);
  return accepted([&] {
    const Photograph photograph = read_photograph(file.path());
    require(photograph.columns > 0 && photograph.rows > 0 && photograph.rgb.size() == 3 * photograph.pixels(),
            "a photograph of another size");
    for (const float value : photograph.rgb) require(std::isfinite(value), "light that is no number");
  });
}

bool try_envi(std::string_view bytes) {
  const auto [header, data] = parted(bytes);
  return accepted([&, header = header, data = data] {
    SpectralCube cube = decode_envi(header, data, "fuzz.hdr", "fuzz.img");
    const CubeOptions options = answers_for(cube);
    require_light(scene_of(std::move(cube), options));
  });
}

bool try_npy(std::string_view bytes) {
  const auto [json, array] = parted(bytes);
  const MemoryFile file(array);
  return accepted([&, json = json] {
    SpectralCube cube = read_npy_scene(file.path());
    describe_cube(json, "fuzz.json", cube);
    const CubeOptions options = answers_for(cube);
    require_light(scene_of(std::move(cube), options));
  });
}

bool try_scene_mat(std::string_view bytes) {
  const MemoryFile file(bytes);
  return accepted([&] { require_light(read_iset_mat(file.path(), 20)); });
}

bool try_scene_mat_hdf5(std::string_view bytes) {
  const NamedFile file(bytes);
  return accepted([&] { require_light(read_iset_mat(file.path(), 20)); });
}

bool try_scene_exr(std::string_view bytes) {
  const MemoryFile file(bytes);
  accepted([&] {
    if (const std::optional<DepthPlane> depth = read_depth_exr(file.path()))
      require(depth->values.size() ==
                  static_cast<std::size_t>(depth->columns) * static_cast<std::size_t>(depth->rows),
              "depths of another size");
  });
  return accepted([&] {
    SpectralCube cube = read_scene_exr(file.path());
    const CubeOptions options = answers_for(cube);
    require_light(scene_of(std::move(cube), options));
  });
}

}  // namespace petzval::fuzz
