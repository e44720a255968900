// SPDX-License-Identifier: BSD-3-Clause
// Vectors whose new elements hold anything.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace petzval {

/// An allocator that leaves numbers as they are when they get no value: what is written over at once, by
/// several threads perhaps, need not be zeroed by one before.
template <typename T, typename Base = std::allocator<T>>
struct UnsetAllocator : Base {
  static_assert(std::is_arithmetic_v<T>);
  template <typename U>
  struct rebind {
    using other = UnsetAllocator<U, typename std::allocator_traits<Base>::template rebind_alloc<U>>;
  };
  using Base::Base;
  template <typename U>
  void construct(U* place) noexcept {
    ::new (static_cast<void*>(place)) U;
  }
  template <typename U, typename... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
};

/// std::vector, but `UnsetVector<float> v(n)` and resize() leave new elements unset.
template <typename T, typename Base = std::allocator<T>>
using UnsetVector = std::vector<T, UnsetAllocator<T, Base>>;

}  // namespace petzval
