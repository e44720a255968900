// SPDX-License-Identifier: BSD-3-Clause
// Two lenses with the numbers that an independent double-precision tracer gives for them
// (tests/data/*.ref.json, definitions inside): for parametrised tests.
#pragma once

#include <gtest/gtest.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/lens/lens_file.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

namespace petzval {

struct GoldenLens {
  const char* lens;
  const char* file;
};

inline void PrintTo(const GoldenLens& golden, std::ostream* out) {
  *out << golden.lens;
}

class GoldenLensTest : public testing::TestWithParam<GoldenLens> {
 protected:
  GoldenLensTest() : lens(read_lens(GetParam().lens).lens) {
    std::ifstream file(std::string(PETZVAL_TEST_DATA) + "/" + GetParam().file);
    reference = nlohmann::json::parse(file);
  }

  /// Calls body(tracer, chief, row) for every field and wavelength of the reference; nothing clips but the
  /// stop, as there.
  template <class Body>
  void for_each_row(Body&& body) const {
    ASSERT_EQ(reference["fields_wavelengths"]["rows"].size(), 15U);
    for (const nlohmann::json& row : reference["fields_wavelengths"]["rows"]) {
      SCOPED_TRACE(row["field_deg"].dump() + " deg, " + row["wavelength_um"].dump() + " um");
      FieldTracer tracer(lens, row["wavelength_um"].get<double>() * 1000, Tracer::Clip::stop_only);
      const std::optional<ChiefRay> chief = tracer.chief_ray(row["field_deg"]);
      ASSERT_TRUE(chief);
      body(tracer, *chief, row);
    }
  }

  Lens lens;
  nlohmann::json reference;
};

inline auto golden_lenses() {
  return testing::Values(GoldenLens{"cooke-triplet", "cooke_triplet_f5.ref.json"},
                         GoldenLens{"double-gauss", "double_gauss_f5.ref.json"});
}

}  // namespace petzval
