// SPDX-License-Identifier: BSD-3-Clause
// The helper program petzval-read-hdf5: reads files that may crash the HDF5 library, where that harms nobody.
//
//     petzval-read-hdf5 mat FILE.mat VARIABLE…   writes the variables as records (mat_records.h) to
//     descriptor 3 petzval-read-hdf5 table FILE.h5 OUT.h5     writes a lens data table again, with its
//     checksum
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/helper_process.h>
#include <petzval/optics/table_file.h>
#include <petzval/scene/formats/mat_hdf5.h>

#include <string>
#include <vector>

int main(int argc, char** argv) {
  using namespace petzval;
  const std::vector<std::string> words(argv + 1, argv + argc);
  return help([&] {
    constexpr int records = 3;  // the descriptor
    if (words.size() >= 2 && words[0] == "mat")
      write_mat_hdf5_records(words[1], {words.begin() + 2, words.end()}, records);
    else if (words.size() == 3 && words[0] == "table")
      seal_table(words[1], words[2]);
    else
      throw InputError("petzval-read-hdf5 is a part of petzval; it is started by it alone");
  });
}
