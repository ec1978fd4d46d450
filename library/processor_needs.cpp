#include "library/processor_needs.hpp"

namespace pleuel {

constinit const ProcessorNeeds processor_needs = {
#ifdef __SSE4_2__
    .sse42 = true,
#endif
#ifdef __AVX__
    .avx = true,
#endif
#ifdef __AVX2__
    .avx2 = true,
#endif
#ifdef __FMA__
    .fma = true,
#endif
#ifdef __BMI__
    .bmi = true,
#endif
#ifdef __BMI2__
    .bmi2 = true,
#endif
#ifdef __AVX512F__
    .avx512 = true,
#endif
};

}  // namespace pleuel
