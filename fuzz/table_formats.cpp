// SPDX-License-Identifier: BSD-3-Clause
#include "table_formats.h"

#include <petzval/base/text_lines.h>
#include <petzval/measure/sfr/sfr_map.h>
#include <petzval/optics/formats/iset_mat_table.h>
#include <petzval/optics/formats/isetparms.h>
#include <petzval/optics/formats/kept_beside.h>
#include <petzval/optics/formats/measured.h>
#include <petzval/optics/formats/psf_listing.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "memory_file.h"
#include "require.h"

namespace petzval::fuzz {

namespace {

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

bool same(const LensDataTable& a, const LensDataTable& b) {
  return a.fields == b.fields && a.wavelengths_nm == b.wavelengths_nm && a.g_source_sr == b.g_source_sr &&
         a.g_sensor_sr == b.g_sensor_sr && a.real_image_height_mm == b.real_image_height_mm &&
         a.object_distance_mm == b.object_distance_mm && a.lens_name == b.lens_name;
}

/// What a table is in ISET's terms brings it back; if it has none, that is said in one line.
void there_and_back(const LensDataTable& table) {
  table.validate();
  RayTraceData data;
  if (accepted([&] { data = ray_trace_data(table); }))
    require(same(table_of(data).table, table), "a table that comes back from ISET's terms as another");
}

}  // namespace

namespace {

bool try_iset_mat_file(const std::string& path) {
  std::optional<LensDataTable> table;
  const bool good = accepted([&] {
    RayTraceReading reading;
    reading.g_axis_sr = 0.1;
    table = table_of(read_iset_mat_table(path).data, reading).table;
  });
  if (good) there_and_back(*table);
  return good;
}

}  // namespace

bool try_iset_mat_table(std::string_view bytes) {
  return try_iset_mat_file(MemoryFile(bytes).path());
}

bool try_iset_mat_hdf5_table(std::string_view bytes) {
  return try_iset_mat_file(NamedFile(bytes).path());
}

bool try_isetparms(std::string_view bytes) {
  std::optional<IsetParameters> read;
  if (!accepted([&] { read = read_isetparms(decoded_text(bytes), "fuzz"); })) return false;
  RayTraceData& data = read->data;
  if (data.field_height_mm.size() * data.wavelengths_nm.size() > 1000) return true;
  data.psf.assign(1, Psf{1, read->psf_spacing_um, {1.0F}, 1});
  const IsetParameters again =
      read_isetparms(isetparms_text(data, read->base_name, read->psf_size), "written by ourselves");
  require(again.data.field_height_mm == data.field_height_mm &&
              again.data.wavelengths_nm == data.wavelengths_nm && same(again.data.f_number, data.f_number) &&
              same(again.data.magnification, data.magnification) &&
              same(again.data.effective_focal_length_mm, data.effective_focal_length_mm) &&
              same(again.data.object_distance_mm, data.object_distance_mm),
          "written parameters that read back as others");
  return true;
}

bool try_psf_listing(std::string_view bytes) {
  Psf psf;
  const bool good = accepted([&] {
    const PsfListing listing = read_psf_listing(bytes, "fuzz");
    psf = psf_of_grid(listing.grid, {PsfAway::down, listing.centre_row, listing.centre_column},
                      listing.spacing_um > 0 ? listing.spacing_um : 1);
  });
  constexpr int largest = 256;
  if (!good || psf.size > largest) return good;
  const int size = psf.size + 2 - psf.size % 2;
  const PsfListing again =
      read_psf_listing(psf_listing_text(psf, size, 550, 1, "fuzz"), "written by ourselves");
  const Psf back =
      psf_of_grid(again.grid, {PsfAway::down, again.centre_row, again.centre_column}, again.spacing_um);
  require(back.spacing_um == psf.spacing_um, "a listing of another spacing");
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j)
      require(std::abs(back.at(i - psf.size / 2 + back.size / 2, j - psf.size / 2 + back.size / 2) -
                       psf.at(i, j)) <= 1e-5F * psf.at(i, j),
              "a listed PSF that reads back as another");
  return true;
}

bool try_measured(std::string_view bytes) {
  std::optional<MeasuredFile> read;
  if (!accepted([&] { read = read_measured(bytes, "fuzz", "", ""); })) return false;
  RayTraceReading reading;
  reading.g_axis_sr = 0.1;
  accepted([&] { table_of(read->data, reading).table.validate(); });
  return true;
}

bool try_kept(std::string_view bytes) {
  std::optional<LensDataTable> table;
  if (!accepted([&] { table = table_of_kept(std::string(bytes)); })) return false;
  const std::string text = kept_beside(*table);
  require(kept_beside(table_of_kept(text)) == text, "what is kept is kept differently again");
  return true;
}

bool try_sfr_map(std::string_view bytes) {
  std::vector<SfrMap> maps;
  if (!accepted([&] { maps = parse_sfr_maps(std::string(bytes), "fuzz"); })) return false;
  const auto finite = [](double number) { return std::isfinite(number); };
  for (const SfrMap& map : maps) {
    require(map.columns > 0 && map.rows > 0 && !map.edges.empty(), "a map without edges");
    for (const MapEdge& edge : map.edges) {
      const std::size_t count = edge.frequencies_cpp.size();
      require(count > 0 && edge.contrast.size() == count && edge.deviation.size() == count &&
                  (edge.correlation.empty() || edge.correlation.size() == count * count),
              "lists of other lengths");
      for (const double number : {edge.x_px, edge.y_px, edge.normal_rad, edge.half_length_px, edge.mtf50_cpp})
        require(finite(number), "an edge at no place");
      require(edge.mtf50_cpp > 0 && std::ranges::all_of(edge.frequencies_cpp, finite) &&
                  std::ranges::all_of(edge.contrast, finite) && std::ranges::all_of(edge.deviation, finite) &&
                  std::ranges::all_of(edge.deviation, [](double deviation) { return deviation >= 0; }),
              "a contrast that is no number");
    }
  }
  return true;
}

}  // namespace petzval::fuzz
