#include "tests/core/counted_allocations.hpp"

#include <atomic>
#include <cstdlib>

#ifdef PLEUEL_COUNTS_ALLOCATIONS
namespace {
std::atomic<long> counted{0}, bytes{0};

void note(std::size_t size) {
  ++counted;
  bytes += static_cast<long>(size);
}
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);  // NOLINT: names of the C library
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* pointer, std::size_t size);

void* malloc(std::size_t size) {
  note(size);
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  note(count * size);
  return __libc_calloc(count, size);
}
void* realloc(void* pointer, std::size_t size) {
  note(size);
  return __libc_realloc(pointer, size);
}
}

long pleuel::test::allocations() {
  return counted;
}

long pleuel::test::allocated_bytes() {
  return bytes;
}
#endif
