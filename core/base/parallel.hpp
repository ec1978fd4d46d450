#pragma once

#include <functional>

namespace pleuel {

/// Number of threads for work that can be divided: those of the machine.
int available_threads();

/// Calls work(i) for i = 0 … count − 1 on several threads, in no particular order. If calls throw,
/// the rest is left out and what the call with the smallest i threw is thrown again.
/// @param threads  at least 1; one runs everything here, in order
void for_each_in_parallel(int count, int threads, const std::function<void(int)>& work);

}  // namespace pleuel
