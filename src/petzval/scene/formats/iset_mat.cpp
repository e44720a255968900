// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/scene/formats/iset_basis.h>
#include <petzval/scene/formats/iset_mat.h>
#include <petzval/scene/formats/mat_file.h>
#include <petzval/scene/formats/name_file.h>

#include <cmath>

namespace petzval {

namespace {

/// Numbers that may have been stored as unsigned integers: value = offset + step · stored.
struct Rescaling {
  double offset = 0, step = 1;
  double operator()(double stored) const { return offset + step * stored; }
};

/// The scale of integer numbers from the fields that hold their least and greatest value.
Rescaling rescaling(const MatNumbers& stored, const MatValue& holder, const char* least_name,
                    const char* greatest_name) {
  if (stored.unsigned_bits() == 0) return {};
  const std::optional<MatValue> bit_depth = holder.find("bitDepth");
  const double bits = bit_depth ? bit_depth->number() : stored.unsigned_bits();
  if (!(bits >= 1 && bits <= 64) || bits != std::floor(bits))
    bit_depth->fail("must be a whole number of bits");
  const double least = holder.at(least_name).number();
  const double greatest = holder.at(greatest_name).number();
  if (!std::isfinite(least) || !std::isfinite(greatest) || greatest < least)
    holder.fail(fmt::format("has {} = {} and {} = {}, which are no range", least_name, least, greatest_name,
                            greatest));
  return {least, (greatest - least) / (std::exp2(bits) - 1)};
}

struct PhotonCube {
  MatNumbers numbers;
  Rescaling scale;
  int columns = 0, rows = 0, bands = 0;
};

PhotonCube photon_cube(const MatValue& scene) {
  const MatValue data = scene.at("data");
  const MatValue photons = data.at("photons");
  PhotonCube cube{photons.numbers(), {}, 0, 0, 0};
  const std::vector<std::size_t>& dimensions = cube.numbers.dimensions();
  if (dimensions.size() > 3) photons.fail("must be rows x columns x bands");
  cube.scale = rescaling(cube.numbers, data, "dmin", "dmax");
  // The structure check has bounded each of them by 2^31.
  cube.rows = static_cast<int>(dimensions[0]);
  cube.columns = static_cast<int>(dimensions[1]);
  cube.bands = dimensions.size() == 3 ? static_cast<int>(dimensions[2]) : 1;
  return cube;
}

double angle_deg(const MatValue& scene, std::optional<double> if_absent) {
  if (const std::optional<MatValue> angle = scene.find("wAngular")) return angle->number();
  if (if_absent) return *if_absent;
  scene.fail("has no wAngular: its horizontal angle must be given (`scene.horizontal_angle_deg`)");
}

std::optional<double> distance_m(const MatValue& scene) {
  const std::optional<MatValue> distance = scene.find("distance");
  if (!distance) return std::nullopt;
  const double metres = distance->number();
  if (!(metres > 0))
    distance->fail(fmt::format("is {} m; a positive distance or Inf would be right", metres));
  return std::isinf(metres) ? std::nullopt : std::optional(metres);
}

/// MATLAB keeps columns together, we keep rows together.
std::size_t matlab_index(const Scene& scene, std::size_t row, std::size_t column) {
  return column * static_cast<std::size_t>(scene.rows()) + row;
}

void take_radiance(Scene& scene, const PhotonCube& cube) {
  const std::size_t width = static_cast<std::size_t>(scene.columns());
  parallel_for(static_cast<std::size_t>(scene.bands()), [&](std::size_t index) {
    const double joules = photon_energy_j(scene.wavelengths_nm()[index]);
    const std::span<float> band = scene.band(static_cast<int>(index));
    for (std::size_t i = 0; i < band.size(); ++i) {
      const std::size_t from = index * band.size() + matlab_index(scene, i / width, i % width);
      band[i] = static_cast<float>(joules * cube.scale(cube.numbers[from]));
    }
  });
}

void take_depth(Scene& scene, const MatValue& file) {
  const std::optional<MatValue> map = file.find("depthMap");
  if (!map) return;
  const MatNumbers depth = map->numbers();
  const std::vector<std::size_t> expected = {static_cast<std::size_t>(scene.rows()),
                                             static_cast<std::size_t>(scene.columns())};
  if (depth.dimensions() != expected) map->fail("must be as large as the picture");
  scene.depth_m.resize(scene.band_size());
  for (std::size_t i = 0; i < scene.depth_m.size(); ++i) {
    const double metres = depth[matlab_index(scene, i / expected[1], i % expected[1])];
    if (!(metres >= 0)) map->fail(fmt::format("has a depth of {} m", metres));
    scene.depth_m[i] = static_cast<float>(metres);
  }
}

}  // namespace

std::optional<Spectrum> iset_illuminant(const MatValue& illuminant, const std::vector<double>& bands_nm) {
  const std::optional<MatValue> data = illuminant.find("data");
  if (!data || !data->is_struct()) return std::nullopt;
  const std::optional<MatValue> photons = data->find("photons");
  const std::optional<MatValue> energy = photons ? std::nullopt : data->find("energy");
  if (!photons && !energy) return std::nullopt;

  const std::optional<MatValue> own = illuminant.find("spectrum");
  std::vector<double> wavelengths = own ? own->at("wave").numbers().values() : bands_nm;
  const MatNumbers stored = (photons ? *photons : *energy).numbers();
  if (stored.size() != wavelengths.size()) return std::nullopt;
  const Rescaling scale = rescaling(stored, *data, "min", "max");
  std::vector<double> values;
  for (std::size_t i = 0; i < stored.size(); ++i)
    values.push_back(scale(stored[i]) * (photons ? photon_energy_j(wavelengths[i]) : 1.0));
  return Spectrum(std::move(wavelengths), std::move(values));
}

namespace {

Scene scene_of(const MatValue& file, std::optional<double> horizontal_angle_deg) {
  if (!file.is_struct()) file.fail("is no struct, so no ISET scene");
  const PhotonCube cube = photon_cube(file);
  const MatValue wave = file.at("spectrum").at("wave");
  if (wave.numbers().size() != static_cast<std::size_t>(cube.bands))
    wave.fail(fmt::format("has {} wavelengths for {} bands", wave.numbers().size(), cube.bands));
  Scene scene(cube.columns, cube.rows, wave.numbers().values(), angle_deg(file, horizontal_angle_deg),
              distance_m(file));
  take_radiance(scene, cube);
  take_depth(scene, file);
  if (const std::optional<MatValue> illuminant = file.find("illuminant"))
    scene.illuminant = iset_illuminant(*illuminant, scene.wavelengths_nm());
  if (const std::optional<MatValue> name = file.find("name")) scene.name = name->text();
  scene.validate();
  return scene;
}

}  // namespace

double photon_energy_j(double wavelength_nm) {
  constexpr double planck_j_s = 6.62607015e-34, light_m_per_s = 299792458.0, m_per_nm = 1e-9;
  return planck_j_s * light_m_per_s / (wavelength_nm * m_per_nm);
}

Scene read_iset_mat(const std::string& path, std::optional<double> horizontal_angle_deg) {
  const MatFile file(path, {"scene", "mcCOEF", "basis", "imgMean", "illuminant", "fov", "dist", "name"});
  return naming_file(path, [&] {
    if (!file.find("scene") && has_iset_basis(file)) return read_iset_basis(file, horizontal_angle_deg);
    return scene_of(file.at("scene"), horizontal_angle_deg);
  });
}

}  // namespace petzval
