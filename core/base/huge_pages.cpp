#include "core/base/huge_pages.hpp"

#include <cstdint>

#include <sys/mman.h>

namespace pleuel {

void prefer_huge_pages(const double* values, std::ptrdiff_t count) {
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t page = std::uintptr_t{1} << 21;
  const auto begin = reinterpret_cast<std::uintptr_t>(values);
  const std::uintptr_t first = (begin + page - 1) / page * page;
  const std::uintptr_t end = (begin + sizeof(double) * count) / page * page;
  if (first >= end) return;
  // It is a wish: whether it was heard makes no difference to anything but the time.
  static_cast<void>(madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE));
#else
  static_cast<void>(values);
  static_cast<void>(count);
#endif
}

}  // namespace pleuel
