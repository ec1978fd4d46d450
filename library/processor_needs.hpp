#pragma once

namespace pleuel {

/// Instructions that the compiler was allowed to use.
struct ProcessorNeeds {
  bool sse42, avx, avx2, fma, bmi, bmi2, avx512;
};

/// Of the whole program but the check itself; a constant, which takes no instruction to make.
extern const ProcessorNeeds processor_needs;

}  // namespace pleuel
