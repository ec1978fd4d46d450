#pragma once

#include <cstddef>

#include "core/system/system.hpp"

namespace pleuel {

/// Calls visit(k, row, column) for all entries of a pattern; k counts its values.
template <class Visit>
void for_each_entry(const System::Matrix& matrix, Visit visit) {
  for (int col = 0; col < matrix.cols(); ++col) {
    for (int k = matrix.outerIndexPtr()[col]; k < matrix.outerIndexPtr()[col + 1]; ++k) {
      visit(k, matrix.innerIndexPtr()[k], col);
    }
  }
}

}  // namespace pleuel
