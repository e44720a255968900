// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_values.h>
#include <petzval/report/analysis_tables.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

namespace petzval {

namespace {

constexpr double gap = std::numeric_limits<double>::quiet_NaN();

template <class Row>
struct Column {
  TableColumn column;
  std::function<TableCell(const Row&)> value;
};

TableColumn field_column(Fields::Kind kind) {
  const std::string name = to_string(kind);
  return {name.substr(0, name.rfind('_')), field_unit(kind), 3, "field"};
}

const TableColumn wavelength_column{"wavelength", "nm", 2, "wavelength_nm"};
const TableColumn height_column{"image height", "mm", 5, "real_image_height_mm"};
const TableColumn set_height_column{"image height", "mm", 5, "real_image_height_mm", {"", ".6f", 19}};

/// Whether a terminal has a table in columns of set widths, with the field as short as it can be written.
enum class Layout { fitted, set };

template <class Row>
Table make(Fields::Kind kind, const std::vector<Row>& rows, const std::vector<Column<Row>>& columns,
           Layout layout = Layout::fitted) {
  Table table{{field_column(kind), wavelength_column}, {}};
  if (layout == Layout::set) {
    table.columns[0].text = {"", "g", 28};
    table.columns[1].text = {"", "g", 16, "all"};
  }
  for (const Column<Row>& each : columns) table.columns.push_back(each.column);
  for (const Row& row : rows) {
    std::vector<TableCell> cells{row.field, row.wavelength_nm > 0 ? row.wavelength_nm : gap};
    for (const Column<Row>& each : columns) cells.push_back(each.value(row));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

std::string surface_text(int surface) {
  return surface < 0 ? "" : fmt::format("{}", surface);
}

}  // namespace

Table tabulate(Fields::Kind kind, const std::vector<SpotRow>& rows) {
  using Row = SpotRow;
  return make<Row>(kind, rows,
                   {{set_height_column, [](const Row& row) { return row.real_image_height_mm; }},
                    {{"centroid", "µm", 3, "centroid_um", {"centroid [um]", ".4f", 15}},
                     [](const Row& row) { return row.centroid_um; }},
                    {{"RMS radius", "µm", 3, "rms_radius_um", {"RMS [um]", ".4f", 10}},
                     [](const Row& row) { return row.rms_radius_um; }},
                    {{"RMS x", "µm", 3, "rms_x_um", {"RMS x [um]", ".4f", 12}},
                     [](const Row& row) { return row.rms_x_um; }},
                    {{"RMS y", "µm", 3, "rms_y_um", {"RMS y [um]", ".4f", 12}},
                     [](const Row& row) { return row.rms_y_um; }},
                    {{"100 % radius", "µm", 3, "max_radius_um", {"max [um]", ".4f", 10}},
                     [](const Row& row) { return row.max_radius_um; }},
                    {{"Airy radius", "µm", 3, "airy_radius_um", {"Airy [um]", ".4f", 11}},
                     [](const Row& row) { return row.airy_radius_um; }}},
                   Layout::set);
}

Table tabulate(Fields::Kind kind, const std::vector<WavefrontRow>& rows) {
  using Row = WavefrontRow;
  return make<Row>(
      kind, rows,
      {{set_height_column, [](const Row& row) { return row.real_image_height_mm; }},
       {{"RMS", "waves", 4, "rms_waves", {"", ".5f", 13}}, [](const Row& row) { return row.rms_waves; }},
       {{"RMS without tilt", "waves", 4, "rms_without_tilt_waves", {"without tilt [waves]", ".5f", 21}},
        [](const Row& row) { return row.rms_without_tilt_waves; }},
       {{"PV", "waves", 4, "pv_waves", {"", ".4f", 12}}, [](const Row& row) { return row.pv_waves; }},
       {{"Strehl", "", 4, "strehl", {"", ".5f", 10}}, [](const Row& row) { return row.strehl; }},
       {{"", "mm", 5, "reference_sphere_radius_mm"},
        [](const Row& row) { return row.reference_sphere_radius_mm; }}},
      Layout::set);
}

Table tabulate(Fields::Kind kind, const std::vector<MtfRow>& rows) {
  using Row = MtfRow;
  const bool moved =
      std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.sensor_shift_mm != 0; });
  if (moved)
    return make<Row>(
        kind, rows,
        {{{"frequency", "cycles/mm", 2, "frequency_cpmm"}, [](const Row& row) { return row.frequency_cpmm; }},
         {{"tangential", "", 4, "tangential"}, [](const Row& row) { return row.tangential; }},
         {{"sagittal", "", 4, "sagittal"}, [](const Row& row) { return row.sagittal; }},
         {{"sensor shift", "mm", 4, "sensor_shift_mm"}, [](const Row& row) { return row.sensor_shift_mm; }}});
  return make<Row>(
      kind, rows,
      {{{"frequency", "cycles/mm", 2, "frequency_cpmm", {"", "g", 22}},
        [](const Row& row) { return row.frequency_cpmm; }},
       {{"tangential", "", 4, "tangential", {"", "", 11}}, [](const Row& row) { return row.tangential; }},
       {{"sagittal", "", 4, "sagittal", {"", "", 9}}, [](const Row& row) { return row.sagittal; }}},
      Layout::set);
}

Table tabulate(Fields::Kind kind, const std::vector<EncircledEnergyRow>& rows) {
  using Row = EncircledEnergyRow;
  return make<Row>(kind, rows,
                   {{{"radius", "µm", 3, "radius_um", {"radius [um]", ".4g", 12}},
                     [](const Row& row) { return row.radius_um; }},
                    {{"encircled energy", "", 5, "encircled_energy", {"", "", 17}},
                     [](const Row& row) { return row.encircled_energy; }},
                    {{"Airy", "", 5, "airy", {"", "", 9}}, [](const Row& row) { return row.airy; }}},
                   Layout::set);
}

namespace {

/// Says of rows without light that they have none.
template <class Row>
Table remark_on_dark(Table table, const std::vector<Row>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (!rows[i].lit) table.remarks[i] = "no ray passes";
  return table;
}

}  // namespace

Table tabulate(Fields::Kind kind, const std::vector<DistortionRow>& rows) {
  using Row = DistortionRow;
  std::vector<Column<Row>> columns{
      {{"image height", "mm", 5, "image_height_mm", {"", ".6f", 19}},
       [](const Row& row) { return row.image_height_mm; }},
      {{"paraxial height", "mm", 5, "paraxial_image_height_mm", {"", ".6f", 23}},
       [](const Row& row) { return row.paraxial_image_height_mm; }},
      {{"distortion", "%", 3, "distortion_percent", {"", ".4f", 16}},
       [](const Row& row) { return row.distortion_percent; }},
      {{"paraxial", "%", 3, "paraxial_distortion_percent", {"", ".4f", 14}},
       [](const Row& row) { return row.paraxial_distortion_percent; }},
      {{"against f·θ", "%", 3, "distortion_ftheta_percent", {"f-theta [%]", ".4f", 13}},
       [](const Row& row) { return row.distortion_ftheta_percent.value_or(gap); }}};
  // Of lenses with poses.
  if (std::ranges::any_of(rows, [](const Row& row) {
        return std::abs(row.image_x_mm) > 0 || std::abs(row.across_percent) > 0;
      })) {
    columns.push_back({{"beside the field", "mm", 5, "image_x_mm", {"", ".6f", 24}},
                       [](const Row& row) { return row.image_x_mm; }});
    columns.push_back({{"beside the field", "%", 3, "across_percent", {"", ".4f", 22}},
                       [](const Row& row) { return row.across_percent; }});
  }
  columns.push_back({{"", "", 0, "lit"}, [](const Row& row) { return row.lit; }});
  return remark_on_dark(make<Row>(kind, rows, columns, Layout::set), rows);
}

Table tabulate(const std::vector<TvDistortion>& rows) {
  Table table{{{"wavelength", "nm", 2, "wavelength_nm"},
               {"TV distortion (SMIA)", "%", 4, "smia_percent"},
               {"of picture height", "%", 4, "picture_height_percent"}},
              {}};
  for (const TvDistortion& row : rows)
    table.rows.push_back({row.wavelength_nm, row.smia_percent, row.picture_height_percent});
  return table;
}

Table tabulate(const DistortionGrid& grid) {
  Table table{{{"line", "", 0, "row"},
               {"crossing", "", 0, "column"},
               {"ideal x", "mm", 5, "ideal_x_mm"},
               {"ideal y", "mm", 5, "ideal_y_mm"},
               {"x", "mm", 5, "x_mm"},
               {"y", "mm", 5, "y_mm"}},
              {}};
  for (std::size_t i = 0; i < grid.x_mm.size(); ++i) {
    const int row = static_cast<int>(i) / grid.lines, column = static_cast<int>(i) % grid.lines;
    table.rows.push_back(
        {double(row), double(column), grid.ideal_x_mm[i], grid.ideal_y_mm[i], grid.x_mm[i], grid.y_mm[i]});
  }
  return table;
}

Table tabulate(Fields::Kind kind, const std::vector<Footprint>& footprints) {
  Table table{
      {{"surface", "", 0, "surface"}, field_column(kind), {"x", "mm", 5, "x_mm"}, {"y", "mm", 5, "y_mm"}},
      {}};
  for (const Footprint& each : footprints)
    for (std::size_t i = 0; i < each.x_mm.size(); ++i)
      table.rows.push_back({double(each.surface), each.field, each.x_mm[i], each.y_mm[i]});
  return table;
}

Table tabulate(Fields::Kind kind, const std::vector<IlluminationRow>& rows) {
  using Row = IlluminationRow;
  return remark_on_dark(
      make<Row>(kind, rows,
                {{set_height_column, [](const Row& row) { return row.real_image_height_mm; }},
                 {{"", "", 0, "lit"}, [](const Row& row) { return row.lit; }},
                 {{"", "", 0, "pupil_in_one_piece"}, [](const Row& row) { return row.pupil_in_one_piece; }},
                 {{"g_sensor", "sr", 5, "g_sensor_sr", {"", ".6f", 15}},
                  [](const Row& row) { return row.g_sensor_sr; }},
                 {{"g_source", "sr", 5, "g_source_sr", {"", ".6f", 15}},
                  [](const Row& row) { return row.g_source_sr; }},
                 {{"relative illumination", "", 4, "relative_illumination", {"", ".5f", 23}},
                  [](const Row& row) { return row.relative_illumination; }}},
                Layout::set),
      rows);
}

Table tabulate(Fields::Kind kind, const std::vector<FieldCurvatureRow>& rows) {
  using Row = FieldCurvatureRow;
  return make<Row>(
      kind, rows,
      {{height_column, [](const Row& row) { return row.real_image_height_mm; }},
       {{"tangential focus", "mm", 5, "tangential_mm"}, [](const Row& row) { return row.tangential_mm; }},
       {{"sagittal focus", "mm", 5, "sagittal_mm"}, [](const Row& row) { return row.sagittal_mm; }},
       {{"astigmatism", "mm", 5, "astigmatism_mm"},
        [](const Row& row) { return row.tangential_mm - row.sagittal_mm; }},
       {{"Petzval", "mm", 5, "petzval_mm"}, [](const Row& row) { return row.petzval_mm; }}});
}

Table tabulate(Fields::Kind kind, const std::vector<LateralColourRow>& rows) {
  using Row = LateralColourRow;
  std::vector<Column<Row>> columns{{height_column, [](const Row& row) { return row.real_image_height_mm; }},
                                   {{"lateral colour", "µm", 4, "lateral_colour_um"},
                                    [](const Row& row) { return row.lateral_colour_um; }}};
  if (std::ranges::any_of(rows, [](const Row& row) { return std::abs(row.across_um) > 0; }))
    columns.push_back(
        {{"beside the field", "µm", 4, "across_um"}, [](const Row& row) { return row.across_um; }});
  return make<Row>(kind, rows, columns);
}

Table tabulate(Fields::Kind kind, const std::vector<VignettingRow>& rows) {
  using Row = VignettingRow;
  return make<Row>(
      kind, rows,
      {{height_column, [](const Row& row) { return row.real_image_height_mm; }},
       {{"open share", "", 4, "open_share"}, [](const Row& row) { return row.open_share; }},
       {{"pupil low", "", 4, "pupil_low"}, [](const Row& row) { return row.pupil_low; }},
       {{"pupil high", "", 4, "pupil_high"}, [](const Row& row) { return row.pupil_high; }},
       {{"half width", "", 4, "pupil_half_width"}, [](const Row& row) { return row.pupil_half_width; }},
       {{"low end at surface", "", 0, "low_surface"},
        [](const Row& row) { return surface_text(row.low_surface); }},
       {{"high end at surface", "", 0, "high_surface"},
        [](const Row& row) { return surface_text(row.high_surface); }}});
}

Table tabulate(Fields::Kind kind, const std::vector<ChiefRayAngleRow>& rows) {
  using Row = ChiefRayAngleRow;
  return make<Row>(kind, rows,
                   {{height_column, [](const Row& row) { return row.real_image_height_mm; }},
                    {{"chief-ray angle", "deg", 4, "chief_ray_angle_deg"},
                     [](const Row& row) { return row.chief_ray_angle_deg; }},
                    {{"mean angle of the light", "deg", 4, "mean_ray_angle_deg"},
                     [](const Row& row) { return row.mean_ray_angle_deg; }}});
}

Table tabulate(Fields::Kind kind, const std::vector<PolarisationRow>& rows) {
  using Row = PolarisationRow;
  return make<Row>(kind, rows,
                   {{height_column, [](const Row& row) { return row.real_image_height_mm; }},
                    {{"transmittance", "%", 3, "transmittance_percent"},
                     [](const Row& row) { return 100 * row.transmittance; }},
                    {{"diattenuation", "%", 3, "diattenuation_percent"},
                     [](const Row& row) { return 100 * row.diattenuation; }},
                    {{"largest", "%", 3, "largest_diattenuation_percent"},
                     [](const Row& row) { return 100 * row.largest_diattenuation; }},
                    {{"RMS retardance", "nm", 3, "rms_retardance_nm"},
                     [](const Row& row) { return row.rms_retardance_nm; }},
                    {{"largest", "nm", 3, "largest_retardance_nm"},
                     [](const Row& row) { return row.largest_retardance_nm; }},
                    {{"Strehl ratio", "", 5, "strehl"}, [](const Row& row) { return row.strehl; }}});
}

Table tabulate(Fields::Kind kind, const std::vector<AberrationFans>& rows) {
  Table table{{field_column(kind),
               wavelength_column,
               {"fan", "", 0, "fan"},
               {"pupil", "", 4, "pupil"},
               {"x", "µm", 4, "x_um"},
               {"y", "µm", 4, "y_um"},
               {"OPD", "waves", 5, "opd_waves"}},
              {}};
  for (const AberrationFans& row : rows)
    for (const bool tangential : {true, false})
      for (const FanPoint& point : tangential ? row.tangential : row.sagittal)
        table.rows.push_back({row.field, row.wavelength_nm,
                              std::string(tangential ? "tangential" : "sagittal"), point.pupil, point.x_um,
                              point.y_um, point.opd_waves});
  return table;
}

Table tabulate(Fields::Kind kind, const std::vector<SpotDiagram>& rows) {
  Table table{{field_column(kind),
               wavelength_column,
               {"chief ray's height", "µm", 3, "height_um"},
               {"x", "µm", 4, "x_um"},
               {"y", "µm", 4, "y_um"}},
              {}};
  for (const SpotDiagram& row : rows)
    for (std::size_t i = 0; i < row.x_um.size(); ++i)
      table.rows.push_back({row.field, row.wavelength_nm, row.height_um, row.x_um[i], row.y_um[i]});
  return table;
}

Table tabulate(Fields::Kind kind, const std::vector<WavefrontMap>& rows) {
  Table table{{field_column(kind),
               wavelength_column,
               {"x", "stop radii", 5, "x"},
               {"y", "stop radii", 5, "y"},
               {"W", "waves", 5, "waves"}},
              {}};
  for (const WavefrontMap& row : rows)
    for (std::size_t i = 0; i < row.waves.size(); ++i) {
      if (!std::isfinite(row.waves[i])) continue;
      const auto size = static_cast<std::size_t>(row.size);
      const auto at = [&](std::size_t k) { return 2.0 * static_cast<double>(k) / (row.size - 1) - 1; };
      table.rows.push_back({row.field, row.wavelength_nm, at(i % size), at(i / size), row.waves[i]});
    }
  return table;
}

Table tabulate(Fields::Kind kind, const std::vector<WavefrontZernikeRow>& rows, ZernikeOrder order) {
  Table table{{field_column(kind),
               wavelength_column,
               {"term", "", 0, "index"},
               {"n", "", 0, "n"},
               {"m", "", 0, "m"},
               {"name", "", 0, "name"},
               {"coefficient", "waves", 5, "coefficient_waves"}},
              {}};
  for (const WavefrontZernikeRow& row : rows)
    for (std::size_t j = 0; j < row.coefficients.size(); ++j) {
      const int index = static_cast<int>(j) + 1;
      const ZernikeTerm term = zernike_term(order, index);
      table.rows.push_back({row.field, row.wavelength_nm, static_cast<double>(index),
                            static_cast<double>(term.n), static_cast<double>(term.m), zernike_name(term),
                            row.coefficients[j]});
    }
  return table;
}

Table tabulate(const std::vector<AxialFocusRow>& rows) {
  Table table{{{"zone", "stop radii", 3, "zone"}, wavelength_column, {"focus", "mm", 5, "focus_mm"}}, {}};
  for (const AxialFocusRow& row : rows) table.rows.push_back({row.zone, row.wavelength_nm, row.focus_mm});
  return table;
}

Table tabulate(const std::vector<Ghost>& rows, std::size_t sensor) {
  Table table{{wavelength_column,
               {"reflected at", "", 0, "first_surface"},
               {"then at", "", 0, "second_surface"},
               {"focus", "mm", 3, "focus_mm", {"", ".4g", 0, "inf"}},
               {"diameter", "mm", 4, "diameter_mm", {"", ".4g"}},
               {"magnification", "", 3, "magnification", {"", ".4g"}},
               {"transmittance", "", 6, "transmittance", {"", ".3g"}},
               {"irradiance over the front's", "", 8, "irradiance", {"", ".3g"}},
               {"over the image's", "", 10, "relative_irradiance", {"", ".3g"}}},
              {}};
  table.columns[0].text = {"", "g"};
  const auto name = [&](std::optional<std::size_t> surface) {
    return !surface             ? std::string("-")
           : *surface == sensor ? std::string("sensor")
                                : fmt::format("{}", *surface);
  };
  const bool four = std::ranges::any_of(rows, [](const Ghost& row) { return row.third.has_value(); });
  if (four)
    table.columns.insert(table.columns.begin() + 3,
                         {{"then at", "", 0, "third_surface"}, {"then at", "", 0, "fourth_surface"}});
  for (const Ghost& row : rows) {
    table.rows.push_back({row.wavelength_nm, name(row.first), name(row.second), row.focus_mm, row.diameter_mm,
                          row.magnification, row.transmittance, row.irradiance, row.relative_irradiance});
    if (four) table.rows.back().insert(table.rows.back().begin() + 3, {name(row.third), name(row.fourth)});
  }
  return table;
}

Table tabulate(const SeidelSums& sums) {
  Table table{{{"surface", "", 0, "surface"},
               {"S1 spherical", "mm", 5, "s1"},
               {"S2 coma", "mm", 5, "s2"},
               {"S3 astigmatism", "mm", 5, "s3"},
               {"S4 Petzval", "mm", 5, "s4"},
               {"S5 distortion", "mm", 5, "s5"},
               {"CL axial colour", "mm", 5, "cl"},
               {"CT lateral colour", "mm", 5, "ct"}},
              {}};
  const auto add = [&](const std::string& name, const SeidelTerms& terms) {
    table.rows.push_back({name, terms.s1, terms.s2, terms.s3, terms.s4, terms.s5, terms.cl, terms.ct});
  };
  for (std::size_t i = 0; i < sums.surfaces.size(); ++i) add(fmt::format("{}", i), sums.surfaces[i]);
  add("sum", sums.sum);
  return table;
}

}  // namespace petzval
