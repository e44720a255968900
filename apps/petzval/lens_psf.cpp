// SPDX-License-Identifier: BSD-3-Clause
// petzval lens psf: diffraction point-spread functions.
#include <fmt/format.h>
#include <petzval/analysis/fft_point_spread.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/analysis/tv_distortion.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/npz.h>
#include <petzval/report/heat_map.h>
#include <petzval/report/psf_drawing.h>
#include <petzval/simulate/psf_stack.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>

#include "camera_option.h"
#include "field_option.h"
#include "lens_commands.h"
#include "loss_option.h"
#include "output_option.h"
#include "plot_output.h"

namespace petzval::app {

namespace {

struct PsfCommand {
  LensChoice lens;
  FieldChoice fields;
  CameraChoice camera;
  PsfOptions psf;
  LossChoice losses;
  std::string method = "rays";
  int pupil_samples = 256;
  std::string output, map;
};

struct PsfRow {
  double field, wavelength_nm;
  ChiefRay chief;
  Psf psf;
  /// Of the FFT method: the rms and the largest difference from the sum over real rays, over its rms and
  /// peak.
  double rms_difference = 0, peak_difference = 0;
};

/// Replaces the PSF of a row by the plain FFT's on the same grid, and says how far that is off.
void take_fft(const PsfCommand& options, const FieldTracer& tracer, PsfRow& row) {
  if (const PsfPlan plan = *plan_psf(tracer, row.chief, options.psf); plan.samples_per_cell > 1)
    throw InputError(fmt::format(
        "--method fft: the PSF at field {:g} is {:.0f} um wide, more than {} samples of the FFT span; "
        "a smaller f-number, --size or --spacing would be right",
        row.field, plan.size * plan.spacing_um, plan.size));
  const std::optional<Psf> fft =
      fft_point_spread(tracer, row.chief, {row.psf.size, row.psf.spacing_um}, options.pupil_samples);
  if (!fft) throw InputError(fmt::format("no ray passes at field {:g}", row.field));
  double square = 0, norm = 0, peak = 0, worst = 0;
  for (std::size_t i = 0; i < fft->values.size(); ++i) {
    const double rays = row.psf.values[i], difference = fft->values[i] - rays;
    square += difference * difference;
    norm += rays * rays;
    peak = std::max(peak, rays);
    worst = std::max(worst, std::abs(difference));
  }
  row.rms_difference = std::sqrt(square / norm);
  row.peak_difference = worst / peak;
  row.psf = *fft;
}

std::vector<PsfRow> psf_rows(const PsfCommand& options, const Lens& lens, const FieldTableRequest& request) {
  std::vector<PsfRow> rows;
  for (const double field : request.fields) {
    const double object = object_field(lens, request.field_kind, field);
    for (const double wavelength : request.wavelengths_nm) {
      FieldTracer tracer(lens, wavelength, request.clip, request.azimuth_deg);
      tracer.set_losses(request.losses);
      const std::optional<ChiefRay> chief = tracer.chief_ray(object);
      const std::optional<Psf> psf = chief ? point_spread(tracer, *chief, options.psf) : std::nullopt;
      if (!psf)
        throw InputError(
            fmt::format("{}: no ray passes at field {:g} and {:g} nm", lens.name, field, wavelength));
      rows.push_back({field, wavelength, *chief, *psf});
      if (options.method == "fft") take_fft(options, tracer, rows.back());
    }
  }
  return rows;
}

struct PsfMoments {
  double centroid_t_um = 0, rms_radius_um = 0, peak_per_um2 = 0;
};

PsfMoments moments(const Psf& psf) {
  PsfMoments result;
  const auto t_of = [&](int i) { return (i - psf.size / 2) * psf.spacing_um; };
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j) {
      result.centroid_t_um += psf.at(i, j) * t_of(i);
      result.peak_per_um2 = std::max(result.peak_per_um2, psf.at(i, j) / (psf.spacing_um * psf.spacing_um));
    }
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j) {
      const double s = t_of(j), t = t_of(i) - result.centroid_t_um;
      result.rms_radius_um += psf.at(i, j) * (s * s + t * t);
    }
  result.rms_radius_um = std::sqrt(result.rms_radius_um);
  return result;
}

void write_psfs(const std::string& path, const std::vector<PsfRow>& rows, Fields::Kind kind) {
  const std::string extension = std::filesystem::path(path).extension().string();
  const Psf& first = rows.front().psf;
  if (extension == ".svg" || extension == ".pdf" || (extension == ".png" && rows.size() > 1)) {
    std::vector<DrawnPsf> drawn;
    for (const PsfRow& row : rows)
      drawn.push_back(
          {row.psf, fmt::format("{:g} {}, {:g} nm\n99 % in {:.1f} µm", row.field, field_unit(kind),
                                row.wavelength_nm, 2 * half_width_holding_um(row.psf))});
    // A row a field.
    const auto same_field = [&](const PsfRow& row) { return row.field == rows.front().field; };
    const auto wavelengths = std::ranges::count_if(rows, same_field);
    constexpr int a_few = 4;
    return write_drawing(path, psf_strip_svg(drawn, wavelengths > 1 ? static_cast<int>(wavelengths) : a_few));
  }
  if (rows.size() > 1)
    throw InputError(fmt::format("{}: holds one PSF, not {}; give one field and one wavelength, or an .npz",
                                 path, rows.size()));
  const auto size = static_cast<std::size_t>(first.size);
  if (extension == ".npy") {
    const std::size_t shape[] = {size, size};
    return write_npy(path, shape, std::span<const float>(first.values));
  }
  HeatMapOptions map;
  map.first_row_on_top = false;
  write_whole_file(path, heat_map_png(first.values, first.size, first.size, map));
}

/// All fields and wavelengths on one grid, as arrays with their axes.
void write_stack(const PsfCommand& options, const Lens& lens, const FieldTableRequest& request,
                 const Context& context) {
  const PsfStack stack =
      psf_stack(lens, request, options.psf, context, options.method == "fft" ? options.pupil_samples : 0);
  const std::size_t fields = stack.fields.size(), wavelengths = stack.wavelengths_nm.size(),
                    size = static_cast<std::size_t>(stack.size);
  std::vector<double> places(size);
  for (std::size_t i = 0; i < size; ++i)
    places[i] = (static_cast<double>(i) - static_cast<double>(size / 2)) * stack.spacing_um;
  write_npz(options.output, {{"psf", {{fields, wavelengths, size, size}, stack.values}},
                             {to_string(stack.field_kind), {{fields}, stack.fields}},
                             {"wavelengths_nm", {{wavelengths}, stack.wavelengths_nm}},
                             {"tangential_um", {{size}, places}},
                             {"sagittal_um", {{size}, places}},
                             {"captured", {{fields, wavelengths}, stack.captured}},
                             {"real_image_height_mm", {{fields, wavelengths}, stack.image_height_mm}}});
}

/// Stars over the frame of the lens's fields, each wavelength about the chief ray of the reference.
void write_map(const PsfCommand& options, const Lens& lens, const FieldTableRequest& request) {
  const std::optional<FrameSize> frame = frame_of_fields(lens);
  if (!frame)
    throw InputError(
        "--map: the lens has no field beside its axis; fields in its file that reach the corners would be "
        "right");
  constexpr int across = 7;
  std::vector<PsfPlace> places = even_places(frame->width_mm, frame->height_mm, across);
  std::map<long, std::vector<MappedPsf>> known;  // by radius [nm]: places come in fours
  for (PsfPlace& place : places) {
    const double radius_mm = std::hypot(place.x_mm, place.y_mm);
    auto& light = known[std::lround(radius_mm / mm_per_um * 1000)];
    if (light.empty()) {
      FieldTableRequest here = request;
      here.field_kind = Fields::Kind::real_image_height_mm, here.fields = {radius_mm};
      for (PsfRow& row : psf_rows(options, lens, here))
        light.push_back({std::move(row.psf), row.wavelength_nm,
                         (std::abs(row.chief.image_height_mm) - radius_mm) / mm_per_um});
    }
    place.light = light;
  }
  write_drawing(options.map, psf_map_svg(places, across, frame->width_mm, lens.name));
}

void psf(const PsfCommand& options, const Shared& shared) {
  if (!options.map.empty()) require_drawing(options.map, "a map of PSFs");
  if (!options.output.empty())
    require_extension(options.output, {".svg", ".png", ".pdf", ".npy", ".npz"}, "a PSF");
  const Lens read = options.fields.prepare(options.lens.read(shared), shared);
  const Lens lens = options.camera.used(read, options.fields.request(read), shared);
  FieldTableRequest request = options.fields.request(lens);
  request.azimuth_deg = options.camera.field_azimuth_deg;
  request.losses = options.losses.losses(lens, shared);
  const std::vector<PsfRow> rows = psf_rows(options, lens, request);
  const bool as_stack = std::filesystem::path(options.output).extension() == ".npz";
  if (as_stack) write_stack(options, lens, request, context_of(shared));
  if (!options.output.empty() && !as_stack) write_psfs(options.output, rows, request.field_kind);
  if (!options.map.empty()) write_map(options, lens, request);
  if (shared.json) {
    nlohmann::ordered_json json = {{"lens", lens.name},
                                   {"field_definition", field_definition(request.field_kind)},
                                   {"method", options.method}};
    json["rows"] = nlohmann::ordered_json::array();
    for (const PsfRow& row : rows) {
      const PsfMoments m = moments(row.psf);
      json["rows"].push_back({{"field", row.field},
                              {"wavelength_nm", row.wavelength_nm},
                              {"real_image_height_mm", row.chief.image_height_mm},
                              {"size", row.psf.size},
                              {"spacing_um", row.psf.spacing_um},
                              {"captured", row.psf.captured},
                              {"peak_per_um2", m.peak_per_um2},
                              {"centroid_tangential_um", m.centroid_t_um},
                              {"rms_radius_um", m.rms_radius_um}});
      if (options.method != "fft") continue;
      json["rows"].back()["rms_difference"] = row.rms_difference;
      json["rows"].back()["peak_difference"] = row.peak_difference;
    }
    return print_json(json);
  }
  const bool fft = options.method == "fft";
  fmt::print("{}: diffraction PSFs, centred on the chief ray{}\n", lens.name,
             fft ? ", by the plain FFT's model; differences from the sum over real rays" : "");
  fmt::print("{:>28} {:>15} {:>18} {:>9} {:>13} {:>11} {:>14} {:>15} {:>16}{}\n",
             field_heading(request.field_kind), "wavelength [nm]", "image height [mm]", "samples",
             "spacing [um]", "captured", "peak [1/um2]", "centroid t [um]", "rms radius [um]",
             fft ? "  rms difference  peak difference" : "");
  for (const PsfRow& row : rows) {
    const PsfMoments m = moments(row.psf);
    fmt::print("{:>28g} {:>15g} {:>18.6f} {:>9} {:>13.4f} {:>11.4f} {:>14.5f} {:>15.3f} {:>16.3f}{}\n",
               row.field, row.wavelength_nm, row.chief.image_height_mm, fmt::format("{0}x{0}", row.psf.size),
               row.psf.spacing_um, row.psf.captured, m.peak_per_um2, m.centroid_t_um, m.rms_radius_um,
               fft ? fmt::format(" {:>15.4f} {:>16.4f}", row.rms_difference, row.peak_difference) : "");
  }
}

}  // namespace

void add_lens_psf(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<PsfCommand>();
  CLI::App* command =
      add_command(lens, shared, "psf", "Diffraction point-spread functions by field and wavelength",
                  "petzval lens psf edmund-54852 --fields 0,2.1,3 --wavelengths 587.56 -o psf.svg", true,
                  [=, &shared] { psf(*options, shared); });
  options->lens.add_to(*command);
  options->fields.add_to(*command);
  options->camera.add_to(*command);
  command->add_option("--size", options->psf.size, "Samples a side; default: as many as the spot needs")
      ->check(CLI::Range(8, 4096));
  command
      ->add_option(
          "--spacing", options->psf.spacing_um,
          "Spacing of the cells [um]; default: 0.45 lambda N, or wider where 256 do not span the spot")
      ->check(positive_number());
  command
      ->add_option(
          "--method", options->method,
          "rays: plane waves of real rays; fft: the plain FFT's model of the pupil, with its difference")
      ->check(CLI::IsMember({"rays", "fft"}))
      ->capture_default_str();
  command->add_option("--pupil-samples", options->pupil_samples, "Points across the pupil of --method fft")
      ->check(CLI::Range(8, 1024))
      ->capture_default_str();
  options->losses.add_to(*command);
  command
      ->add_option("-o,--output", options->output,
                   "Picture or data to write: .svg, .png, .pdf, .npy of one PSF, .npz of all with their axes")
      ->check(output_file());
  command
      ->add_option(
          "--map", options->map,
          "Also draw stars over the frame, enlarged at their places, wavelengths in their colours (.svg)")
      ->check(output_file());
}

}  // namespace petzval::app
