#pragma once

#include <cstddef>

namespace pleuel {

/// What this machine, or the container that we are in, has of memory [byte]; infinite if nobody
/// knows.
double machine_memory();

/// What the states of a trajectory may take where nobody says otherwise: 4 GB, or a quarter of what
/// there is if that is less [byte].
double default_memory();

/// Asks for huge pages under a large array that is about to be filled for the first time, where the
/// system has them: to enter megabytes page by page is slow, above all on virtual machines. Nothing
/// else changes, and smaller arrays than a huge page are left alone.
void prefer_huge_pages(const double* values, std::ptrdiff_t count);

}  // namespace pleuel
