// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/helper_process.h>
#include <petzval/base/parallel.h>
#include <petzval/base/scratch_folder.h>
#include <petzval/optics/psf_squares.h>
#include <petzval/optics/table_file.h>
#include <petzval/optics/table_layout.h>
#include <petzval/optics/table_seal.h>
#include <petzval/scene/formats/hdf5_handle.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <vector>

namespace petzval {

namespace {

using Sizes = std::vector<hsize_t>;

/// More fields or wavelengths than any table has.
constexpr hsize_t longest_axis = 100'000;
/// More memory than a dataset is given [bytes].
constexpr double most_bytes = 8.0 * (1 << 30);
/// Deflate packs at most 1032 bytes into one (zlib's technical notes); a dataset that claims more is damaged.
constexpr double best_compression = 1100;
constexpr double bytes_per_gib = 1 << 30;
/// Of a first-order number that the file leaves out.
constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// What a table file says, with its name in every complaint.
class TableFile {
 public:
  explicit TableFile(const std::string& path) : path_(path) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) refuse("no such file");
    if (H5Fis_hdf5(path.c_str()) <= 0)
      refuse("is not an HDF5 file; petzval optics build makes lens data tables");
    file_ = {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
    if (!file_) refuse("cannot be opened by HDF5; it is damaged or truncated");
  }

  [[noreturn]] void refuse(const std::string& what) const { throw InputError(path_, what); }

  hid_t root() const { return file_.id(); }

  Hdf5Handle group(const char* name) const {
    Hdf5Handle group(H5Gopen2(root(), name, H5P_DEFAULT), H5Gclose);
    if (!group) refuse(fmt::format("has no group {}", name));
    return group;
  }

  /// A text attribute of variable or fixed length.
  std::string text(const char* name) const {
    const Hdf5Handle attribute = scalar_attribute(root(), name);
    const Hdf5Handle type(H5Aget_type(attribute.id()), H5Tclose);
    if (!type || H5Tget_class(type.id()) != H5T_STRING) refuse(fmt::format("attribute {} is not text", name));
    std::string value;
    if (H5Tis_variable_str(type.id()) > 0) {
      char* read = nullptr;
      if (H5Aread(attribute.id(), type.id(), &read) < 0 || !read)
        refuse(fmt::format("attribute {} cannot be read", name));
      value = read;
      H5free_memory(read);
    } else {
      value.resize(H5Tget_size(type.id()));
      if (H5Aread(attribute.id(), type.id(), value.data()) < 0)
        refuse(fmt::format("attribute {} cannot be read", name));
      value.resize(std::min(value.find('\0'), value.size()));
    }
    return value;
  }

  double number(hid_t object, const char* name) const {
    const Hdf5Handle attribute = scalar_attribute(object, name);
    const Hdf5Handle type(H5Aget_type(attribute.id()), H5Tclose);
    double value = 0;
    if (!is_number(type) || H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, &value) < 0 || std::isnan(value))
      refuse(fmt::format("attribute {} is not a number", name));
    return value;
  }

  /// A dataset of numbers and its sizes.
  std::pair<Hdf5Handle, Sizes> dataset(const char* name) const {
    Hdf5Handle data(H5Dopen2(root(), name, H5P_DEFAULT), H5Dclose);
    if (!data) refuse(fmt::format("has no dataset {}", name));
    const Hdf5Handle type(H5Dget_type(data.id()), H5Tclose), space(H5Dget_space(data.id()), H5Sclose);
    if (!is_number(type)) refuse(fmt::format("dataset {} does not hold numbers", name));
    const int rank = space ? H5Sget_simple_extent_ndims(space.id()) : -1;
    if (rank < 0) refuse(fmt::format("dataset {} has no sizes", name));
    Sizes sizes(static_cast<std::size_t>(rank));
    if (rank > 0 && H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr) < 0)
      refuse(fmt::format("dataset {} has no sizes", name));
    return {std::move(data), std::move(sizes)};
  }

  std::vector<double> axis(const char* name) const {
    const auto [data, sizes] = dataset(name);
    if (sizes.size() != 1 || sizes[0] < 1 || sizes[0] > longest_axis)
      refuse(fmt::format("dataset {} is [{}]; one axis of 1 to {} entries is expected", name,
                         fmt::join(sizes, " x "), longest_axis));
    return values(data, name, sizes);
  }

  std::vector<double> matrix(const char* name, const Sizes& expected) const {
    const auto [data, sizes] = dataset(name);
    if (sizes != expected)
      refuse(fmt::format("dataset {} is [{}]; the axes make it [{}]", name, fmt::join(sizes, " x "),
                         fmt::join(expected, " x ")));
    return values(data, name, sizes);
  }

  /// Refuses what would not fit into memory, and what cannot be in the file, before any memory is taken.
  void require_plausible(const Hdf5Handle& data, const char* name, const Sizes& sizes,
                         std::size_t bytes_each) const {
    auto bytes = static_cast<double>(bytes_each);
    for (const hsize_t size : sizes) bytes *= static_cast<double>(size);
    if (bytes > most_bytes)
      refuse(
          fmt::format("dataset {} is [{}] and would take {:.3g} GiB of memory; at most {:.3g} GiB are read",
                      name, fmt::join(sizes, " x "), bytes / bytes_per_gib, most_bytes / bytes_per_gib));
    const auto stored = static_cast<double>(H5Dget_storage_size(data.id()));
    if (stored * best_compression < bytes)
      refuse(fmt::format("dataset {} claims {:.6g} bytes but {:.6g} are stored; it is damaged or incomplete",
                         name, bytes, stored));
  }

 private:
  static bool is_number(const Hdf5Handle& type) {
    const H5T_class_t kind = type ? H5Tget_class(type.id()) : H5T_NO_CLASS;
    return kind == H5T_FLOAT || kind == H5T_INTEGER;
  }

  Hdf5Handle scalar_attribute(hid_t object, const char* name) const {
    Hdf5Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
    if (!attribute) refuse(fmt::format("has no attribute {}; is it a Petzval lens data table?", name));
    const Hdf5Handle space(H5Aget_space(attribute.id()), H5Sclose);
    if (!space || H5Sget_simple_extent_npoints(space.id()) != 1)
      refuse(fmt::format("attribute {} is a list; one value is expected", name));
    return attribute;
  }

  std::vector<double> values(const Hdf5Handle& data, const char* name, const Sizes& sizes) const {
    require_plausible(data, name, sizes, sizeof(double));
    std::size_t count = 1;
    for (const hsize_t size : sizes) count *= size;
    std::vector<double> numbers(count);
    if (H5Dread(data.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()) < 0)
      refuse(fmt::format("dataset {} cannot be read; it is damaged", name));
    return numbers;
  }

  std::string path_;
  Hdf5Handle file_;
};

void read_header(const TableFile& file, LensDataTable& table) {
  const std::string format = file.text("format");
  if (format == table_layout::frame_format)
    table.frame.emplace();
  else if (format != table_layout::format)
    file.refuse(fmt::format("has the format \"{}\"; this version reads {} and {}", format,
                            table_layout::format, table_layout::frame_format));
  table.lens_name = file.text("lens_name");
  table.lens_json = file.text("lens_json");
  table.provenance = file.text("provenance");
  if (const double distance = file.number(file.root(), "object_distance_mm"); !std::isinf(distance))
    table.object_distance_mm = distance;
  table.vertex_to_sensor_mm = file.number(file.root(), "vertex_to_sensor_mm");
  if (H5Aexists(file.root(), "stop_semi_diameter_mm") > 0)
    table.stop_semi_diameter_mm = file.number(file.root(), "stop_semi_diameter_mm");
  const Hdf5Handle group = file.group(table_layout::first_order);
  table_layout::for_each_first_order(table.first_order, [&](const char* name, double& number) {
    number = H5Aexists(group.id(), name) > 0 ? file.number(group.id(), name) : not_known;
  });
}

/// Places over the frame.
void read_frame(const TableFile& file, LensDataTable& table) {
  FramePlaces& frame = *table.frame;
  frame.x_mm = file.axis(table_layout::image_x);
  frame.y_mm = file.axis(table_layout::image_y);
  const Sizes both{frame.count(), table.wavelengths_nm.size()};
  frame.object_x = file.matrix(table_layout::object_x, both);
  frame.object_y = file.matrix(table_layout::object_y, both);
  frame.psf_azimuth_deg = file.matrix(table_layout::psf_azimuth, both);
}

/// The side of the squares that hold the PSFs.
hsize_t psf_side(const TableFile& file, const Hdf5Handle& data, const Sizes& sizes, const Sizes& table) {
  if (sizes.size() != 4 || sizes[0] != table[0] || sizes[1] != table[1] || sizes[2] != sizes[3] ||
      sizes[2] < 1)
    file.refuse(fmt::format("dataset psf is [{}]; the axes make it [{} x N x N]", fmt::join(sizes, " x "),
                            fmt::join(table, " x ")));
  file.require_plausible(data, table_layout::psf, sizes, sizeof(float));
  return sizes[2];
}

void read_psfs(const TableFile& file, bool sealed, LensDataTable& table) {
  const Sizes both{table.places(), table.wavelengths_nm.size()};
  const std::vector<double> size = file.matrix(table_layout::psf_size, both);
  const std::vector<double> spacing = file.matrix(table_layout::psf_spacing, both);
  const std::vector<double> captured = file.matrix(table_layout::psf_captured, both);
  const auto [data, sizes] = file.dataset(table_layout::psf);
  const hsize_t side = psf_side(file, data, sizes, both);
  for (const double own : size)
    if (!(own >= 1 && own <= static_cast<double>(side)) || own != std::floor(own))
      file.refuse(fmt::format("psf_size {} does not fit into squares of {} samples", own, side));

  const PsfSquares squares(data, side, sealed);
  std::vector<char> good(size.size());
  table.psf.resize(size.size());
  const auto read = [&](std::size_t i) {
    Psf& psf = table.psf[i];
    psf.size = static_cast<int>(size[i]);
    psf.spacing_um = spacing[i];
    psf.captured = captured[i];
    good[i] = squares.read(i / both[1], i % both[1], static_cast<hsize_t>(psf.size), psf.values) ? 1 : 0;
  };
  if (squares.inflates_itself())
    parallel_for(size.size(), read);
  else
    for (std::size_t i = 0; i < size.size(); ++i) read(i);
  if (const auto bad = std::find(good.begin(), good.end(), 0); bad != good.end()) {
    const auto i = static_cast<std::size_t>(bad - good.begin());
    file.refuse(fmt::format("the PSF of place {} and wavelength {} cannot be read; the file is damaged",
                            i / both[1], i % both[1]));
  }
}

/// \param sealed  whether the file is as a writer of ours left it.
LensDataTable read_file(const std::string& path, bool sealed) {
  const Hdf5Silence silence;
  const TableFile file(path);
  LensDataTable table;
  read_header(file, table);
  if (!table.frame) table.fields = file.axis(table_layout::field);
  table.wavelengths_nm = file.axis(table_layout::wavelength);
  if (table.frame) read_frame(file, table);
  const Sizes both{table.places(), table.wavelengths_nm.size()};
  if (!table.frame) table.real_image_height_mm = file.matrix(table_layout::height, both);
  table.g_source_sr = file.matrix(table_layout::g_source, both);
  table.g_sensor_sr = file.matrix(table_layout::g_sensor, both);
  read_psfs(file, sealed, table);
  try {
    table.validate();
  } catch (const InputError& error) {
    file.refuse(error.what());
  }
  return table;
}

/// A table that may crash HDF5: a program of its own reads it and writes it with a seal.
LensDataTable read_apart(const std::string& path) {
  const ScratchFolder folder;
  const std::string sealed = folder.path() + "/sealed.h5";
  const HelperEnd end = run_helper(helper_program("petzval-read-hdf5"), {"table", path, sealed});
  if (end == HelperEnd::crashed) throw InputError(path, "is damaged: the HDF5 library crashes on it");
  if (end == HelperEnd::endless) throw InputError(path, "is damaged: the HDF5 library finds no end");
  return read_table(sealed);
}

}  // namespace

LensDataTable read_table(const std::string& path, TableOrigin origin) {
  if (origin == TableOrigin::elsewhere) return read_apart(path);
  check_table_seal(path);
  return read_file(path, true);
}

void seal_table(const std::string& path, const std::string& sealed) {
  write_table(read_file(path, false), sealed);
}

}  // namespace petzval
