// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/optics/table_file.h>
#include <petzval/optics/table_layout.h>
#include <petzval/optics/table_seal.h>
#include <petzval/scene/formats/hdf5_handle.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace petzval {

namespace {

using Sizes = std::vector<hsize_t>;

/// Level of gzip: PSFs hardly shrink further above it, and take twice the time.
constexpr unsigned gzip_level = 4;

/// Nothing here depends on the outside world but memory: a call that fails is a failure, not bad input.
void require(bool done) {
  if (!done) throw Failure("the lens data table cannot be put together in memory (HDF5 reports an error)");
}

Hdf5Handle checked(hid_t id, Hdf5Handle::Close close) {
  require(id >= 0);
  return {id, close};
}

Hdf5Handle utf8_type() {
  Hdf5Handle type = checked(H5Tcopy(H5T_C_S1), H5Tclose);
  require(H5Tset_size(type.id(), H5T_VARIABLE) >= 0 && H5Tset_cset(type.id(), H5T_CSET_UTF8) >= 0);
  return type;
}

Hdf5Handle space_of(const Sizes& sizes) {
  return sizes.empty()
             ? checked(H5Screate(H5S_SCALAR), H5Sclose)
             : checked(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose);
}

void write_attribute(hid_t object, const char* name, hid_t type, const Sizes& sizes, const void* data) {
  const Hdf5Handle space = space_of(sizes);
  const Hdf5Handle attribute =
      checked(H5Acreate2(object, name, type, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  require(H5Awrite(attribute.id(), type, data) >= 0);
}

void write_texts(hid_t object, const char* name, const std::vector<std::string>& texts, const Sizes& sizes) {
  std::vector<const char*> pointers;
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  write_attribute(object, name, utf8_type().id(), sizes, pointers.data());
}

void write_text(hid_t object, const char* name, const std::string& text) {
  write_texts(object, name, {text}, {});
}

void write_number(hid_t object, const char* name, double number) {
  const Hdf5Handle space = space_of({});
  const Hdf5Handle attribute =
      checked(H5Acreate2(object, name, H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  require(H5Awrite(attribute.id(), H5T_NATIVE_DOUBLE, &number) >= 0);
}

/// A dataset with units and long_name. Chunks, where there are any, are compressed and carry a checksum each.
Hdf5Handle create_dataset(hid_t file, const char* name, hid_t type, const Sizes& sizes, const Sizes& chunk,
                          const std::string& units, const std::string& long_name) {
  const Hdf5Handle properties = checked(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  require(H5Pset_obj_track_times(properties.id(), false) >= 0);
  if (!chunk.empty())
    require(H5Pset_chunk(properties.id(), static_cast<int>(chunk.size()), chunk.data()) >= 0 &&
            H5Pset_shuffle(properties.id()) >= 0 && H5Pset_deflate(properties.id(), gzip_level) >= 0 &&
            H5Pset_fletcher32(properties.id()) >= 0);
  const Hdf5Handle space = space_of(sizes);
  Hdf5Handle dataset =
      checked(H5Dcreate2(file, name, type, space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT), H5Dclose);
  write_text(dataset.id(), "units", units);
  write_text(dataset.id(), "long_name", long_name);
  return dataset;
}

template <typename Number>
Hdf5Handle write_dataset(hid_t file, const char* name, const std::vector<Number>& values, const Sizes& sizes,
                         const std::string& units, const std::string& long_name) {
  constexpr bool real = std::is_same_v<Number, double>;
  Hdf5Handle dataset =
      create_dataset(file, name, real ? H5T_IEEE_F64LE : H5T_STD_I32LE, sizes, {}, units, long_name);
  const hid_t memory = real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT;
  require(H5Dwrite(dataset.id(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
  return dataset;
}

/// Datasets over the axes object_field (or place) and wavelength, joined to them as the HDF5 Dimension Scale
/// Specification (version 1.0) lays down, so that h5py and netCDF readers find the coordinates.
class Scales {
 public:
  Scales(const Hdf5Handle& place, const char* place_name, const Hdf5Handle& wavelength)
      : axes_{place.id(), wavelength.id()} {
    const char* names[] = {place_name, table_layout::wavelength};
    for (int axis = 0; axis < 2; ++axis) {
      write_fixed_text(axes_[axis], "CLASS", "DIMENSION_SCALE");
      write_fixed_text(axes_[axis], "NAME", names[axis]);
      require(H5Rcreate(&references_[axis], axes_[axis], ".", H5R_OBJECT, -1) >= 0);
    }
  }

  void attach(const Hdf5Handle& dataset, const std::vector<std::string>& labels) {
    write_texts(dataset.id(), "DIMENSION_LABELS", labels, {labels.size()});
    std::vector<hvl_t> list(labels.size(), hvl_t{0, nullptr});
    for (std::size_t axis = 0; axis < 2; ++axis) list[axis] = {1, &references_[axis]};
    const Hdf5Handle type = checked(H5Tvlen_create(H5T_STD_REF_OBJ), H5Tclose);
    write_attribute(dataset.id(), "DIMENSION_LIST", type.id(), {labels.size()}, list.data());
    hobj_ref_t self{};
    require(H5Rcreate(&self, dataset.id(), ".", H5R_OBJECT, -1) >= 0);
    users_.push_back(self);
  }

  /// The way back: each axis lists who uses it.
  void finish() const {
    struct User {
      hobj_ref_t dataset;
      int dimension;
    };
    const Hdf5Handle type = checked(H5Tcreate(H5T_COMPOUND, sizeof(User)), H5Tclose);
    require(H5Tinsert(type.id(), "dataset", HOFFSET(User, dataset), H5T_STD_REF_OBJ) >= 0 &&
            H5Tinsert(type.id(), "dimension", HOFFSET(User, dimension), H5T_NATIVE_INT) >= 0);
    for (int axis = 0; axis < 2; ++axis) {
      // Zeroed as a whole: the padding goes into the file too.
      std::vector<unsigned char> bytes(users_.size() * sizeof(User), 0);
      for (std::size_t i = 0; i < users_.size(); ++i) {
        auto* user = reinterpret_cast<User*>(bytes.data() + i * sizeof(User));
        user->dataset = users_[i];
        user->dimension = axis;
      }
      write_attribute(axes_[axis], "REFERENCE_LIST", type.id(), {users_.size()}, bytes.data());
    }
  }

 private:
  static void write_fixed_text(hid_t object, const char* name, const std::string& text) {
    const Hdf5Handle type = checked(H5Tcopy(H5T_C_S1), H5Tclose);
    require(H5Tset_size(type.id(), text.size() + 1) >= 0);
    write_attribute(object, name, type.id(), {}, text.c_str());
  }

  hid_t axes_[2];
  hobj_ref_t references_[2]{};
  std::vector<hobj_ref_t> users_;
};

/// One PSF in the middle of a square of `size` samples.
std::vector<float> padded(const Psf& psf, int size) {
  const int offset = size / 2 - psf.size / 2;
  std::vector<float> square(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), 0.0f);
  for (int i = 0; i < psf.size; ++i)
    std::copy_n(psf.values.begin() + static_cast<std::ptrdiff_t>(i) * psf.size, psf.size,
                square.begin() + static_cast<std::ptrdiff_t>(i + offset) * size + offset);
  return square;
}

Hdf5Handle write_psfs(hid_t file, const LensDataTable& table) {
  int size = 0;
  for (const Psf& psf : table.psf) size = std::max(size, psf.size);
  const auto side = static_cast<hsize_t>(size);
  const Sizes all{table.places(), table.wavelengths_nm.size(), side, side}, one{1, 1, side, side};
  Hdf5Handle dataset =
      create_dataset(file, table_layout::psf, H5T_IEEE_F32LE, all, one, "1",
                     table.frame ? "point-spread function centred on the real chief ray, sum 1; rows: along "
                                   "psf_azimuth; columns: a quarter turn clockwise from it"
                                 : "point-spread function centred on the real chief ray, sum 1; rows: "
                                   "tangential, away from the axis; columns: sagittal");
  const Hdf5Handle target = space_of(all), memory = space_of(one);
  for (std::size_t f = 0; f < all[0]; ++f)
    for (std::size_t w = 0; w < all[1]; ++w) {
      const Sizes start{f, w, 0, 0};
      const std::vector<float> square = padded(table.psf[table.index(f, w)], size);
      require(
          H5Sselect_hyperslab(target.id(), H5S_SELECT_SET, start.data(), nullptr, one.data(), nullptr) >= 0 &&
          H5Dwrite(dataset.id(), H5T_NATIVE_FLOAT, memory.id(), target.id(), H5P_DEFAULT, square.data()) >=
              0);
    }
  return dataset;
}

void write_header(hid_t file, const LensDataTable& table) {
  write_text(file, "format", table.frame ? table_layout::frame_format : table_layout::format);
  write_text(file, "lens_name", table.lens_name);
  write_text(file, "lens_json", table.lens_json);
  write_text(file, "provenance", table.provenance);
  write_number(file, "object_distance_mm",
               table.object_distance_mm.value_or(std::numeric_limits<double>::infinity()));
  write_number(file, "vertex_to_sensor_mm", table.vertex_to_sensor_mm);
  if (table.stop_semi_diameter_mm) write_number(file, "stop_semi_diameter_mm", *table.stop_semi_diameter_mm);
  const Hdf5Handle group =
      checked(H5Gcreate2(file, table_layout::first_order, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  table_layout::for_each_first_order(table.first_order, [&](const char* name, double number) {
    if (!std::isnan(number)) write_number(group.id(), name, number);  // NaN: not known
  });
}

std::vector<double> numbered(hsize_t count) {
  std::vector<double> numbers;
  for (hsize_t i = 0; i < count; ++i) numbers.push_back(double(i));
  return numbers;
}

void write_datasets(hid_t file, const LensDataTable& table) {
  const Sizes places{table.places()}, wavelengths{table.wavelengths_nm.size()};
  const Sizes both{places[0], wavelengths[0]};
  const bool finite = table.finite_object();
  const char* const place = table.frame ? table_layout::place : table_layout::field;
  const Hdf5Handle field =
      table.frame
          ? write_dataset(file, place, numbered(places[0]), places, "1",
                          "number of the place: row of image_y times places along image_x, and column")
          : write_dataset(file, place, table.fields, places, table.field_unit(),
                          finite ? "object height" : "object angle from the axis");
  const Hdf5Handle wavelength = write_dataset(file, table_layout::wavelength, table.wavelengths_nm,
                                              wavelengths, "nm", "wavelength in air");
  if (table.frame) {
    const FramePlaces& frame = *table.frame;
    write_dataset(file, table_layout::image_x, frame.x_mm, {frame.x_mm.size()}, "mm",
                  "where chief rays land, x' of image space");
    write_dataset(file, table_layout::image_y, frame.y_mm, {frame.y_mm.size()}, "mm",
                  "where chief rays land, y' of image space");
  }
  Scales scales(field, place, wavelength);
  const auto write = [&]<typename Number>(const char* name, const std::vector<Number>& values,
                                          const char* units, const char* long_name) {
    scales.attach(write_dataset(file, name, values, both, units, long_name),
                  {place, table_layout::wavelength});
  };
  std::vector<int> size;
  std::vector<double> spacing, captured;
  for (const Psf& psf : table.psf) {
    size.push_back(psf.size);
    spacing.push_back(psf.spacing_um);
    captured.push_back(psf.captured);
  }
  if (table.frame) {
    write(table_layout::object_x, table.frame->object_x, table.field_unit(),
          "field of the object, the part along image_x");
    write(table_layout::object_y, table.frame->object_y, table.field_unit(),
          "field of the object, the part along image_y");
    write(table_layout::psf_azimuth, table.frame->psf_azimuth_deg, "deg",
          "direction of the PSF's rows, anticlockwise from +y' as seen from the film");
  } else {
    write(table_layout::height, table.real_image_height_mm, "mm",
          "height of the real chief ray on the sensor");
  }
  write(table_layout::g_source, table.g_source_sr, "sr",
        "flux of an object point per area of its chief-ray image and per radiance");
  write(table_layout::g_sensor, table.g_sensor_sr, "sr", "irradiance under a uniform wall per radiance");
  write(table_layout::psf_size, size, "1", "samples a side of the PSF, in the middle of its square");
  write(table_layout::psf_spacing, spacing, "um", "spacing of the PSF's samples");
  write(table_layout::psf_captured, captured, "1", "share of the light inside the PSF's window");
  scales.attach(write_psfs(file, table), {place, table_layout::wavelength, "tangential", "sagittal"});
  scales.finish();
}

/// The HDF5 file behind its user block, made in memory: no error of a disk can reach HDF5.
std::string file_image(const LensDataTable& table) {
  constexpr std::size_t growth = 1 << 22;
  const Hdf5Handle access = checked(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  const Hdf5Handle creation = checked(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  require(H5Pset_fapl_core(access.id(), growth, false) >= 0 &&
          H5Pset_libver_bounds(access.id(), H5F_LIBVER_EARLIEST, H5F_LIBVER_V110) >= 0 &&
          H5Pset_userblock(creation.id(), table_seal_bytes) >= 0);
  const Hdf5Handle file =
      checked(H5Fcreate("lens data table", H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose);
  write_header(file.id(), table);
  write_datasets(file.id(), table);
  require(H5Fflush(file.id(), H5F_SCOPE_GLOBAL) >= 0);
  const ssize_t size = H5Fget_file_image(file.id(), nullptr, 0);
  require(size > 0);
  std::string image(static_cast<std::size_t>(size), '\0');
  require(H5Fget_file_image(file.id(), image.data(), image.size()) == size);
  return image;
}

}  // namespace

void write_table(const LensDataTable& table, const std::string& path) {
  table.validate();
  for (std::size_t entry = 0; entry < table.psf.size(); ++entry)
    if (!table.has_psf(entry))
      throw InputError(fmt::format(
          "the table was made for one image and leaves out the PSF of {}; one of all PSFs may be written",
          table.place_name(entry / table.wavelengths_nm.size())));
  const Hdf5Silence silence;
  const std::string image = file_image(table);
  write_whole_file(path, table_seal(image) + image);
}

}  // namespace petzval
