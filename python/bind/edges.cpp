// SPDX-License-Identifier: BSD-3-Clause
// Sharpness of edges.
#include <fmt/format.h>
#include <petzval/measure/sfr/frame_sharpness.h>
#include <petzval/measure/sfr/measure_picture.h>
#include <petzval/measure/sfr/sharpest_place.h>
#include <petzval/report/sfr_page.h>
#include <petzval/sensor/formats/dng.h>
#include <petzval/simulate/outputs.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "call.h"
#include "edges.h"
#include "picture.h"

namespace petzval::python {

namespace {

using DoublesIn = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;

PicturePlanes planes_of(const PictureInPython& picture) {
  PicturePlanes result{picture.columns, picture.rows, {}, picture.channels == 3, {}, {}, {}};
  for (std::size_t c = 0; c < picture.channels; ++c) {
    Plane plane{picture.columns, picture.rows, {}};
    for (std::size_t i = c; i < picture.values.size(); i += picture.channels)
      plane.values.push_back(picture.values[i]);
    result.planes.push_back(std::move(plane));
  }
  return result;
}

PicturePlanes planes_of(const SpectralImage& image) {
  PicturePlanes result{image.columns(), image.rows(), {}, false, {}, {}, {}};
  for (int band = 0; band < image.bands(); ++band) {
    const auto values = image.band(band);
    result.planes.push_back({image.columns(), image.rows(), {values.begin(), values.end()}});
  }
  return result;
}

PicturePlanes planes_of(const RawImage& raw) {
  Plane plane{raw.columns, raw.rows, {}};
  for (int row = 0; row < raw.rows; ++row)
    for (int column = 0; column < raw.columns; ++column) plane.values.push_back(raw.pixel(row, column));
  return {raw.columns, raw.rows, {plane}, false, {}, {}, {}};
}

/// (row, column) or (row, column, channel), linear.
PicturePlanes planes_of(const DoublesIn& values) {
  if (values.ndim() != 2 && values.ndim() != 3)
    throw InputError(fmt::format(
        "`picture` of {} dimensions; (row, column) or (row, column, channel) would be right", values.ndim()));
  const std::size_t channels = values.ndim() == 3 ? values.shape(2) : 1;
  const int rows = static_cast<int>(values.shape(0)), columns = static_cast<int>(values.shape(1));
  PicturePlanes result{columns, rows, {}, channels == 3, {}, {}, {}};
  for (std::size_t c = 0; c < channels; ++c) {
    Plane plane{columns, rows, {}};
    for (std::size_t i = c; i < values.size(); i += channels) plane.values.push_back(values.data()[i]);
    result.planes.push_back(std::move(plane));
  }
  return result;
}

PicturePlanes planes_from(const nb::object& picture, const std::string& transfer, bool demosaic) {
  if (nb::isinstance<PictureInPython>(picture)) return planes_of(nb::cast<const PictureInPython&>(picture));
  if (nb::isinstance<SpectralImage>(picture)) return planes_of(nb::cast<const SpectralImage&>(picture));
  if (nb::isinstance<RawImage>(picture)) return planes_of(nb::cast<const RawImage&>(picture));
  if (nb::isinstance<nb::str>(picture))
    return read_picture_planes(nb::cast<std::string>(picture),
                               choice<PictureTransfer>("transfer", transfer,
                                                       {{"stated", PictureTransfer::stated},
                                                        {"srgb", PictureTransfer::srgb},
                                                        {"linear", PictureTransfer::linear}}),
                               demosaic);
  return planes_of(nb::cast<DoublesIn>(picture));
}

Edges measured(const nb::object& picture, const nb::object& roi, const std::string& channel,
               const std::string& bayer, int edge_order, const std::string& method,
               const std::string& transfer, bool demosaic, Maybe<std::array<double, 2>> chart_mm, int threads,
               const nb::object& progress) {
  SfrRequest request{
      {}, channel, bayer, edge_order, choice<bool>("method", method, {{"exact", false}, {"iso", true}})};
  if (!roi.is_none()) {
    std::vector<std::array<int, 4>> boxes;
    if (!nb::try_cast(roi, boxes)) boxes = {nb::cast<std::array<int, 4>>(roi)};
    for (const auto& [x, y, width, height] : boxes) request.rois.push_back({x, y, width, height});
  }
  request.chart_mm = chart_mm;
  const PicturePlanes planes = planes_from(picture, transfer, demosaic);
  const std::string name = nb::isinstance<nb::str>(picture) ? nb::cast<std::string>(picture) : "the picture";
  Call call({threads, 1, progress});
  return call([&](const Context& context) {
    return Edges{measure_sfr(planes, request, name, context), planes.columns, planes.rows};
  });
}

/// Of the picture whose edges these are.
Plane luminance_of(const Edges& edges, const nb::object& picture, const std::string& transfer) {
  const PicturePlanes planes = planes_from(picture, transfer, false);
  if (planes.columns != edges.columns || planes.rows != edges.rows)
    throw InputError(fmt::format("`picture` of {} x {} pixels; that of the edges, {} x {}, would be right",
                                 planes.columns, planes.rows, edges.columns, edges.rows));
  return planes.luminance();
}

/// SVG text that notebooks show.
nb::object shown(const std::string& svg) {
  return call_python("petzval._display", "Svg", svg);
}

/// Of all edges, the middle one; an edge whose SFR stays above one half has none.
double median_mtf50(const Edges& edges) {
  Numbers values;
  for (const MeasuredEdge& edge : edges.all)
    if (std::isfinite(edge.mtf50())) values.push_back(edge.mtf50());
  if (values.empty()) return NAN;
  std::ranges::sort(values);
  return values.size() % 2 ? values[values.size() / 2]
                           : 0.5 * (values[values.size() / 2 - 1] + values[values.size() / 2]);
}

}  // namespace

void bind_edges(nb::module_& module) {
  using Edge = MeasuredEdge;
  nb::class_<Edge>(module, "Edge",
                   "Spatial frequency response of one edge. Frequencies in cycles/pixel, lengths in pixels.")
      .def_ro("channel", &Edge::channel, "Empty for luminance.")
      .def_prop_ro(
          "roi", [](const Edge& e) { return nb::make_tuple(e.roi.x, e.roi.y, e.roi.width, e.roi.height); },
          "(x, y, width, height)")
      .def_prop_ro(
          "mtf50", &Edge::mtf50,
          "Frequency at which the SFR first falls below one half [cycles/pixel]; NaN if it does not.")
      .def_prop_ro(
          "mtf50_deviation", [](const Edge& e) { return e.exact.mtf50().deviation_cpp; },
          "Standard deviation from noise and rounding.")
      .def_prop_ro("angle_deg", &Edge::angle_deg, "From the nearer pixel axis, clockwise in the picture.")
      .def_prop_ro("frequencies_cpp", [](const Edge& e) { return array_of(e.frequencies()); })
      .def_prop_ro("sfr", [](const Edge& e) { return array_of(e.sfr()); })
      .def_prop_ro("sfr_deviation", [](const Edge& e) { return array_of(e.exact.sfr_deviation); })
      .def_prop_ro(
          "rise_px", [](const Edge& e) { return e.exact.rise_px; }, "10 % to 90 %.")
      .def_prop_ro(
          "distance_px", [](const Edge& e) { return array_of(e.exact.distance_px); }, "Of the profile.")
      .def_prop_ro(
          "esf", [](const Edge& e) { return array_of(e.exact.esf); }, "Edge spread, over the step.")
      .def_prop_ro(
          "lsf", [](const Edge& e) { return array_of(e.exact.lsf); }, "Line spread [1/pixel].")
      .def_prop_ro("notes", [](const Edge& e) { return e.exact.notes; })
      .def_ro("lateral_offset_px", &Edge::lateral_offset_px,
              "From green along the normal, with all channels; else None.")
      .def_prop_ro(
          "on_chart",
          [](const Edge& e) -> nb::object {
            if (!e.on_chart) return nb::none();
            return nb::make_tuple(e.on_chart->x_mm, e.on_chart->y_mm, e.mtf50() * e.on_chart->per_mm);
          },
          "With `chart_mm`: x and y of its middle on the chart [mm] and MTF50 there [cycles/mm]; else None.")
      .def("__repr__", [](const Edge& e) {
        return fmt::format("<Edge{}{} at {:.3f} degrees: MTF50 {:.4f} cycles/pixel>",
                           e.channel.empty() ? "" : " ", e.channel, e.angle_deg(), e.mtf50());
      });
  nb::class_<Edges>(module, "Edges", "The measured edges of a picture.")
      .def("__len__", [](const Edges& e) { return e.all.size(); })
      .def("__getitem__",
           [](const Edges& e, std::ptrdiff_t i) {
             if (i < 0) i += static_cast<std::ptrdiff_t>(e.all.size());
             if (i < 0 || i >= static_cast<std::ptrdiff_t>(e.all.size()))
               throw nb::index_error("there is no such edge");
             return e.all[static_cast<std::size_t>(i)];
           })
      .def_prop_ro("mtf50", median_mtf50, "Median of the edges' [cycles/pixel].")
      .def(
          "map",
          [](const Edges& e, const std::string& direction) {
            SharpnessSurface surface = sharpness_surface(e.in_frame(direction), e.columns, e.rows);
            return array_of(std::move(surface.mtf50_cpp), {static_cast<std::size_t>(surface.rows),
                                                           static_cast<std::size_t>(surface.columns)});
          },
          nb::arg("direction") = "all",
          "MTF50 over the frame [cycles/pixel], rows from the top, on a coarse grid; NaN where no edges are "
          "near. "
          "`direction`: all, meridional or sagittal.")
      .def(
          "over_height",
          [](const Edges& e, const std::vector<double>& heights_px, const std::string& direction) {
            return array_of(sharpness_over_height(e.in_frame(direction), heights_px));
          },
          nb::arg("heights_px"), nb::arg("direction") = "all",
          "MTF50 at distances from the middle of the frame [pixels]; NaN where no edges are near.")
      .def(
          "map_svg",
          [](const Edges& e) {
            return shown(sharpness_map_svg({"", e.columns, e.rows, {}, e.all, ""}));
          },
          "The maps drawn, as `petzval sfr --map` does: SVG text that notebooks show.")
      .def(
          "over_height_svg",
          [](const Edges& e, Maybe<double> pitch_um) {
            return shown(sharpness_profile_svg({"", e.columns, e.rows, pitch_um, e.all, ""}));
          },
          nb::kw_only(), nb::arg("pitch_um").none() = nb::none(),
          "MTF50 over the image height, as `petzval sfr --over-height` draws it; with `pitch_um` of the "
          "pixels "
          "in mm.")
      .def(
          "annotated_svg",
          [](const Edges& e, const nb::object& picture, const std::string& transfer) {
            return shown(annotated_edges_svg(e.all, luminance_of(e, picture, transfer)));
          },
          nb::arg("picture"), nb::kw_only(), nb::arg("transfer") = "stated",
          "The picture with its edges and their MTF50, as `petzval sfr --annotate` draws it. `picture`: what "
          "was measured, as `sfr` takes it.")
      .def(
          "report_html",
          [](const Edges& e, const nb::object& picture, const std::string& title, Maybe<double> pitch_um,
             const std::string& transfer) {
            return sfr_page_html({title, e.columns, e.rows, pitch_um, e.all,
                                  picture.is_none()
                                      ? std::string()
                                      : annotated_edges_svg(e.all, luminance_of(e, picture, transfer))});
          },
          nb::arg("picture").none() = nb::none(), nb::kw_only(), nb::arg("title") = "",
          nb::arg("pitch_um").none() = nb::none(), nb::arg("transfer") = "stated",
          "The page of `petzval sfr --report`, as HTML text: map, profile, lateral colour, all edges, and "
          "the "
          "`picture` with its edges if it is given. `pitch_um` of the pixels: lp/mm too.")
      .def(
          "sharpest_along",
          [](const Edges& e, const std::string& axis) {
            const auto all = focus_along(
                e.all, choice<ChartAxis>("axis", axis, {{"x", ChartAxis::x}, {"y", ChartAxis::y}}));
            nb::dict result;
            for (const ChannelFocus& focus : all)
              result[nb::str(focus.channel.c_str())] =
                  nb::make_tuple(focus.sharpest.place, focus.sharpest.deviation);
            return result;
          },
          nb::arg("axis"),
          "Where a tilted chart is sharpest along x or y: place and deviation of each channel, in mm with "
          "`chart_mm`, "
          "else in pixels.")
      .def("__repr__", [](const Edges& e) {
        return fmt::format("<Edges: {}, median MTF50 {:.4f} cycles/pixel>", e.all.size(), median_mtf50(e));
      });
  module.def(
      "sfr", measured, nb::arg("picture"), nb::arg("roi").none() = nb::none(), nb::kw_only(),
      nb::arg("channel") = "luminance", nb::arg("bayer") = "", nb::arg("edge_order") = 0,
      nb::arg("method") = "exact", nb::arg("transfer") = "stated", nb::arg("demosaic") = false,
      nb::arg("chart_mm").none() = nb::none(), nb::arg("threads") = 0,
      nb::arg("progress").none() = nb::none(),
      "Spatial frequency response of slanted edges. `picture`: a Picture, SpectralImage, Raw (with "
      "`bayer`), an array of linear light (row, column) or "
      "(row, column, channel), or a file. `roi`: (x, y, width, height) of an edge, or a list of them; "
      "None: every straight edge that stands out. "
      "`channel`: luminance, red, green, blue or all. `edge_order`: 0, bent as far as the pixels "
      "show, 1, straight, up to 5. `method`: "
      "exact or iso. `demosaic`: full planes of a raw file, not each colour for itself. `chart_mm`: width "
      "and height of the printed chart that the picture shows.");
}

}  // namespace petzval::python
