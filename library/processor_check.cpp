// Compiled for any processor (see CMakeLists.txt), and run before anything else of the program.

#include <cstring>

#include <unistd.h>

#include "library/processor_needs.hpp"

#if defined(__x86_64__) && defined(__GNUC__)

namespace {

[[noreturn]] void refuse(const char* feature) {
  const char* parts[] = {"pleuel: this program was built for another processor: this one lacks ",
                         feature,
                         ". Build it here: remove the folder build and call ./pleuel again, or "
                         "configure with -DPLEUEL_NATIVE=OFF\n"};
  for (const char* part : parts) {
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, part, std::strlen(part));
  }
  _exit(1);
}

/// Before all objects with constructors, whose code may hold the instructions that are missing.
__attribute__((constructor(101))) void check_processor() {
  __builtin_cpu_init();
  const pleuel::ProcessorNeeds& needs = pleuel::processor_needs;
  if (needs.sse42 && !__builtin_cpu_supports("sse4.2")) refuse("SSE4.2");
  if (needs.avx && !__builtin_cpu_supports("avx")) refuse("AVX");
  if (needs.avx2 && !__builtin_cpu_supports("avx2")) refuse("AVX2");
  if (needs.fma && !__builtin_cpu_supports("fma")) refuse("FMA");
  if (needs.bmi && !__builtin_cpu_supports("bmi")) refuse("BMI");
  if (needs.bmi2 && !__builtin_cpu_supports("bmi2")) refuse("BMI2");
  if (needs.avx512 && !__builtin_cpu_supports("avx512f")) refuse("AVX-512");
}

}  // namespace

#endif
