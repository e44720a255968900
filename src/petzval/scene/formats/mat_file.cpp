// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <matio.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/scene/formats/mat_file.h>
#include <petzval/scene/formats/mat_hdf5_apart.h>
#include <petzval/scene/formats/mat_records.h>
#include <petzval/scene/formats/mat_structure.h>

#include <mutex>

namespace petzval {

namespace {

/// matio tells its troubles to one function for the whole process and passes it nothing to remember the
/// reader by.
thread_local std::string matio_message;
void keep_matio_message(int, char* message) {
  matio_message = message;
}
std::mutex matio_mutex;

struct CloseMat {
  void operator()(mat_t* file) const { Mat_Close(file); }
};

template <typename Number>
double read_as(const void* data, std::size_t index) {
  return static_cast<double>(static_cast<const Number*>(data)[index]);
}

struct NumberType {
  double (*read)(const void*, std::size_t) = nullptr;
  std::size_t size = 0;
  int unsigned_bits = 0;
};

/// How to read what matio has in memory; nothing for data that are no numbers.
NumberType number_type(const matvar_t& variable) {
  switch (variable.data_type) {
    case MAT_T_DOUBLE:
      return {read_as<double>, 8, 0};
    case MAT_T_SINGLE:
      return {read_as<float>, 4, 0};
    case MAT_T_INT8:
      return {read_as<std::int8_t>, 1, 0};
    case MAT_T_INT16:
      return {read_as<std::int16_t>, 2, 0};
    case MAT_T_INT32:
      return {read_as<std::int32_t>, 4, 0};
    case MAT_T_INT64:
      return {read_as<std::int64_t>, 8, 0};
    case MAT_T_UINT8:
      return {read_as<std::uint8_t>, 1, 8};
    case MAT_T_UINT16:
      return {read_as<std::uint16_t>, 2, 16};
    case MAT_T_UINT32:
      return {read_as<std::uint32_t>, 4, 32};
    case MAT_T_UINT64:
      return {read_as<std::uint64_t>, 8, 64};
    default:
      return {};
  }
}

std::size_t element_count(const matvar_t& variable) {
  std::size_t count = 1;
  for (int i = 0; i < variable.rank; ++i) count *= variable.dims[i];
  return count;
}

bool is_nothing(const matvar_t& variable) {
  return variable.class_type == MAT_C_EMPTY || variable.rank == 0 || element_count(variable) == 0;
}

bool is_number_class(const matvar_t& variable) {
  return variable.class_type >= MAT_C_DOUBLE && variable.class_type <= MAT_C_UINT64;
}

}  // namespace

std::vector<double> MatNumbers::values() const {
  std::vector<double> result(size_);
  for (std::size_t i = 0; i < size_; ++i) result[i] = (*this)[i];
  return result;
}

bool MatValue::is_struct() const {
  return variable_->class_type == MAT_C_STRUCT;
}

std::optional<MatValue> MatValue::find(const std::string& field) const {
  if (!is_struct() || element_count(*variable_) != 1) fail("must be a single struct");
  // matio's look-up takes a variable that it may alter, and leaves it as it is.
  const matvar_t* found = Mat_VarGetStructFieldByName(const_cast<matvar_t*>(variable_), field.c_str(), 0);
  if (!found || is_nothing(*found)) return std::nullopt;
  return MatValue(found, name_ + "." + field, *file_);
}

MatValue MatValue::at(const std::string& field) const {
  if (const std::optional<MatValue> found = find(field)) return *found;
  throw InputError(*file_, fmt::format("has no {}.{}", name_, field));
}

MatNumbers MatValue::numbers() const {
  const NumberType type = number_type(*variable_);
  if (!is_number_class(*variable_) || variable_->isComplex || !type.read)
    fail("must be an array of real numbers");
  MatNumbers result;
  result.size_ = element_count(*variable_);
  if (!variable_->data || variable_->nbytes != result.size_ * type.size) fail("could not be read whole");
  result.data_ = variable_->data;
  result.read_ = type.read;
  result.unsigned_bits_ = type.unsigned_bits;
  result.dimensions_.assign(variable_->dims, variable_->dims + variable_->rank);
  return result;
}

double MatValue::number() const {
  const MatNumbers all = numbers();
  if (all.size() != 1) fail(fmt::format("must be one number, not {}", all.size()));
  return all[0];
}

std::string MatValue::text() const {
  const NumberType type = variable_->data_type == MAT_T_UTF8    ? NumberType{read_as<std::uint8_t>, 1, 8}
                          : variable_->data_type == MAT_T_UTF16 ? NumberType{read_as<std::uint16_t>, 2, 16}
                                                                : number_type(*variable_);
  if (variable_->class_type != MAT_C_CHAR || !variable_->data || !type.read) return "";
  std::string result;
  for (std::size_t i = 0; i < variable_->nbytes / type.size; ++i) {
    const double code = type.read(variable_->data, i);
    result += code >= ' ' && code <= '~' ? static_cast<char>(code) : '?';
  }
  return result;
}

void MatValue::fail(const std::string& message) const {
  throw InputError(*file_, fmt::format("{} {}", name_, message));
}

void MatFile::Free::operator()(matvar_t* variable) const {
  Mat_VarFree(variable);
}

MatFile::MatFile(const std::string& path, const std::vector<std::string>& variables)
    : path_(path), names_(variables) {
  if (is_mat_hdf5(path))
    read_hdf5();
  else
    read_matio();
}

void MatFile::read_matio() {
  {
    const std::string bytes = read_whole_file(path_);
    check_mat_structure(std::as_bytes(std::span(bytes)), path_);
  }
  const std::lock_guard lock(matio_mutex);
  matio_message.clear();
  Mat_LogInitFunc("petzval", keep_matio_message);
  const std::unique_ptr<mat_t, CloseMat> file(Mat_Open(path_.c_str(), MAT_ACC_RDONLY));
  for (const std::string& name : names_) {
    if (!file) break;
    Mat_Rewind(file.get());
    if (matvar_t* const variable = Mat_VarRead(file.get(), name.c_str())) variables_[name].reset(variable);
  }
  if (!matio_message.empty())
    throw InputError(path_, fmt::format("is damaged: matio says \"{}\"", matio_message));
}

std::vector<std::string> mat_variable_names(const std::string& path) {
  if (is_mat_hdf5(path)) return {};
  {
    const std::string bytes = read_whole_file(path);
    check_mat_structure(std::as_bytes(std::span(bytes)), path);
  }
  const std::lock_guard lock(matio_mutex);
  const std::unique_ptr<mat_t, CloseMat> file(Mat_Open(path.c_str(), MAT_ACC_RDONLY));
  std::vector<std::string> names;
  std::size_t count = 0;
  if (!file) return names;
  char* const* const list = Mat_GetDir(file.get(), &count);
  for (std::size_t i = 0; list != nullptr && i < count; ++i)
    if (list[i] != nullptr) names.emplace_back(list[i]);
  return names;
}

void MatFile::read_hdf5() {
  const MappedRecords mapped = mat_hdf5_records(path_, names_);
  records_ = mapped.memory;
  for (std::span<std::byte> rest = mapped.records; !rest.empty();) {
    std::unique_ptr<matvar_t, Free> variable(variable_of_records(rest));
    if (!variable) throw InputError(path_, "is damaged: its variables cannot be read");
    std::string name = variable->name;
    variables_[std::move(name)] = std::move(variable);
  }
}

std::optional<MatValue> MatFile::find(const std::string& variable) const {
  const auto found = variables_.find(variable);
  if (found == variables_.end() || is_nothing(*found->second)) return std::nullopt;
  return MatValue(found->second.get(), variable, path_);
}

MatValue MatFile::at(const std::string& variable) const {
  if (const std::optional<MatValue> value = find(variable)) return *value;
  throw InputError(path_, fmt::format("has no variable '{}'", variable));
}

MatValue MatFile::first() const {
  for (const std::string& name : names_)
    if (const std::optional<MatValue> value = find(name)) return *value;
  throw InputError(path_, fmt::format("has no variable '{}'", fmt::join(names_, "' or '")));
}

}  // namespace petzval
