// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/base/helper_process.h>
#include <petzval/base/nameless_file.h>
#include <petzval/sensor/formats/camera_raw.h>
#include <petzval/sensor/formats/dng.h>
#include <sys/stat.h>
#include <unistd.h>

#include <optional>

namespace petzval {

namespace {

std::string contents_of(const NamelessFile& file, const std::string& path) {
  struct stat about {};
  if (fstat(file.descriptor(), &about) != 0) throw Failure(path + ": its pixels are lost");
  std::string bytes(static_cast<std::size_t>(about.st_size), '\0');
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t got =
        pread(file.descriptor(), bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
    if (got <= 0) throw Failure(path + ": its pixels are lost");
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

std::string raw_helper(const std::string& path) {
  try {
    return helper_program("petzval-read-raw");
  } catch (const Failure&) {
    throw InputError(path,
                     "this installation reads no raw files of cameras, for it was built without LibRaw; "
                     "a DNG without compression or with Deflate would be read");
  }
}

}  // namespace

const std::vector<std::string>& camera_raw_extensions() {
  static const std::vector<std::string> extensions{".dng", ".3fr", ".arw", ".cr2", ".crw", ".dcr", ".erf",
                                                   ".iiq", ".kdc", ".mos", ".mrw", ".nef", ".nrw", ".orf",
                                                   ".pef", ".raf", ".rw2", ".sr2", ".srf", ".srw", ".x3f"};
  return extensions;
}

RawImage read_camera_raw(const std::string& path) {
  struct stat about {};
  if (stat(path.c_str(), &about) != 0) throw InputError(path, "the file cannot be read");
  if (!S_ISREG(about.st_mode)) throw InputError(path, "a raw file is a file, not a folder or a device");
  const NamelessFile file;
  if (!file) throw Failure("there is no room for files in $TMPDIR or /var/tmp");
  // Much more than any sound file takes: half a second a megabyte.
  HelperLimits limits;
  limits.processor_s = 5 + 5e-7 * static_cast<double>(about.st_size);
  const HelperEnd end = run_helper(raw_helper(path), {path}, file.descriptor(), limits);
  if (end == HelperEnd::crashed) throw InputError(path, "the file is damaged: LibRaw crashes on it");
  if (end == HelperEnd::endless) throw InputError(path, "the file is damaged: LibRaw finds no end");
  return parse_dng(contents_of(file, path), path);
}

RawImage read_raw(const std::string& path) {
  if (extension_of(path) != ".dng") return read_camera_raw(path);
  std::optional<InputError> own;
  try {
    return read_dng(path);
  } catch (const InputError& error) {
    own = error;
  }
  try {
    return read_camera_raw(path);
  } catch (const InputError&) {
    throw InputError(*own);  // which says more
  }
}

}  // namespace petzval
