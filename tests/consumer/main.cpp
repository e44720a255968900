// SPDX-License-Identifier: BSD-3-Clause
// Reads a bundled lens from the installed data, which nobody had to name, and checks its focal length.
#include <petzval/petzval.h>

#include <cmath>
#include <cstdio>

int main() {
  if (petzval::data_directory() != PETZVAL_DATA_DIR) return 1;
  const petzval::LensFile file = petzval::read_lens("edmund-54852");
  const double efl_mm = petzval::first_order(file.lens, 587.56).efl_mm;
  std::printf("petzval %s: %s, focal length %.4f mm\n", petzval::version(), file.lens.name.c_str(), efl_mm);
  // Edmund Optics sells it as 6.0 mm; the prescription gives it to the last digit of that.
  if (std::abs(efl_mm - 6.0) > 0.05) return 1;

  try {
    petzval::set_data_directory("/nowhere");
    return 1;
  } catch (const petzval::InputError& error) {
    return error.parts().file == "/nowhere" ? 0 : 1;
  }
}
