#pragma once

#include <functional>

namespace pleuel {

/// Number of threads for work that can be divided: the processors that this process may use, or the
/// limit if that is less.
int available_threads();

/// From now on this process shall divide its work into at most so many threads.
/// @param most  at least 1
void limit_threads(int most);

/// Calls work(i) for i = 0 … count − 1 on several threads, in no particular order. If calls throw,
/// the rest is left out and what the call with the smallest i threw is thrown again. For short work
/// on what is in memory, such as the simulations that one evaluation asks for; whole searches and
/// samples are tasks (tasks.hpp).
/// @param threads  at least 1; one runs everything here, in order
void for_each_in_parallel(int count, int threads, const std::function<void(int)>& work);

}  // namespace pleuel
