// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/scene/formats/hdf5_handle.h>
#include <petzval/scene/formats/mat_hdf5.h>
#include <petzval/scene/formats/mat_hdf5_array.h>
#include <petzval/scene/formats/mat_records.h>

#include <algorithm>
#include <array>
#include <vector>

namespace petzval {

namespace {

constexpr int max_hdf5_depth = 32;  // of structs within structs, as in version 5
constexpr int max_items = 100000;   // links may name one thing under any number of names
constexpr std::size_t max_hdf5_name = 63;

std::string joined(const std::string& holder, const std::string& field) {
  return holder.empty() ? field : holder + "." + field;
}

bool is_matlab_name(const std::string& name) {
  return name.size() <= max_hdf5_name && std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
         });
}

/// With room for the pieces that large arrays are packed in, which would be unpacked again and again.
Hdf5Handle opened(const std::string& path) {
  constexpr std::size_t slots = 12421, room_bytes = std::size_t{1} << 28;
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_cache(access.id(), 0, slots, room_bytes, 1.0);
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose};
}

std::vector<std::string> names_in(hid_t group) {
  std::vector<std::string> names;
  H5Literate(
      group, H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t, const char* name, const H5L_info_t*, void* into) -> herr_t {
        auto& all = *static_cast<std::vector<std::string>*>(into);
        all.emplace_back(name);
        return all.size() > max_items;
      },
      &names);
  return names;
}

class Hdf5Walker {
 public:
  Hdf5Walker(const std::string& path, int descriptor)
      : path_(path), writer_(descriptor), file_(opened(path)) {
    if (!file_) damaged("HDF5 cannot open it");
  }

  void write(const std::string& variable) {
    if (H5Lexists(file_.id(), variable.c_str(), H5P_DEFAULT) > 0) write_member(file_.id(), variable, "", 0);
  }

 private:
  [[noreturn]] void refuse(const std::string& message) const { throw InputError(path_, message); }
  [[noreturn]] void damaged(const std::string& message) const { refuse_damaged_mat(path_, message); }

  void write_plain(MatRecordKind kind, const std::string& name) {
    MatRecord record;
    record.kind = kind;
    record.name = name;
    writer_.begin(record);
  }

  /// What a group has under this name: one record, whatever it is.
  void write_member(hid_t group, const std::string& name, const std::string& holder, int depth) {
    if (!is_matlab_name(name)) damaged("a field has a name that MATLAB has not");
    H5L_info_t link;
    if (H5Lget_info(group, name.c_str(), &link, H5P_DEFAULT) < 0)
      damaged(joined(holder, name) + " cannot be found");
    // Others lead to names, of this file or another one; MATLAB writes none.
    if (link.type != H5L_TYPE_HARD) return write_plain(MatRecordKind::other, name);
    const Hdf5Handle object(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose);
    write_object(object, name, joined(holder, name), depth);
  }

  void write_object(const Hdf5Handle& object, const std::string& name, const std::string& full, int depth) {
    if (!object) damaged(full + " cannot be read");
    if (depth > max_hdf5_depth)
      refuse(fmt::format("is damaged: structs are nested more than {} deep", max_hdf5_depth));
    if (++items_ > max_items) refuse(fmt::format("holds more than {} fields", max_items));
    const H5I_type_t type = H5Iget_type(object.id());
    if (type == H5I_GROUP) return write_group(object.id(), name, full, depth);
    if (type == H5I_DATASET) return write_data(object.id(), name, full, depth);
    write_plain(MatRecordKind::other, name);
  }

  void write_group(hid_t group, const std::string& name, const std::string& full, int depth) {
    // A group of another class is an object, or a sparse array.
    if (class_of(group) != "struct") return write_plain(MatRecordKind::other, name);
    const std::vector<std::string> fields = names_in(group);
    MatRecord record;
    record.kind = MatRecordKind::structure;
    record.name = name;
    record.fields = fields.size();
    writer_.begin(record);
    for (const std::string& field : fields) write_member(group, field, full, depth + 1);
  }

  void write_data(hid_t data, const std::string& name, const std::string& full, int depth) {
    const std::string word = class_of(data);
    const Hdf5Handle type(H5Dget_type(data), H5Tclose), space(H5Dget_space(data), H5Sclose);
    const hssize_t count = H5Sget_simple_extent_npoints(space.id());
    if (!type || !space || count < 0) damaged(full + " has no size");
    const H5T_class_t stored = H5Tget_class(type.id());
    if (count == 0 || H5Aexists(data, "MATLAB_empty") > 0) return write_plain(MatRecordKind::nothing, name);
    // Fields of an array of structs are references; an array of one is as good as a struct.
    if (stored == H5T_REFERENCE && word.empty() && count == 1 && H5Tequal(type.id(), H5T_STD_REF_OBJ) > 0)
      return write_referenced(data, name, full, depth);
    const MatArrayClass* const kind = find_mat_array_class(word);
    const bool matches = stored == H5T_INTEGER || (stored == H5T_FLOAT && kind && !kind->is_text());
    if (!kind || !matches || H5Tget_size(type.id()) > 8) return write_plain(MatRecordKind::other, name);
    write_mat_array(data, *kind, name, full, path_, writer_);
  }

  void write_referenced(hid_t data, const std::string& name, const std::string& full, int depth) {
    hobj_ref_t reference{};
    if (H5Dread(data, H5T_STD_REF_OBJ, H5S_ALL, H5S_ALL, H5P_DEFAULT, &reference) < 0)
      damaged(full + " cannot be read");
    const Hdf5Handle object(H5Rdereference2(file_.id(), H5P_DEFAULT, H5R_OBJECT, &reference), H5Oclose);
    write_object(object, name, full, depth + 1);
  }

  /// MATLAB_class, or nothing.
  std::string class_of(hid_t object) const {
    if (H5Aexists(object, "MATLAB_class") <= 0) return "";
    const Hdf5Handle attribute(H5Aopen(object, "MATLAB_class", H5P_DEFAULT), H5Aclose);
    const Hdf5Handle type(H5Aget_type(attribute.id()), H5Tclose),
        space(H5Aget_space(attribute.id()), H5Sclose);
    std::array<char, 64> word{};
    const std::size_t size = H5Tget_size(type.id());
    if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) != 0 || size >= word.size() ||
        H5Sget_simple_extent_npoints(space.id()) != 1)
      return "";
    if (H5Aread(attribute.id(), type.id(), word.data()) < 0) return "";
    return word.data();
  }

  const std::string& path_;
  MatRecordWriter writer_;
  Hdf5Handle file_;
  int items_ = 0;
};

}  // namespace

void write_mat_hdf5_records(const std::string& path, const std::vector<std::string>& variables,
                            int descriptor) {
  const Hdf5Silence silence;
  H5PLset_loading_state(0);  // no code from elsewhere, whatever filter a file asks for
  Hdf5Walker walker(path, descriptor);
  for (const std::string& variable : variables) walker.write(variable);
}

}  // namespace petzval
