#pragma once

#include <cstddef>  // says whether the C library is that of GNU

#if defined(__SANITIZE_ADDRESS__)
#define PLEUEL_BRINGS_ALLOCATOR
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define PLEUEL_BRINGS_ALLOCATOR
#endif
#endif

/// Defined where the allocator of the C library can be counted: it stands behind operator new, Eigen and
/// KLU alike. Sanitizers bring their own.
#if defined(__GLIBC__) && !defined(PLEUEL_BRINGS_ALLOCATOR)
#define PLEUEL_COUNTS_ALLOCATIONS

namespace pleuel::test {

/// Blocks that this program has asked for so far. A program that links this counts all of its own.
long allocations();
/// Bytes of them, whether they were given back or not.
long allocated_bytes();

}  // namespace pleuel::test
#endif
