#pragma once

#include <cstddef>

namespace pleuel {

/// Asks for huge pages under a large array that is about to be filled for the first time, where the
/// system has them: to enter megabytes page by page is slow, above all on virtual machines. Nothing
/// else changes, and smaller arrays than a huge page are left alone.
void prefer_huge_pages(const double* values, std::ptrdiff_t count);

}  // namespace pleuel
