// SPDX-License-Identifier: BSD-3-Clause
// The helper program petzval-read-raw: turns a camera's raw file into a DNG by LibRaw.
//
//     petzval-read-raw FILE    writes the DNG to descriptor 3
#include <petzval/base/error.h>
#include <petzval/base/helper_process.h>
#include <petzval/sensor/formats/dng.h>
#include <unistd.h>

#include <string>

#include "unpacked_raw.h"

int main(int argc, char** argv) {
  using namespace petzval;
  return help([&] {
    if (argc != 2) throw InputError("petzval-read-raw is a part of petzval; it is started by it alone");
    const std::string path = argv[1], dng = dng_bytes(unpacked_raw(path), path);
    for (std::size_t done = 0; done < dng.size();) {
      const ssize_t written = write(3, dng.data() + done, dng.size() - done);
      if (written <= 0) throw Failure(path + ": there is no room for its pixels");
      done += static_cast<std::size_t>(written);
    }
  });
}
