// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/interpolation.h>
#include <petzval/optics/formats/iset_mat_table.h>
#include <petzval/scene/formats/mat_file.h>
#include <petzval/scene/formats/mat_writer.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// What ISET calls the variables that hold a rayTrace structure, or are one.
const std::vector<std::string> usual_names{"optics", "rayTrace", "oi", "opticalimage", "rt"};

bool is_ray_trace(const MatValue& variable) {
  return variable.is_struct() && variable.find("geometry") && variable.find("relIllum") &&
         variable.find("psf");
}

/// The variable that holds the table, or is it: one of the usual names, or else the first that looks so.
/// \param file  is read with the names of all where none is usual.
MatValue table_variable(const std::string& path, std::optional<MatFile>& file) {
  const auto first_of = [&](const std::vector<std::string>& names) -> std::optional<MatValue> {
    for (const std::string& name : names)
      if (const std::optional<MatValue> variable = file->find(name)) return variable;
    return std::nullopt;
  };
  file.emplace(path, usual_names);
  if (const auto usual = first_of(usual_names)) return *usual;
  const std::vector<std::string> names = mat_variable_names(path);
  if (!names.empty()) file.emplace(path, names);
  for (const std::string& name : names)
    if (const std::optional<MatValue> variable = file->find(name); variable && variable->is_struct())
      if (is_ray_trace(*variable) || variable->find("rayTrace") || variable->find("optics")) return *variable;
  file.emplace(path, usual_names);
  return file->first();  // says what would be right
}

/// The optics structure, or nothing where the file holds a rayTrace structure alone.
std::optional<MatValue> optics_of(const MatValue& variable) {
  if (variable.name() == "rayTrace" || is_ray_trace(variable)) return std::nullopt;
  if (variable.name() == "oi" || variable.name() == "opticalimage") return variable.at("optics");
  if (variable.name() == "optics" || variable.find("rayTrace")) return variable;
  return variable.find("optics") ? variable.find("optics") : std::nullopt;
}

/// What ISET multiplies the light by: linear between its wavelengths, 1 beyond. Empty if it is 1 throughout.
std::vector<double> transmittance_of(const MatValue& optics, const std::vector<double>& wavelengths_nm) {
  const std::optional<MatValue> holder = optics.find("transmittance");
  if (!holder || !holder->is_struct() || !holder->find("wave") || !holder->find("scale")) return {};
  const std::vector<double> waves = holder->at("wave").numbers().values();
  const std::vector<double> scale = holder->at("scale").numbers().values();
  if (waves.size() != scale.size() || !std::is_sorted(waves.begin(), waves.end(), std::less_equal<>()))
    holder->fail("must have as many scales as wavelengths, and wavelengths that increase");
  for (const double value : scale)
    if (!(value >= 0 && value <= 1))
      holder->fail(fmt::format("has a scale of {}; 0 to 1 would be right", value));
  std::vector<double> values;
  for (const double nm : wavelengths_nm) {
    const bool outside = waves.size() < 2 || !(nm >= waves.front() && nm <= waves.back());
    const std::size_t i = outside ? 0 : bracket(waves, nm);
    values.push_back(
        outside ? 1 : scale[i] + (scale[i + 1] - scale[i]) * (nm - waves[i]) / (waves[i + 1] - waves[i]));
  }
  const bool clear = std::all_of(values.begin(), values.end(), [](double value) { return value == 1; });
  return clear ? std::vector<double>() : values;
}

double number_or_unknown(const MatValue& holder, const char* field) {
  const std::optional<MatValue> value = holder.find(field);
  return value ? value->number() : RayTraceData::unknown;
}

std::string text_or_nothing(const MatValue& holder, const char* field) {
  const std::optional<MatValue> value = holder.find(field);
  return value ? value->text() : "";
}

void require_axes(const MatValue& holder, const RayTraceData& data) {
  const auto heights = holder.at("fieldHeight").numbers().values();
  const auto waves = holder.at("wavelength").numbers().values();
  if (heights != data.field_height_mm || waves != data.wavelengths_nm)
    holder.fail(
        "has other field heights or wavelengths than geometry; they must be the same for geometry, relIllum "
        "and psf");
}

/// function[height × wave], which MATLAB keeps height by height.
std::vector<double> by_field(const MatValue& holder, const RayTraceData& data) {
  require_axes(holder, data);
  const MatValue function = holder.at("function");
  const MatNumbers numbers = function.numbers();
  const std::size_t fields = data.field_height_mm.size(), waves = data.wavelengths_nm.size();
  if (numbers.dimensions() != std::vector<std::size_t>{fields, waves})
    function.fail(fmt::format("must be {} x {}: field heights x wavelengths", fields, waves));
  std::vector<double> values;
  for (std::size_t f = 0; f < fields; ++f)
    for (std::size_t w = 0; w < waves; ++w) {
      values.push_back(numbers[w * fields + f]);
      if (!std::isfinite(values.back()))
        function.fail(fmt::format("is {} at height {} and wavelength {}", values.back(), f + 1, w + 1));
    }
  return values;
}

/// psf.function, unpacked one PSF at a time.
class PsfStack {
 public:
  PsfStack(const MatValue& psf, const RayTraceData& data)
      : function_(psf.at("function")), numbers_(function_.numbers()), fields_(data.field_height_mm.size()) {
    std::vector<std::size_t> expected = numbers_.dimensions();
    expected.resize(4, 1);
    const std::size_t waves = data.wavelengths_nm.size();
    if (numbers_.dimensions().size() > 4 || expected[0] != expected[1] || expected[2] != fields_ ||
        expected[3] != waves)
      function_.fail(
          fmt::format("must be N x N x {} x {}: rows, columns, field heights, wavelengths", fields_, waves));
    size_ = static_cast<int>(expected[0]);
  }

  int size() const { return size_; }
  const MatValue& function() const { return function_; }

  NumberGrid grid(std::size_t field, std::size_t wave) const {
    const auto side = static_cast<std::size_t>(size_), from = (wave * fields_ + field) * side * side;
    NumberGrid grid{size_, size_, std::vector<double>(side * side)};
    for (std::size_t row = 0; row < side; ++row)
      for (std::size_t column = 0; column < side; ++column)
        grid.values[row * side + column] = numbers_[from + column * side + row];
    return grid;
  }

 private:
  MatValue function_;
  MatNumbers numbers_;
  std::size_t fields_ = 0;
  int size_ = 0;
};

/// The outer half of the field, where a PSF has a direction, at one wavelength.
std::optional<PsfMirror> mirror_of(const PsfStack& stack, const RayTraceData& data) {
  std::vector<NumberGrid> outer;
  for (std::size_t f = data.field_height_mm.size() / 2; f < data.field_height_mm.size(); ++f)
    outer.push_back(stack.grid(f, data.wavelengths_nm.size() / 2));
  return find_mirror(outer);
}

PsfFrame frame_of(const PsfStack& stack, const PsfLie& lie, RayTraceFile& file) {
  // rtPsfSupport has its zero at sample size/2, counted from 1.
  const int middle = std::max(stack.size() / 2 - 1, 0);
  PsfFrame frame{PsfAway::right, middle, middle};
  if (file.data.kept.empty()) {
    const std::optional<PsfMirror> mirror = mirror_of(stack, file.data);
    if (mirror && mirror->upright) {
      frame = {PsfAway::up, middle, mirror->centre};
      if (!lie.away)
        file.notes.push_back(
            "the PSFs are mirror symmetric about a column, as rtImportData leaves those of Zemax: away from "
            "the axis is taken to be up (`psf_away` sets another)");
    } else if (mirror) {
      frame = {PsfAway::right, mirror->centre, mirror->centre};
    }
  }
  if (lie.away) frame.away = *lie.away;
  if (lie.centre) {
    frame.centre_row = lie.centre->first - 1;
    frame.centre_column = lie.centre->second - 1;
  }
  return frame;
}

double spacing_um(const MatValue& psf) {
  const MatValue spacing = psf.at("sampleSpacing");
  const std::vector<double> mm = spacing.numbers().values();
  if (mm.size() > 2 || !(std::isfinite(mm.front()) && mm.front() > 0) || mm.back() != mm.front())
    spacing.fail("must be one spacing in mm, or two equal ones: samples are square");
  return mm.front() * um_per_mm;
}

void take_psfs(const MatValue& psf, const PsfLie& lie, RayTraceFile& file) {
  require_axes(psf, file.data);
  const PsfStack stack(psf, file.data);
  const double spacing = spacing_um(psf);
  const PsfFrame frame = frame_of(stack, lie, file);
  for (std::size_t f = 0; f < file.data.field_height_mm.size(); ++f)
    for (std::size_t w = 0; w < file.data.wavelengths_nm.size(); ++w) try {
        file.data.psf.push_back(psf_of_grid(stack.grid(f, w), frame, spacing));
      } catch (const InputError& error) {
        stack.function().fail(fmt::format("at height {} and wavelength {}: {}", f + 1, w + 1, error.what()));
      }
}

MatItem curves_item(const RayTraceData& data, const std::vector<double>& by_field) {
  const std::size_t fields = data.field_height_mm.size(), waves = data.wavelengths_nm.size();
  std::vector<double> values;
  for (std::size_t w = 0; w < waves; ++w)
    for (std::size_t f = 0; f < fields; ++f) values.push_back(by_field[f * waves + w]);
  return {MatItem::Fields{{"function", {MatDoubles{{fields, waves}, std::move(values)}}},
                          {"fieldHeight", MatItem::column(data.field_height_mm)},
                          {"wavelength", MatItem::column(data.wavelengths_nm)}}};
}

MatItem psf_item(const RayTraceData& data) {
  const std::size_t fields = data.field_height_mm.size(), waves = data.wavelengths_nm.size();
  int largest = 0;
  for (const Psf& psf : data.psf) largest = std::max(largest, psf.size);
  const int size = largest + 2 - largest % 2;  // even, as ISET wants it, with room behind sample size/2
  const PsfFrame frame{PsfAway::right, size / 2 - 1, size / 2 - 1};
  const auto side = static_cast<std::size_t>(size);
  MatDoubles function{{side, side, fields, waves}, {}};
  function.values.reserve(side * side * fields * waves);
  for (std::size_t w = 0; w < waves; ++w)
    for (std::size_t f = 0; f < fields; ++f) {
      const NumberGrid grid = grid_of_psf(data.psf[f * waves + w], frame, size);
      for (int column = 0; column < size; ++column)
        for (int row = 0; row < size; ++row) function.values.push_back(grid.at(row, column));
    }
  const double spacing_mm = data.psf.front().spacing_um * mm_per_um;
  return {MatItem::Fields{{"function", {std::move(function)}},
                          {"fieldHeight", MatItem::column(data.field_height_mm)},
                          {"wavelength", MatItem::column(data.wavelengths_nm)},
                          {"sampleSpacing", {MatDoubles{{1, 2}, {spacing_mm, spacing_mm}}}}}};
}

/// ISET does not do without it; light that the lens takes is in the illumination.
MatItem clear_glass(const std::vector<double>& wavelengths_nm) {
  const double beside = 1;
  return {MatItem::Fields{
      {"wave", MatItem::column({wavelengths_nm.front() - beside, wavelengths_nm.back() + beside})},
      {"scale", MatItem::column({1, 1})}}};
}

}  // namespace

RayTraceFile read_iset_mat_table(const std::string& path, const PsfLie& lie) {
  std::optional<MatFile> mat;
  const MatValue variable = table_variable(path, mat);
  const std::optional<MatValue> optics = optics_of(variable);
  const MatValue trace = optics ? optics->at("rayTrace") : variable;
  RayTraceFile file;
  RayTraceData& data = file.data;
  data.program = text_or_nothing(trace, "program");
  data.lens_file = text_or_nothing(trace, "lensFile");
  data.reference_wavelength_nm = number_or_unknown(trace, "referenceWavelength");
  data.object_distance_mm = number_or_unknown(trace, "objectDistance");
  data.magnification = number_or_unknown(trace, "mag");
  data.f_number = number_or_unknown(trace, "fNumber");
  data.effective_f_number = number_or_unknown(trace, "effectiveFNumber");
  data.effective_focal_length_mm = number_or_unknown(trace, "effectiveFocalLength");
  data.field_of_view_deg = number_or_unknown(trace, "fov");
  data.kept = text_or_nothing(trace, "petzval");
  const MatValue geometry = trace.at("geometry");
  data.field_height_mm = geometry.at("fieldHeight").numbers().values();
  data.wavelengths_nm = geometry.at("wavelength").numbers().values();
  if (optics) data.transmittance = transmittance_of(*optics, data.wavelengths_nm);
  data.distorted_height_mm = by_field(geometry, data);
  data.relative_illumination = by_field(trace.at("relIllum"), data);
  take_psfs(trace.at("psf"), lie, file);
  return file;
}

void write_iset_mat_table(const RayTraceData& data, const std::string& path) {
  const MatItem trace{
      MatItem::Fields{{"name", {data.lens_file}},
                      {"program", {data.program}},
                      {"lensFile", {data.lens_file}},
                      {"referenceWavelength", MatItem::number(data.reference_wavelength_nm)},
                      {"objectDistance", MatItem::number(data.object_distance_mm)},
                      {"mag", MatItem::number(data.magnification)},
                      {"fNumber", MatItem::number(data.f_number)},
                      {"effectiveFocalLength", MatItem::number(data.effective_focal_length_mm)},
                      {"effectiveFNumber", MatItem::number(data.effective_f_number)},
                      {"fov", MatItem::number(data.field_of_view_deg)},
                      {"geometry", curves_item(data, data.distorted_height_mm)},
                      {"relIllum", curves_item(data, data.relative_illumination)},
                      {"psf", psf_item(data)},
                      {"petzval", {data.kept}}}};
  const MatItem optics{
      MatItem::Fields{{"type", {std::string("optics")}},
                      {"name", {data.lens_file}},
                      {"model", {std::string("raytrace")}},
                      {"fNumber", MatItem::number(data.f_number)},
                      {"focalLength", MatItem::number(data.effective_focal_length_mm / mm_per_m)},
                      {"transmittance", clear_glass(data.wavelengths_nm)},
                      {"rayTrace", trace}}};
  write_mat(path, "optics", optics);
}

}  // namespace petzval
