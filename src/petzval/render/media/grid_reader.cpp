// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/media/grid_reader.h>

#include <algorithm>

namespace petzval::render {

GridBox read_grid_box(const MediumDescription& description) {
  const Parameters& parameters = description.entity.parameters;
  GridBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const char* name = std::array{"nx", "ny", "nz"}[axis];
    box.cells[axis] = parameters.integer(name, 1);
    if (box.cells[axis] < 1) throw scene_error(parameters.location_of(name), "1 or more would be right");
  }
  const auto corner = [&](const char* name, double otherwise) {
    const auto p = parameters.triple(name);
    return p ? Vector3{(*p)[0], (*p)[1], (*p)[2]} : Vector3{otherwise, otherwise, otherwise};
  };
  const Vector3 p0 = corner("p0", 0), p1 = corner("p1", 1);
  box.low = {std::min(p0.x, p1.x), std::min(p0.y, p1.y), std::min(p0.z, p1.z)};
  box.high = {std::max(p0.x, p1.x), std::max(p0.y, p1.y), std::max(p0.z, p1.z)};
  return box;
}

std::vector<float> read_grid_samples(const Parameters& parameters, const char* name, const GridBox& box,
                                     double least, const char* what) {
  const std::vector<double> numbers = parameters.numbers(name, {"float", "integer"});
  if (static_cast<double>(numbers.size()) != box.count())
    throw scene_error(parameters.location_of(name),
                      fmt::format("{} samples of the {}; nx × ny × nz = {} x {} x {} would be right",
                                  numbers.size(), what, box.cells[0], box.cells[1], box.cells[2]));
  std::vector<float> values;
  values.reserve(numbers.size());
  for (const double each : numbers) {
    if (!(each >= least && each <= densest))
      throw scene_error(parameters.location_of(name),
                        fmt::format("a {} of {:g}; {:g} to {:g} would be right", what, each, least, densest));
    values.push_back(static_cast<float>(each));
  }
  return values;
}

std::vector<double> read_grid_colours(const Parameters& parameters, const char* name, const GridBox& box) {
  std::vector<double> numbers = parameters.numbers(name, {"rgb"});
  if (static_cast<double>(numbers.size()) != 3 * box.count())
    throw scene_error(parameters.location_of(name),
                      fmt::format("{} numbers of colours; 3 × nx × ny × nz = 3 x {} x {} x {} would be right",
                                  numbers.size(), box.cells[0], box.cells[1], box.cells[2]));
  for (const double each : numbers)
    if (!(each >= 0 && each <= densest))
      throw scene_error(parameters.location_of(name),
                        fmt::format("a part of a colour of {:g}; 0 to {:g} would be right", each, densest));
  return numbers;
}

std::shared_ptr<const DensityGrid> make_density_grid(const MediumDescription& description, const GridBox& box,
                                                     std::vector<float> values) {
  const Parameters& parameters = description.entity.parameters;
  if (!description.world_from_medium.is_affine())
    throw scene_error(parameters.location(), "a medium in a transformation that is not affine");
  try {
    return std::make_shared<const DensityGrid>(box.cells, std::move(values), box.low, box.high,
                                               description.world_from_medium);
  } catch (const InputError&) {
    throw scene_error(parameters.location_of("p1"),
                      "a box without volume; p0 and p1 are opposite corners of it");
  }
}

}  // namespace petzval::render
