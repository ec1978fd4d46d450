#include "library/open_problems.hpp"

#include <utility>

#include "library/handle_table.hpp"

namespace pleuel {

namespace {

/// Never destroyed: threads of the caller may outlive what the program ends with.
HandleTable<OpenProblem>& table() {
  static auto& one = *new HandleTable<OpenProblem>(
      "the problem {} is not open: it was closed, or never came from pleuel_open");
  return one;
}

}  // namespace

pleuel_problem add_open_problem(std::shared_ptr<OpenProblem> problem) {
  return table().add(std::move(problem));
}

std::shared_ptr<OpenProblem> find_open_problem(pleuel_problem number) {
  return table().find(number);
}

void remove_open_problem(pleuel_problem number) {
  table().remove(number);
}

}  // namespace pleuel
