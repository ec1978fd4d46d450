#include "library/processor_needs.hpp"

namespace pleuel {

namespace {

#ifdef __SSE4_2__
constexpr bool sse42 = true;
#else
constexpr bool sse42 = false;
#endif
#ifdef __AVX__
constexpr bool avx = true;
#else
constexpr bool avx = false;
#endif
#ifdef __AVX2__
constexpr bool avx2 = true;
#else
constexpr bool avx2 = false;
#endif
#ifdef __FMA__
constexpr bool fma = true;
#else
constexpr bool fma = false;
#endif
#ifdef __BMI__
constexpr bool bmi = true;
#else
constexpr bool bmi = false;
#endif
#ifdef __BMI2__
constexpr bool bmi2 = true;
#else
constexpr bool bmi2 = false;
#endif
#ifdef __AVX512F__
constexpr bool avx512 = true;
#else
constexpr bool avx512 = false;
#endif

}  // namespace

constinit const ProcessorNeeds processor_needs = {sse42, avx, avx2, fma, bmi, bmi2, avx512};

}  // namespace pleuel
