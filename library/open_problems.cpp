#include "library/open_problems.hpp"

#include <mutex>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "library/call_error.hpp"

namespace pleuel {

namespace {

struct Table {
  std::mutex mutex;
  pleuel_problem last = 0;
  std::unordered_map<pleuel_problem, std::shared_ptr<OpenProblem>> problems;
};

/// Never destroyed: threads of the caller may outlive what the program ends with.
Table& table() {
  static Table& one = *new Table;
  return one;
}

[[noreturn]] void refuse(pleuel_problem number) {
  throw CallError(fmt::format(
      "the problem {} is not open: it was closed, or never came from pleuel_open", number));
}

}  // namespace

pleuel_problem add_open_problem(std::shared_ptr<OpenProblem> problem) {
  const std::lock_guard lock(table().mutex);
  const pleuel_problem number = ++table().last;
  table().problems.emplace(number, std::move(problem));
  return number;
}

std::shared_ptr<OpenProblem> find_open_problem(pleuel_problem number) {
  const std::lock_guard lock(table().mutex);
  const auto found = table().problems.find(number);
  if (found == table().problems.end()) refuse(number);
  return found->second;
}

void remove_open_problem(pleuel_problem number) {
  std::shared_ptr<OpenProblem> removed;  // its memory is given back after the lock
  const std::lock_guard lock(table().mutex);
  const auto found = table().problems.find(number);
  if (found == table().problems.end()) refuse(number);
  removed = std::move(found->second);
  table().problems.erase(found);
}

}  // namespace pleuel
