// SPDX-License-Identifier: BSD-3-Clause
// Damaged copies of a sound file, one after the other, given to a reader.
#pragma once

#include <gtest/gtest.h>
#include <petzval/base/error.h>

#include <algorithm>
#include <functional>
#include <string>

#include "scratch.h"

namespace petzval::test {

using Read = std::function<void(const std::string& path)>;

/// True if the reader took it; an Error is the other right answer, anything else a failed test.
inline bool taken(const Read& read, const std::string& path, const std::string& what) {
  try {
    read(path);
    return true;
  } catch (const Error&) {
    return false;
  } catch (const std::exception& error) {
    ADD_FAILURE() << what << ": " << error.what();
    return false;
  }
}

/// Every shorter file must be refused.
inline void refuses_truncations(const Scratch& scratch, const std::string& bytes, const Read& read) {
  const std::size_t step = std::max<std::size_t>(1, bytes.size() / 400);
  for (std::size_t length = 0; length < bytes.size(); length += step)
    EXPECT_FALSE(
        taken(read, scratch.with("short", bytes.substr(0, length)), "length " + std::to_string(length)))
        << "took the first " << length << " of " << bytes.size() << " bytes";
}

/// Any flipped bit may pass (in a pixel) or be refused, but must do no harm. Bits are spread over the whole
/// file, every one of the first `thorough` bytes. \param flips  about so many of them.
inline void survives_flips(const Scratch& scratch, const std::string& bytes, std::size_t thorough,
                           const Read& read, std::size_t flips = 1500) {
  const std::size_t step = std::max<std::size_t>(1, 8 * bytes.size() / flips) | 1;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); bit += bit < 8 * thorough ? 1 : step) {
    std::string damaged = bytes;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    taken(read, scratch.with("flipped", damaged), "bit " + std::to_string(bit));
  }
}

}  // namespace petzval::test
