// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/lens/formats/iset.h>
#include <petzval/lens/formats/native.h>
#include <petzval/lens/formats/pbrt.h>
#include <petzval/lens/formats/text_lines.h>
#include <petzval/lens/formats/zmx.h>
#include <petzval/lens/lens_file.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace petzval {

namespace {

/// No lens file comes near this size.
constexpr std::size_t largest_file = std::size_t{8} << 20;

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

LensFile read_json(const std::string& text, const std::string& path, const LensReadOptions& options) {
  const JsonDocument document(text, path);
  if (is_iset(document)) return read_iset(document);
  return {read_native(document, options), {}};
}

LensFile read_text(const std::string& bytes, const std::string& path, const LensReadOptions& options) {
  const std::string extension = extension_of(path);
  if (bytes.empty()) throw InputError(path, "is empty; it should hold a lens");
  if (extension == ".json") return read_json(bytes, path, options);
  if (extension == ".dat") return read_pbrt(decoded_text(bytes), path);
  if (extension == ".zmx") return read_zmx(decoded_text(bytes), path, options);
  throw InputError(
      path,
      fmt::format("\"{}\" is not the extension of a lens file that is read here; .json (native or ISET), "
                  ".dat (pbrt) and .zmx are",
                  extension));
}

}  // namespace

LensFile read_lens(const std::string& path_or_name, const LensReadOptions& options) {
  const std::string path = find_data_file("lenses", ".json", path_or_name, "lens");
  LensFile file = read_text(read_whole_file(path, largest_file), path, options);
  const std::filesystem::path name(path);
  if (file.lens.name.empty()) file.lens.name = name.stem().string();
  if (file.lens.source.empty()) file.lens.source = name.filename().string();
  return file;
}

void write_lens(const Lens& lens, const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension == ".json") return write_whole_file(path, lens_to_json(lens));
  if (extension != ".dat" && extension != ".zmx")
    throw InputError(
        path,
        fmt::format("\"{}\" is not the extension of a lens file that is written here; .json (native), .dat "
                    "(pbrt) and .zmx are",
                    extension));
  std::string text;
  try {
    text = extension == ".dat" ? pbrt_text(lens) : zmx_text(lens);
  } catch (const InputError& error) {
    throw InputError(path, error.what());
  }
  write_whole_file(path, text);
}

}  // namespace petzval
