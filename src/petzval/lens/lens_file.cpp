// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/whole_file.h>
#include <petzval/lens/formats/flaresim.h>
#include <petzval/lens/formats/glass_lookup.h>
#include <petzval/lens/formats/iset.h>
#include <petzval/lens/formats/iset_transfer.h>
#include <petzval/lens/formats/lens_table.h>
#include <petzval/lens/formats/native.h>
#include <petzval/lens/formats/optical_bench.h>
#include <petzval/lens/formats/pbrt.h>
#include <petzval/lens/formats/seq.h>
#include <petzval/lens/formats/zmx.h>
#include <petzval/lens/lens_file.h>
#include <petzval/lens/ray_transfer.h>

#include <filesystem>

namespace petzval {

namespace {

/// No lens file comes near this size.
constexpr std::size_t largest_file = std::size_t{8} << 20;

/// Rows of numbers have no glass that another could take the place of.
LensFile without_glasses(LensFile file, const std::string& path, const LensReadOptions& options) {
  try {
    GlassLookup(options).require_all_used();
  } catch (const InputError& error) {
    throw InputError(path, error.what());
  }
  return file;
}

LensFile read_json(const std::string& text, const std::string& path, const LensReadOptions& options) {
  const JsonDocument document(text, path);
  if (is_iset_transfer(document)) return without_glasses(read_iset_transfer(document), path, options);
  if (is_iset(document)) return without_glasses(read_iset(document), path, options);
  return {read_native(document, options), {}};
}

LensFile read_text(const std::string& bytes, const std::string& path, const LensReadOptions& options) {
  const std::string extension = extension_of(path);
  if (bytes.empty()) throw InputError(path, "is empty; it should hold a lens");
  if (extension == ".json") return read_json(bytes, path, options);
  if (extension == ".dat") return without_glasses(read_pbrt(decoded_text(bytes), path), path, options);
  if (extension == ".zmx") return read_zmx(decoded_text(bytes), path, options);
  if (extension == ".seq") return read_seq(decoded_text(bytes), path, options);
  if (extension == ".csv" || extension == ".tsv") return read_lens_table(decoded_text(bytes), path, options);
  if (extension == ".lens") return without_glasses(read_flaresim(decoded_text(bytes), path), path, options);
  if (extension == ".txt") {
    const std::string text = decoded_text(bytes);
    return is_optical_bench(text) ? read_optical_bench(text, path, options)
                                  : read_lens_table(text, path, options);
  }
  throw InputError(
      path,
      fmt::format("\"{}\" is not the extension of a lens file that is read here; .json (native or ISET), "
                  ".dat (pbrt), .zmx, .seq (CODE V), .txt (Optical Bench, or a table), .lens (FlareSim) and "
                  "tables (.csv, .tsv) are",
                  extension));
}

using LensText = std::string (*)(const Lens&);

LensText writer_for(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension == ".json") {
    const std::string inner = extension_of(std::filesystem::path(path).stem().string());
    if (inner == ".raytransfer") return iset_transfer_text;
    return inner == ".iset" ? iset_text : lens_to_json;
  }
  if (extension == ".dat") return pbrt_text;
  if (extension == ".zmx") return zmx_text;
  if (extension == ".seq") return seq_text;
  throw InputError(path, fmt::format("\"{}\" is not the extension of a lens file that is written here; .json "
                                     "(native), .iset.json (ISET), .dat (pbrt), .zmx and .seq (CODE V) are",
                                     extension));
}

/// Other programs' files hold lenses as designed. \throws InputError for melts, and for poses where the kind
/// of file has none.
void require_designed(const Lens& lens, bool holds_poses) {
  if (!holds_poses) require_centred(lens, "Petzval writes poses into .json, .zmx and .seq");
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
    if (!lens.surfaces[i].material.melt().is_none())
      throw InputError(fmt::format(
          "surfaces[{0}].melt: Petzval writes melts into its own .json alone; set surfaces[{0}].melt=null",
          i));
}

/// Tables of rows hold no more.
void require_air_and_glass(const Lens& lens) {
  require_no_bends(lens, "files of this kind hold");
  if (!lens.object_material.is_air())
    throw InputError("object_glass: files of this kind hold objects in air; set object_glass=null");
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

std::vector<std::string> write_lens(const Lens& lens, const std::string& path) {
  const auto text_of = writer_for(path);
  const bool rows_only = text_of == pbrt_text || text_of == iset_text;
  std::string text;
  try {
    if (text_of != lens_to_json) require_designed(lens, text_of == zmx_text || text_of == seq_text);
    if (text_of != lens_to_json && text_of != iset_transfer_text)
      require_glass(lens, "files of this kind hold");
    if (rows_only) require_air_and_glass(lens);
    text = text_of(lens);
  } catch (const InputError& error) {
    throw InputError(path, error.what());
  }
  write_whole_file(path, text);
  std::vector<std::string> notes;
  if (rows_only)
    notes.push_back(path + ": holds one index a gap, and neither fields nor wavelengths: these are left out");
  if (!lens.states.empty() && (rows_only || text_of == iset_transfer_text))
    notes.push_back(path + ": holds one state of the lens: the others are left out");
  return notes;
}

}  // namespace petzval
