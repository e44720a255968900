// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/scene/formats/iset_basis.h>
#include <petzval/scene/formats/iset_mat.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// The linear model: photons[w] = mean[w] + Σ_k coefficient[k] · functions[w + k · wavelengths].
struct Model {
  std::vector<double> wavelengths_nm, functions, mean;
  std::size_t count = 0;  ///< of functions
};

Model model_of(const MatFile& file) {
  const MatValue basis = file.at("basis");
  Model model;
  model.wavelengths_nm = basis.at("wave").numbers().values();
  const MatValue stored = basis.at("basis");
  const MatNumbers functions = stored.numbers();
  if (functions.dimensions().size() != 2 || functions.dimensions()[0] != model.wavelengths_nm.size())
    stored.fail(fmt::format("must have a row for each of the {} wavelengths of basis.wave",
                            model.wavelengths_nm.size()));
  model.functions = functions.values();
  model.count = functions.dimensions()[1];
  model.mean.assign(model.wavelengths_nm.size(), 0);
  if (const std::optional<MatValue> mean = file.find("imgMean")) {
    if (mean->numbers().size() != model.mean.size())
      mean->fail(fmt::format("has {} numbers for {} wavelengths", mean->numbers().size(), model.mean.size()));
    model.mean = mean->numbers().values();
  }
  return model;
}

/// The first of these variables that is there, as a number.
std::optional<double> number_of(const MatFile& file, const char* name) {
  const std::optional<MatValue> value = file.find(name);
  return value ? std::optional(value->number()) : std::nullopt;
}

std::optional<double> distance_m(const MatFile& file) {
  const std::optional<double> metres = number_of(file, "dist");
  if (metres && !(*metres > 0))
    file.at("dist").fail(fmt::format("is {} m; a positive distance or Inf would be right", *metres));
  return metres && std::isinf(*metres) ? std::nullopt : metres;
}

double angle_deg(const MatFile& file, std::optional<double> if_absent) {
  if (const std::optional<double> fov = number_of(file, "fov")) return *fov;
  if (if_absent) return *if_absent;
  throw InputError(
      file.path(),
      "has no variable 'fov': its horizontal angle must be given (`scene.horizontal_angle_deg`)");
}

/// An illuminant as ISET's files of before 2012 have it: wavelengths, and energy at them.
std::optional<Spectrum> plain_illuminant(const MatValue& illuminant) {
  const std::optional<MatValue> data = illuminant.find("data");
  std::optional<MatValue> wave = illuminant.find("wavelength");
  if (!wave) wave = illuminant.find("wave");
  if (!data || data->is_struct() || !wave) return std::nullopt;
  if (data->numbers().size() != wave->numbers().size()) return std::nullopt;
  return Spectrum(wave->numbers().values(), data->numbers().values());
}

std::optional<Spectrum> illuminant_of(const MatFile& file, const Model& model) {
  const std::optional<MatValue> illuminant = file.find("illuminant");
  if (!illuminant || !illuminant->is_struct()) return std::nullopt;
  if (std::optional<Spectrum> plain = plain_illuminant(*illuminant)) return plain;
  return iset_illuminant(*illuminant, model.wavelengths_nm);
}

void take_radiance(const MatNumbers& coefficients, const Model& model, Scene& scene) {
  const auto width = static_cast<std::size_t>(scene.columns()),
             height = static_cast<std::size_t>(scene.rows());
  const std::size_t waves = model.wavelengths_nm.size();
  parallel_for(waves, [&](std::size_t wave) {
    const double joules = photon_energy_j(model.wavelengths_nm[wave]);
    const std::span<float> band = scene.band(static_cast<int>(wave));
    for (std::size_t i = 0; i < band.size(); ++i) {
      const std::size_t at = i % width * height + i / width;  // MATLAB keeps columns together
      double photons = model.mean[wave];
      for (std::size_t k = 0; k < model.count; ++k)
        photons += coefficients[k * band.size() + at] * model.functions[k * waves + wave];
      // NaN stays, to be refused.
      band[i] = static_cast<float>(joules * (photons < 0 ? 0 : photons));
    }
  });
}

}  // namespace

bool has_iset_basis(const MatFile& file) {
  return file.find("mcCOEF") && file.find("basis");
}

Scene read_iset_basis(const MatFile& file, std::optional<double> horizontal_angle_deg) {
  const Model model = model_of(file);
  const MatValue stored = file.at("mcCOEF");
  const MatNumbers coefficients = stored.numbers();
  const std::vector<std::size_t>& sides = coefficients.dimensions();
  const std::size_t count = sides.size() == 3 ? sides[2] : 1;
  if (sides.size() > 3 || count != model.count)
    stored.fail(fmt::format("must be rows x columns x {} functions of the basis", model.count));
  Scene scene(static_cast<int>(sides[1]), static_cast<int>(sides[0]), model.wavelengths_nm,
              angle_deg(file, horizontal_angle_deg), distance_m(file));
  take_radiance(coefficients, model, scene);
  scene.illuminant = illuminant_of(file, model);
  if (const std::optional<MatValue> name = file.find("name")) scene.name = name->text();
  scene.validate();
  return scene;
}

}  // namespace petzval
