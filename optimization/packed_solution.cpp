#include "optimization/packed_solution.hpp"

#include <optional>
#include <utility>

#include "optimization/packed_result.hpp"

namespace pleuel {

template <class Archive>
void transfer(Archive& archive, Refinement& refinement) {
  auto& [step, elements, more_modes, newton] = refinement;
  archive(step, elements, more_modes, newton);
}

template <class Archive>
void transfer(Archive& archive, TriedSetting& tried) {
  auto& [setting, step, elements, error, response, work] = tried;
  archive(setting, step, elements, error, response, work);
}

template <class Archive>
void transfer(Archive& archive, Stage& stage) {
  auto& [target, setting, is_met, settings_tried, evaluations, choice_seconds, seconds] = stage;
  archive(target, setting, is_met, settings_tried, evaluations, choice_seconds, seconds);
}

template <class Archive>
void transfer(Archive& archive, BeamEstimates& estimates) {
  auto& [elasticity, axial, torsional, stiffening, rotary] = estimates;
  archive(elasticity, axial, torsional, stiffening, rotary);
}

template <class Archive>
void transfer(Archive& archive, MeasuredEffect& effect) {
  auto& [is_needed, change, response] = effect;
  archive(is_needed, change, response);
}

template <class Archive>
void transfer(Archive& archive, EffectDecisions& decisions) {
  auto& [estimates, measured] = decisions;
  archive(estimates, measured);
}

template <class Archive>
void transfer(Archive& archive, EffectSettings& effects) {
  auto& [spatial, stiffening, rotary, elasticity, axial, torsional, tolerance, decisions] = effects;
  archive(spatial, stiffening, rotary, elasticity, axial, torsional, tolerance, decisions);
}

template <class Archive>
void transfer(Archive& archive, GradientChoice& choice) {
  auto& [method, reason] = choice;
  archive(method, reason);
}

std::string pack_solution(const StagedSolution& solution) {
  const DesignProblem& problem = *solution.problem;
  return packed(solution.result, solution.stages, problem.file().effects, problem.method());
}

StagedSolution unpack_solution(const std::string& bytes, const ProblemFile& file, int threads) {
  StagedSolution solution;
  ProblemFile solved = file;
  std::optional<GradientChoice> method;
  unpack(bytes, solution.result, solution.stages, solved.effects, method);
  if (!solution.stages.empty()) {
    solved = refined(std::move(solved), solution.stages.back().setting.setting);
  }
  solution.problem = std::make_unique<DesignProblem>(std::move(solved), threads);
  if (method) solution.problem->decide_method(*method);
  return solution;
}

}  // namespace pleuel
