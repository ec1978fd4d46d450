#include "optimization/design/staged_solve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/base/stopwatch.hpp"
#include "core/response/effect_measurement.hpp"
#include "core/scene/load_cases.hpp"
#include "optimization/design/made_search.hpp"

namespace pleuel {

namespace {

/// The first stage has so many times the target, but no more than this.
constexpr double coarse_factor = 10.0, coarsest_target = 1e-2;
/// How often the setting is chosen at an optimum.
constexpr int most_rounds = 3;
/// Of the target: the tolerance of a search that is not the last.
constexpr double search_share = 0.1;

bool is_same(const Refinement& one, const Refinement& other) {
  return one.elements == other.elements && std::abs(std::log(one.step / other.step)) < 0.1;
}

/// (case, body, effect) of what is left out by measurement.
std::vector<std::array<std::string, 3>> left_out(const ProblemFile& file) {
  std::vector<std::array<std::string, 3>> names;
  for (const ProblemFile* one : simulated_problems(file)) {
    for (const auto& [name, effect] : one->effects.decisions.measured) {
      if (!effect.is_needed) names.push_back({one->load_case, name.first, name.second});
    }
  }
  return names;
}

std::vector<Refinement> coarse_settings(const ProblemFile& file) {
  std::vector<Refinement> settings;
  for (const ProblemFile* one : simulated_problems(file)) settings.push_back(coarse_setting(*one));
  return settings;
}

std::vector<Refinement> settings_of(const Stage& stage) {
  std::vector<Refinement> settings;
  for (const TriedSetting& one : stage.settings) settings.push_back(one.setting);
  return settings;
}

std::string choice_text(double target, const TriedSetting& chosen, bool is_met,
                        const ProblemFile& problem) {
  return fmt::format(
      "for {:.3g} % a step of {:.3g} ms{}{}{}", 100.0 * target, 1e3 * chosen.step,
      chosen.elements > 0 ? fmt::format(" and {} elements", chosen.elements) : "",
      problem.load_case.empty() ? "" : fmt::format(" in the case \"{}\"", problem.load_case),
      is_met ? "" : ", the finest that were tried, which do not do");
}

class StagedSolve {
 public:
  StagedSolve(const ProblemFile& file, const SearchSetup& setup) : file_(file), setup_(setup) {}

  StagedSolution run(Eigen::VectorXd x) {
    if (file_.accuracy.chooses_setting) {
      run_for_accuracy(x);
    } else {
      run_as_it_is(x);
    }
    return std::move(solution_);
  }

 private:
  void run_for_accuracy(Eigen::VectorXd& x) {
    const double target = file_.accuracy.target;
    const double first_target = std::min(coarse_factor * target, std::max(coarsest_target, target));
    std::vector<Refinement> from = coarse_settings(file_);
    choose_stage(x, first_target, from);
    if (!search_from(x)) return;
    for (int round = 0; round < most_rounds; ++round) {
      from = settings_of(solution_.stages.back());
      if (!choose_stage(x, target, from) && round > 0) return;
      solve_stage();
      if (solution_.result.status != Status::unresolved) return;
      x = solution_.result.x;
      if (file_.effects.tolerance > 0.0) decide_effects(file_, x);
    }
  }

  void run_as_it_is(const Eigen::VectorXd& x) {
    begin_stage({}, file_, x);
    solve_stage();
    for (int round = 1; round < most_rounds && take_effects_back(); ++round) solve_stage();
  }

  /// @returns whether effects that were left out matter at the design that was found, where the
  /// next stage begins with them
  bool take_effects_back() {
    if (solution_.result.status != Status::unresolved) return false;
    ProblemFile next = solution_.problem->file();
    if (next.effects.tolerance <= 0.0) return false;
    decide_effects(next, solution_.result.x);
    if (left_out(next) == left_out(solution_.problem->file())) return false;
    notify(setup_.notice,
           "effects that were left out at the start matter here, and are taken back");
    begin_stage({}, std::move(next), solution_.result.x);
    return true;
  }

  /// @returns whether the stage differs from the one before; one that does not is not begun if that
  /// has solved already
  bool choose_stage(const Eigen::VectorXd& x, double target, const std::vector<Refinement>& from) {
    const Stopwatch watch;
    Stage stage;
    stage.target = target;
    stage.is_met = true;
    std::vector<std::string> notices;
    ProblemFile chosen = file_;
    bool is_new = !solution_.problem;
    const std::vector<ProblemFile*> problems = simulated_problems(chosen);
    for (std::size_t c = 0; c < problems.size(); ++c) {
      // In a short stage leaving effects out saves less than finding them costs.
      SettingChoice choice =
          solution_.problem
              ? choose_setting_and_effects(*problems[c], x, target, from[c], JudgedBy::coarser_runs)
              : choose_setting(*problems[c], x, target, from[c], JudgedBy::coarser_runs);
      is_new = is_new || !is_same(choice.chosen.setting, from[c]);
      stage.settings.push_back(choice.chosen);
      stage.is_met = stage.is_met && choice.is_met;
      stage.settings_tried += int_size(choice.tried);
      *problems[c] = std::move(choice.problem);
      notices.push_back(choice_text(target, stage.settings.back(), choice.is_met, *problems[c]));
    }
    is_new = is_new || left_out(chosen) != left_out(solution_.problem->file());
    if (!is_new && solution_.result.evaluation.has_gradients()) return false;
    stage.choice_seconds = watch.seconds();
    for (const std::string& text : notices) notify(setup_.notice, text);
    begin_stage(std::move(stage), std::move(chosen), x);
    return is_new;
  }

  void begin_stage(Stage stage, ProblemFile file, const Eigen::VectorXd& x) {
    solution_.result.seconds += stage.choice_seconds;  // what follows comes after it
    solution_.stages.push_back(std::move(stage));
    solution_.problem = setup_.problem_at(std::move(file), x);
  }

  /// @returns whether the start could be evaluated; x becomes the best design that was seen
  bool search_from(Eigen::VectorXd& x) {
    SolveOptions coarse = setup_.options;
    coarse.tolerance =
        std::max(setup_.options.tolerance, search_share * solution_.stages.back().target);
    bool can_go_on = false;
    add([&](const Observer& observer) {
      Result result = search_with_setting(*solution_.problem, coarse, observer);
      can_go_on = has_moved(result);
      if (can_go_on) x = result.x;
      return result;
    });
    return can_go_on;
  }

  void solve_stage() {
    SolveOptions rest = setup_.options;
    rest.max_iterations = std::max(1, setup_.options.max_iterations - solution_.result.iterations);
    rest.earlier = {solution_.result.iterations, solution_.result.restarts};
    add([&](const Observer& observer) {
      return solve_design(*solution_.problem, rest, observer, setup_.notice);
    });
  }

  void add(const ObservedRun& run) {
    Stage& stage = solution_.stages.back();
    const bool is_first = solution_.result.history.empty();
    Result result = run_after(solution_.result, setup_.observer, [&](const Observer& observer) {
      Result own = run(observer);
      stage.evaluations = own.evaluations;
      stage.seconds = own.seconds;
      return own;
    });
    if (!is_first) ++result.restarts;
    solution_.result = std::move(result);
  }

  ProblemFile file_;  ///< with the effects that are decided so far
  const SearchSetup& setup_;
  StagedSolution solution_;
};

}  // namespace

StagedSolution solve_in_stages(const ProblemFile& file, const Eigen::VectorXd& start,
                               const SearchSetup& setup) {
  return has_made_bodies(file) ? solve_with_made_bodies(file, start, setup)
                               : solve_stages(file, start, setup);
}

StagedSolution solve_stages(const ProblemFile& file, const Eigen::VectorXd& start,
                            const SearchSetup& setup) {
  return StagedSolve(file, setup).run(start);
}

}  // namespace pleuel
