// SPDX-License-Identifier: BSD-3-Clause
// What every analysis by field and wavelength does first: aim the chief ray, or say that there is none.
#pragma once

#include <fmt/format.h>
#include <petzval/analysis/field_tables.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/field_values.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>

#include <optional>
#include <utility>
#include <vector>

namespace petzval {

/// The error for a field that no light gets through at.
inline InputError no_ray_passes(const Lens& lens, double field, double wavelength_nm) {
  return InputError(fmt::format("{}: no ray passes at field {:g} and {:g} nm; a smaller field would be right",
                                lens.name, field, wavelength_nm));
}

/// Lists that are empty become the lens's own.
inline FieldTableRequest with_own_lists(FieldTableRequest request, const Lens& lens) {
  const FieldTableRequest own = FieldTableRequest::of(lens);
  if (request.fields.empty()) request.field_kind = own.field_kind, request.fields = own.fields;
  if (request.wavelengths_nm.empty()) request.wavelengths_nm = own.wavelengths_nm;
  return request;
}

/// Rows [field][wavelength], all in parallel; `make(tracer, chief)` gives one row as an optional, empty where
/// no ray passes. Sets row.field and row.wavelength_nm.
/// \throws InputError naming a field at which no chief ray or no ray at all passes.
template <class Row, class Make>
std::vector<Row> field_rows(const Lens& lens, FieldTableRequest request, Make&& make) {
  request = with_own_lists(std::move(request), lens);
  const std::size_t fields = request.fields.size(), wavelengths = request.wavelengths_nm.size();
  std::vector<std::optional<FieldTracer>> tracers(wavelengths);
  std::vector<std::optional<ChiefRay>> chiefs(fields * wavelengths);
  std::vector<double> objects;
  for (const double field : request.fields) objects.push_back(object_field(lens, request.field_kind, field));
  parallel_for(wavelengths, [&](std::size_t w) {
    tracers[w].emplace(lens, request.wavelengths_nm[w], request.clip, request.azimuth_deg);
    for (std::size_t f = 0; f < fields; ++f) chiefs[f * wavelengths + w] = tracers[w]->chief_ray(objects[f]);
  });
  std::vector<std::optional<Row>> made(chiefs.size());
  parallel_tasks(made.size(), [&](std::size_t i) {
    if (chiefs[i]) made[i] = make(std::as_const(*tracers[i % wavelengths]), *chiefs[i]);
  });
  std::vector<Row> rows;
  for (std::size_t i = 0; i < made.size(); ++i) {
    const double field = request.fields[i / wavelengths],
                 wavelength_nm = request.wavelengths_nm[i % wavelengths];
    if (!made[i]) throw no_ray_passes(lens, field, wavelength_nm);
    made[i]->field = field;
    made[i]->wavelength_nm = wavelength_nm;
    rows.push_back(*std::move(made[i]));
  }
  return rows;
}

}  // namespace petzval
