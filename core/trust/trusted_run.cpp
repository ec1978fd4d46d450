#include "core/trust/trusted_run.hpp"

#include <algorithm>
#include <set>

#include "core/scene/response_parts.hpp"

namespace pleuel {

namespace {

bool is_asked(const ProblemFile& problem, const std::string& name) {
  const std::vector<std::string>& listed = problem.accuracy.responses;
  return (problem.objective && problem.objective->response == name) ||
         std::ranges::find(listed, name) != listed.end() ||
         std::ranges::any_of(problem.constraints, [&](const ConstraintSettings& limit) {
           return limit.response == name;
         });
}

}  // namespace

std::vector<std::size_t> asked_responses(const ProblemFile& problem) {
  std::vector<std::size_t> asked, all;
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    all.push_back(i);
    if (is_asked(problem, problem.responses[i].name)) asked.push_back(i);
  }
  return asked.empty() ? all : asked;
}

std::vector<std::size_t> asked_parts(const ProblemFile& problem) {
  std::set<std::size_t> all;
  for (const std::size_t response : asked_responses(problem)) {
    for (const std::size_t part : parts_of(problem, response)) all.insert(part);
  }
  return {all.begin(), all.end()};
}

}  // namespace pleuel
