#pragma once

#include <algorithm>
#include <cassert>

#include "core/system/system.hpp"

namespace pleuel {

/// Which of the values of a matrix stands at a place of its pattern. @pre there is one
inline int slot_of(const System::Matrix& pattern, int row, int col) {
  const int* begin = pattern.innerIndexPtr() + pattern.outerIndexPtr()[col];
  const int* end = pattern.innerIndexPtr() + pattern.outerIndexPtr()[col + 1];
  const int* found = std::lower_bound(begin, end, row);
  assert(found != end && *found == row);
  return static_cast<int>(found - pattern.innerIndexPtr());
}

}  // namespace pleuel
