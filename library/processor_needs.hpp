#pragma once

namespace pleuel {

/// Instructions that the compiler was allowed to use.
struct ProcessorNeeds {
  bool sse42 = false, avx = false, avx2 = false, fma = false, bmi = false, bmi2 = false;
  bool avx512 = false;
};

/// Of the whole program but the check itself; a constant, which takes no instruction to make.
extern const ProcessorNeeds processor_needs;

}  // namespace pleuel
