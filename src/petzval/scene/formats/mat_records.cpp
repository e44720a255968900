// SPDX-License-Identifier: BSD-3-Clause
#include <matio.h>
#include <petzval/base/error.h>
#include <petzval/scene/formats/mat_records.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace petzval {

namespace {

using RecordBytes = std::span<std::byte>;

constexpr std::size_t word_bytes = 8;
constexpr std::size_t most_in_name = 1000, most_dimensions = 32;
constexpr int max_record_depth = 64;

std::size_t padding(std::size_t bytes) {
  return (word_bytes - bytes % word_bytes) % word_bytes;
}

struct Unsound {};

/// Takes what a record is made of from the front of `rest`.
class Taker {
 public:
  explicit Taker(RecordBytes rest) : rest_(rest) {}
  RecordBytes rest() const { return rest_; }

  RecordBytes take(std::size_t bytes) {
    if (rest_.size() < bytes || rest_.size() - bytes < padding(bytes)) throw Unsound();
    const RecordBytes taken = rest_.first(bytes);
    rest_ = rest_.subspan(bytes + padding(bytes));
    return taken;
  }
  std::uint64_t word() {
    std::uint64_t value = 0;
    std::memcpy(&value, take(word_bytes).data(), word_bytes);
    return value;
  }
  std::string text(std::size_t bytes) {
    const RecordBytes taken = take(bytes);
    return {reinterpret_cast<const char*>(taken.data()), taken.size()};
  }

 private:
  RecordBytes rest_;
};

MatRecord take_head(Taker& from) {
  MatRecord record;
  record.kind = static_cast<MatRecordKind>(from.word());
  const std::uint64_t name = from.word();
  record.class_type = from.word();
  record.data_type = from.word();
  const std::uint64_t rank = from.word();
  record.bytes = from.word();
  record.fields = from.word();
  if (name > most_in_name || rank > most_dimensions) throw Unsound();
  record.name = from.text(name);
  for (std::uint64_t i = 0; i < rank; ++i) record.dimensions.push_back(from.word());
  return record;
}

matvar_t* empty_of(const std::string& name) {
  std::size_t none[] = {0, 0};
  return Mat_VarCreate(name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, 2, none, nullptr, 0);
}

/// Stands for what is not read: there, but neither numbers nor text nor struct.
matvar_t* other_of(const std::string& name) {
  std::size_t one[] = {1, 1};
  return Mat_VarCreate(name.c_str(), MAT_C_CELL, MAT_T_CELL, 2, one, nullptr, 0);
}

matvar_t* array_of(const MatRecord& record, Taker& from) {
  const RecordBytes data = from.take(record.bytes);
  std::vector<std::size_t> sides(record.dimensions.begin(), record.dimensions.end());
  matvar_t* const made =
      Mat_VarCreate(record.name.c_str(), static_cast<matio_classes>(record.class_type),
                    static_cast<matio_types>(record.data_type), static_cast<int>(sides.size()), sides.data(),
                    data.data(), MAT_F_DONT_COPY_DATA);
  if (made != nullptr && made->nbytes != data.size()) {
    Mat_VarFree(made);
    throw Unsound();
  }
  return made;
}

matvar_t* take_variable(Taker& from, int depth);

matvar_t* struct_of(const MatRecord& record, Taker& from, int depth) {
  std::size_t one[] = {1, 1};
  matvar_t* const made = Mat_VarCreateStruct(record.name.c_str(), 2, one, nullptr, 0);
  try {
    for (std::uint64_t i = 0; made != nullptr && i < record.fields; ++i) {
      matvar_t* const field = take_variable(from, depth + 1);
      if (Mat_VarAddStructField(made, field->name) != 0) {
        Mat_VarFree(field);
        throw Unsound();
      }
      Mat_VarSetStructFieldByIndex(made, i, 0, field);
    }
  } catch (...) {
    Mat_VarFree(made);
    throw;
  }
  return made;
}

matvar_t* take_variable(Taker& from, int depth) {
  if (depth > max_record_depth) throw Unsound();
  const MatRecord record = take_head(from);
  matvar_t* made = nullptr;
  if (record.kind == MatRecordKind::numbers || record.kind == MatRecordKind::text)
    made = array_of(record, from);
  if (record.kind == MatRecordKind::structure) made = struct_of(record, from, depth);
  if (record.kind == MatRecordKind::nothing) made = empty_of(record.name);
  if (record.kind == MatRecordKind::other) made = other_of(record.name);
  if (made == nullptr) throw Unsound();
  return made;
}

}  // namespace

void MatRecordWriter::begin(const MatRecord& record) {
  const std::uint64_t head[] = {static_cast<std::uint64_t>(record.kind),
                                record.name.size(),
                                record.class_type,
                                record.data_type,
                                record.dimensions.size(),
                                record.bytes,
                                record.fields};
  data(std::as_bytes(std::span(head)));
  data(std::as_bytes(std::span(record.name)));
  end();
  data(std::as_bytes(std::span(record.dimensions)));
}

void MatRecordWriter::data(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t went = write(descriptor_, bytes.data(), bytes.size());
    if (went < 0 && errno == EINTR) continue;
    if (went <= 0)
      throw Failure("there is no room for the variables of a MATLAB file in $TMPDIR or /var/tmp");
    written_ += static_cast<std::size_t>(went);
    bytes = bytes.subspan(static_cast<std::size_t>(went));
  }
}

void MatRecordWriter::end() {
  constexpr std::byte zeros[word_bytes] = {};
  data(std::span(zeros).first(padding(written_)));
}

matvar_t* variable_of_records(std::span<std::byte>& rest) try {
  Taker from(rest);
  matvar_t* const made = take_variable(from, 0);
  rest = from.rest();
  return made;
} catch (const Unsound&) {
  return nullptr;
}

}  // namespace petzval
