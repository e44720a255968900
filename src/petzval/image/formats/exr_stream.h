// SPDX-License-Identifier: BSD-3-Clause
// What the writers of OpenEXR files write to.
#pragma once

#include <petzval/image/formats/output_file.h>

#include <ImfIO.h>
#include <exception>

namespace petzval {

/// OpenEXR's own file stream loses the errors of its last bytes; this one loses none.
class ExrStream : public Imf::OStream {
 public:
  explicit ExrStream(OutputFile& file) : Imf::OStream(file.path().c_str()), file_(file) {}
  void write(const char bytes[], int count) override {
    guarded([&] { file_.write(bytes, static_cast<std::size_t>(count)); });
  }
  uint64_t tellp() override { return file_.position(); }
  void seekp(uint64_t position) override {
    guarded([&] { file_.seek(position); });
  }
  /// Throws what a write threw, even one from OpenEXR's destructor, which swallows exceptions.
  void rethrow() const {
    if (reason_) std::rethrow_exception(reason_);
  }

 private:
  template <class Work>
  void guarded(const Work& work) {
    try {
      work();
    } catch (...) {
      if (!reason_) reason_ = std::current_exception();
      throw;
    }
  }

  OutputFile& file_;
  std::exception_ptr reason_;
};

}  // namespace petzval
