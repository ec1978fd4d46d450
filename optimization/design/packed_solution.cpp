#include "optimization/design/packed_solution.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "core/base/packed.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/packed_problem.hpp"
#include "optimization/result.hpp"

namespace pleuel {

std::string pack_solution(const StagedSolution& solution) {
  const DesignProblem& problem = *solution.problem;
  std::vector<EffectSettings> effects;
  std::vector<std::optional<GradientChoice>> methods;
  for (std::size_t c = 0; c < problem.case_count(); ++c) {
    effects.push_back(problem.load_case(c).file().effects);
    methods.push_back(problem.load_case(c).method());
  }
  return packed(solution.result, solution.stages, effects, methods);
}

StagedSolution unpack_solution(const std::string& bytes, const ProblemFile& file, int threads) {
  StagedSolution solution;
  ProblemFile solved = file;
  std::vector<EffectSettings> effects;
  std::vector<std::optional<GradientChoice>> methods;
  unpack(bytes, solution.result, solution.stages, effects, methods);
  const std::vector<ProblemFile*> problems = simulated_problems(solved);
  for (std::size_t c = 0; c < problems.size(); ++c) {
    problems[c]->effects = std::move(effects[c]);
    const bool is_chosen = !solution.stages.empty() && !solution.stages.back().settings.empty();
    if (!is_chosen) continue;
    *problems[c] = refined(std::move(*problems[c]), solution.stages.back().settings[c].setting);
  }
  solution.problem = std::make_unique<DesignProblem>(std::move(solved), threads);
  for (std::size_t c = 0; c < methods.size(); ++c) {
    if (methods[c]) solution.problem->load_case(c).decide_method(*methods[c]);
  }
  return solution;
}

}  // namespace pleuel
