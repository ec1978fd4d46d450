#include "core/base/machine_memory.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <limits>

#include <sys/mman.h>
#include <unistd.h>

namespace pleuel {

namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();

/// Of a file that holds a number, or a word where there is no limit.
double limit_in(const char* file) {
  std::ifstream in(file);
  double limit = 0.0;
  return in >> limit && limit > 0.0 ? limit : unknown;
}

double physical_memory() {
  const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGE_SIZE);
  return pages > 0 && size > 0 ? static_cast<double>(pages) * static_cast<double>(size) : unknown;
}

}  // namespace

double machine_memory() {
  return std::min({physical_memory(), limit_in("/sys/fs/cgroup/memory.max"),
                   limit_in("/sys/fs/cgroup/memory/memory.limit_in_bytes")});
}

double default_memory() {
  constexpr double most = 4e9, share = 0.25;
  return std::min(most, share * machine_memory());
}

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
