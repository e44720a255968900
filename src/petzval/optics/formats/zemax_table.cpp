// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/whole_file.h>
#include <petzval/optics/formats/isetparms.h>
#include <petzval/optics/formats/psf_listing.h>
#include <petzval/optics/formats/zemax_table.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>

namespace petzval {

namespace fs = std::filesystem;

namespace {

/// Larger text files are none of these.
constexpr std::size_t most_text_bytes = std::size_t{1} << 30;
/// Room for the PSFs of a table.
constexpr double most_memory = 8.0 * (1 << 30);

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// The files of a folder by their names in lower case.
class Folder {
 public:
  explicit Folder(fs::path path) : path_(std::move(path)) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(path_.empty() ? "." : path_, error))
      files_[lower(entry.path().filename().string())] = entry.path().string();
    if (error) throw InputError(path_.string(), "cannot be read: " + error.message());
  }

  std::optional<std::string> find(const std::string& name) const {
    const auto found = files_.find(lower(name));
    return found == files_.end() ? std::nullopt : std::optional(found->second);
  }

  /// The first that there is.
  std::string find_any(const std::vector<std::string>& names) const {
    for (const std::string& name : names)
      if (const std::optional<std::string> path = find(name)) return *path;
    throw InputError((path_ / names.front()).string(),
                     fmt::format("is missing; \"{}\" or the like would be right", names.back()));
  }

  std::vector<std::string> with(const std::string& part, const std::string& end) const {
    std::vector<std::string> found;
    for (const auto& [name, path] : files_)
      if (name.find(part) != std::string::npos && name.ends_with(end)) found.push_back(path);
    return found;
  }

 private:
  fs::path path_;
  std::map<std::string, std::string> files_;
};

std::string parameters_path(const std::string& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return path;
  const std::vector<std::string> found = Folder(path).with("isetparms", ".txt");
  if (found.size() != 1)
    throw InputError(path, fmt::format("holds {} files named *ISETPARMS*.TXT; name the one to read",
                                       found.empty() ? "no" : std::to_string(found.size())));
  return found.front();
}

/// A matrix of field heights × wavelengths, and nothing else.
std::vector<double> read_curves(const std::string& path, std::size_t fields, std::size_t waves) {
  std::vector<double> values;
  for (const TextLine& line : text_lines(decoded_text(read_whole_file(path, most_text_bytes))))
    for (const std::string& word : line.words) {
      const std::optional<double> value = parse_number(word);
      if (!value)
        throw InputError(path, line.number, fmt::format("\"{}\" is no finite number", quotable(word)));
      values.push_back(*value);
    }
  if (values.size() != fields * waves)
    throw InputError(path, fmt::format("has {} values; {} field heights × {} wavelengths make {}",
                                       values.size(), fields, waves, fields * waves));
  return values;
}

/// Names of the files: with the base name as it stands, and without an extension that it may have.
class Names {
 public:
  explicit Names(const std::string& base) : bases_{base} {
    if (const std::string stem = fs::path(base).stem().string(); stem != base) bases_.push_back(stem);
  }
  std::vector<std::string> with(const std::vector<std::string>& ends) const {
    std::vector<std::string> names;
    for (const std::string& base : bases_)
      for (const std::string& end : ends) names.push_back(base + end);
    return names;
  }

 private:
  std::vector<std::string> bases_;
};

void refuse_absurd(const IsetParameters& parameters, const std::string& path) {
  const double side = parameters.psf_size > 0 ? parameters.psf_size : 1;
  const double entries =
      double(parameters.data.field_height_mm.size()) * double(parameters.data.wavelengths_nm.size());
  const double bytes = 4 * side * side * entries;
  if (bytes > most_memory)
    throw InputError(path,
                     fmt::format("{:g} PSFs of {:g} x {:g} samples would take {:.3g} GiB of memory; at most "
                                 "{:g} GiB are read",
                                 entries, side, side, bytes / (1 << 30), most_memory / (1 << 30)));
}

struct ListingReader {
  ListingProgram program;
  PsfLie lie;
  double spacing_um = 0;  ///< of listings that do not say
  int size = 0;
  std::vector<std::string>& notes;
  bool guessed = false;

  PsfAway away_of(const PsfListing& listing) {
    if (lie.away) return *lie.away;
    if (listing.image_point_mm) {
      const auto [x, y] = *listing.image_point_mm;
      if (std::abs(x) > std::abs(y)) return x > 0 ? PsfAway::right : PsfAway::left;
      if (y != 0) return y > 0 ? PsfAway::up : PsfAway::down;
    }
    const PsfAway usual = program == ListingProgram::zemax ? PsfAway::down : PsfAway::up;
    const bool on_axis = listing.image_point_mm.has_value();
    if (!on_axis && !guessed) {
      guessed = true;
      notes.push_back(
          fmt::format("the PSF listings do not say where they lie: away from the axis is taken to be {} "
                      "(`psf_away` sets another)",
                      away_text(usual)));
    }
    return usual;
  }

  Psf read(const std::string& path) {
    const PsfListing listing = read_psf_listing(read_whole_file(path, most_text_bytes), path, size);
    PsfFrame frame{away_of(listing), listing.centre_row, listing.centre_column};
    if (lie.centre) {
      frame.centre_row = lie.centre->first - 1;
      frame.centre_column = lie.centre->second - 1;
    }
    const double spacing = listing.spacing_um > 0 ? listing.spacing_um : spacing_um;
    if (!(spacing > 0))
      throw InputError(path, "does not say the spacing of its samples, nor does ISETPARMS (psfSpacing)");
    try {
      return psf_of_grid(listing.grid, frame, spacing);
    } catch (const InputError& error) {
      throw InputError(path, error.what());
    }
  }
};

/// rtImportData reckons the heights from their number and the largest.
bool even_steps(const std::vector<double>& heights) {
  for (std::size_t i = 0; i < heights.size(); ++i)
    if (std::abs(double(i) / double(heights.size() - 1) * heights.back() - heights[i]) >
        1e-9 * heights.back())
      return false;
  return true;
}

std::string curves_text(const std::vector<double>& values, std::size_t waves) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i)
    text += fmt::format("{}{}", values[i], (i + 1) % waves == 0 ? '\n' : ' ');
  return text;
}

}  // namespace

RayTraceFile read_zemax_table(const std::string& path, ListingProgram program, const PsfLie& lie) {
  const std::string parameters_file = parameters_path(path);
  IsetParameters parameters =
      read_isetparms(decoded_text(read_whole_file(parameters_file, most_text_bytes)), parameters_file);
  refuse_absurd(parameters, parameters_file);
  RayTraceFile file{std::move(parameters.data), {}};
  RayTraceData& data = file.data;
  if (program == ListingProgram::codev) data.program = "CODE V";
  const Folder folder(fs::path(parameters_file).parent_path());
  const Names names(parameters.base_name);
  const std::size_t fields = data.field_height_mm.size(), waves = data.wavelengths_nm.size();
  data.distorted_height_mm = read_curves(folder.find_any(names.with({"_DI_.dat"})), fields, waves);
  for (double& height : data.distorted_height_mm) height = std::abs(height);
  data.relative_illumination = read_curves(folder.find_any(names.with({"_RI_.dat"})), fields, waves);
  ListingReader reader{program, lie, parameters.psf_spacing_um,
                       program == ListingProgram::codev ? parameters.psf_size : 0, file.notes};
  for (std::size_t f = 1; f <= fields; ++f)
    for (std::size_t w = 1; w <= waves; ++w)
      data.psf.push_back(reader.read(folder.find_any(
          names.with({fmt::format("_2D_PSF_Fld{}_Wave{}.dat", f, w), fmt::format("_PSF_{}_{}.dat", f, w)}))));
  for (const std::string& name : names.with({"_PETZVAL.json"}))
    if (const std::optional<std::string> kept = folder.find(name))
      data.kept = read_whole_file(*kept, most_text_bytes);
  return file;
}

std::vector<std::string> write_zemax_table(const RayTraceData& data, const std::string& folder,
                                           const std::string& base_name, StagedFiles& files) {
  int largest = 0;
  for (const Psf& psf : data.psf) largest = std::max(largest, psf.size);
  const int size = largest + 2 - largest % 2;  // even, as ISET wants it, with room on either side
  const auto write = [&](const std::string& name, const std::string& text) {
    write_whole_file(files.stage((fs::path(folder) / name).string()), text);
  };
  const std::size_t waves = data.wavelengths_nm.size();
  write("ISETPARMS.TXT", isetparms_text(data, base_name, size));
  write(base_name + "_DI_.dat", curves_text(data.distorted_height_mm, waves));
  write(base_name + "_RI_.dat", curves_text(data.relative_illumination, waves));
  write(base_name + "_PETZVAL.json", data.kept + "\n");
  for (std::size_t i = 0; i < data.psf.size(); ++i)
    write(fmt::format("{}_2D_PSF_Fld{}_Wave{}.dat", base_name, i / waves + 1, i % waves + 1),
          psf_listing_text(data.psf[i], size, data.wavelengths_nm[i % waves], data.distorted_height_mm[i],
                           data.lens_file));
  if (even_steps(data.field_height_mm)) return {};
  return {
      "the image heights are no even steps, which ISET's rtImportData takes them to be: Petzval reads these "
      "files right, ISET needs an export to iset"};
}

}  // namespace petzval
