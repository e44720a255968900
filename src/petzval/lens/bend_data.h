// SPDX-License-Identifier: BSD-3-Clause
// A grating or an ideal lens made ready for rays of one wavelength.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace petzval {

struct Lens;

template <class T>
struct BendData {
  enum class Kind : std::uint8_t { grating, ideal_lens };
  Kind kind = Kind::grating;
  bool mirror = false;
  T index_before = 1, index_after = 1;  ///< in the sense of travel
  /// Of a grating: what it adds to index × direction, order × wavelength × lines per length.
  T along_x = 0, along_y = 0;
  /// Of an ideal lens, per mm: its power, and index/distance of the object in front of it and of the image
  /// behind it.
  T power = 0, vergence_before = 0, vergence_after = 0;

  /// For light that comes the other way.
  BendData turned_back() const {
    BendData back = *this;
    back.index_before = index_after, back.index_after = index_before;
    back.vergence_before = vergence_after, back.vergence_after = vergence_before;
    return back;
  }
};

/// What surface `i` of a lens bends; null where it only refracts. \param index_before, index_after  on its
/// two sides at the wavelength.
std::shared_ptr<const BendData<double>> bend_data(const Lens& lens, std::size_t i, double wavelength_nm,
                                                  double index_before, double index_after);

}  // namespace petzval
