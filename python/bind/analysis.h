// SPDX-License-Identifier: BSD-3-Clause
// Results of analyses as Python has them.
#pragma once

#include "bind.h"

namespace petzval::python {

/// A petzval.Table.
nb::object table_of(const AnalysisTable& each);

/// A petzval.Analysis.
nb::object python_of(const std::string& name, const AnalysisResult& result);

/// What an analysis is asked, as its keywords say. \throws InputError for a kind of field without fields.
FieldTableRequest request_of(const Lens& lens, const Numbers& fields,
                             const std::optional<std::string>& field_type, const Numbers& wavelengths_nm,
                             bool ignore_apertures, const Losses& losses = {});

}  // namespace petzval::python
