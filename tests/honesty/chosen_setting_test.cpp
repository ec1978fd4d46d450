#include <cstdio>
#include <ctime>
#include <limits>
#include <optional>

#include "core/base/relative_error.hpp"
#include "core/jobs/parallel.hpp"
#include "core/trust/setting_choice.hpp"
#include "core/trust/trusted_run.hpp"
#include "tests/random/random_scene.hpp"
#include "tests/support/test.hpp"

/// Whether the setting that an accuracy chooses is right and cheap: beside a grid of 39 settings whose
/// true errors are known. Prints a table. Work is steps × unknowns, which does not
/// depend on the machine.
namespace pleuel::test::chosen_setting_test {
namespace {

constexpr int scenes = 8;
constexpr unsigned first_seed = 1000;
constexpr double targets[] = {1e-2, 1e-3};  // of which the reference knows the error
/// The grid: times the step and the elements of the file.
constexpr int grid_steps = 13;
constexpr double coarsest_step = 16.0, most_elements = 2.0, least_elements = 0.5;
/// Promised: no target is missed, and so much more work than the best of the grid in the median.
constexpr double median_ratio = 1.5;

double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Simulated {
  double error = std::numeric_limits<double>::infinity(), work = 0.0, seconds = 0.0;
};

/// One choice beside the grid.
struct Outcome {
  std::string scene;
  double target;
  bool is_met;                      ///< as the choice reports
  double error;                     ///< true, of the chosen setting
  double work;                      ///< of one simulation with it
  std::optional<double> best_work;  ///< of the grid, among those within the target
  double choosing;                  ///< processor time over that of one simulation

  double ratio() const { return work / *best_work; }
};

class Judge {
 public:
  explicit Judge(const ProblemFile& problem)
      : problem_(problem),
        x_(start_design(problem)),
        asked_(asked_responses(problem)),
        reference_(make_refined_run(problem, x_, {reference_step, 2.0 * most_elements, 2})) {
    if (reference_.has_failed()) return;
    for (double elements = least_elements; elements <= most_elements; elements *= 2.0) {
      for (int i = 0; i < grid_steps; ++i) {
        grid_.push_back(simulate(refined(problem_, {step(i), elements}), reference_));
      }
    }
  }

  bool knows() const { return !reference_.has_failed(); }

  Outcome judge(const std::string& scene, double target) const {
    const double start = processor_time();
    const SettingChoice choice =
        choose_setting(problem_, x_, target, coarse_setting(problem_), JudgedBy::this_choice);
    const double choosing = processor_time() - start;
    const bool is_within_grid = choice.chosen.setting.step >= finer * reference_step;
    const RefinedRun own =
        is_within_grid ? RefinedRun() : make_refined_run(choice.problem, x_, {1.0 / finer, 2.0, 2});
    const Simulated chosen = simulate(choice.problem, is_within_grid ? reference_ : own);
    Outcome outcome{scene,
                    target,
                    choice.is_met,
                    chosen.error,
                    chosen.work,
                    std::nullopt,
                    choosing / std::max(chosen.seconds, 1e-9)};
    for (const Simulated& one : grid_) {
      if (one.error > target) continue;
      outcome.best_work = std::min(outcome.best_work.value_or(one.work), one.work);
    }
    return outcome;
  }

 private:
  /// A reference has steps so much finer than what it judges: the finest of the grid are a quarter of
  /// those of the file.
  static constexpr double finer = 4.0, reference_step = 0.25 / finer;
  /// By factors of √2, from coarse to fine.
  static double step(int i) { return coarsest_step * std::pow(2.0, -0.5 * i); }

  Simulated simulate(const ProblemFile& divided, const RefinedRun& reference) const {
    Simulated found;
    try {
      const double start = processor_time();
      const auto analysis = analyze(divided, x_);
      found.seconds = processor_time() - start;
      found.work = static_cast<double>(analysis->trajectory.steps()) *
                   analysis->model.mechanism.system->size();
      found.error = 0.0;
      for (const std::size_t i : asked_) {
        found.error =
            std::max(found.error, value_error(analysis->reductions[i].value, reference.values(i),
                                              reference.histories[i].size() > 0
                                                  ? reference.histories[i].cwiseAbs().maxCoeff()
                                                  : 0.0));
      }
    } catch (const std::exception&) {  // too coarse
    }
    return found;
  }

  const ProblemFile& problem_;
  Eigen::VectorXd x_;
  std::vector<std::size_t> asked_;
  RefinedRun reference_;
  std::vector<Simulated> grid_;
};

void print(const Outcome& one) {
  fmt::print("| {} | {:g} % | {} | {:.2g} % | {} | {:.1f} |\n", one.scene, 100.0 * one.target,
             one.is_met ? "met" : "not known", 100.0 * one.error,
             one.best_work ? fmt::format("{:.2f}", one.ratio()) : "none", one.choosing);
  std::fflush(stdout);
}

std::vector<Outcome> outcomes_of(const std::string& name, const ProblemFile& problem) {
  const Judge judge(problem);
  std::vector<Outcome> outcomes;
  if (!judge.knows()) return outcomes;
  for (const double target : targets) {
    outcomes.push_back(judge.judge(name, target));
    print(outcomes.back());
  }
  return outcomes;
}

double quantile(std::vector<double> numbers, double share) {
  if (numbers.empty()) return 0.0;
  std::sort(numbers.begin(), numbers.end());
  return numbers[static_cast<std::size_t>(share * static_cast<double>(numbers.size() - 1))];
}

/// Counts of a target.
void print_row(const std::vector<Outcome>& all, double target) {
  int reachable = 0, met = 0, given_up = 0, missed = 0;
  std::vector<double> ratios, choosing;
  for (const Outcome& one : all) {
    if (one.target != target) continue;
    choosing.push_back(one.choosing);
    if (one.is_met && one.error > one.target) ++missed;
    if (!one.best_work) continue;
    ++reachable;
    one.is_met ? ++met : ++given_up;
    if (one.is_met) ratios.push_back(one.ratio());
  }
  fmt::print("| {:g} % | {} | {} | {} | {} | {:.2f} | {:.2f} | {:.1f} |\n", 100.0 * target,
             reachable, met, given_up, missed, quantile(ratios, 0.5), quantile(ratios, 0.95),
             quantile(choosing, 0.5));
}

TEST(ChosenSetting, KeepsItsTargetAtLittleWork) {
  std::vector<std::vector<Outcome>> each(scenes);
  for_each_in_parallel(scenes, available_threads(), [&](int i) {
    const SimulatedScene scene = simulated_scene(first_seed + static_cast<unsigned>(i));
    if (!scene.analysis) return;
    each[i] =
        outcomes_of(fmt::format("random {}", first_seed + static_cast<unsigned>(i)), scene.problem);
  });
  std::vector<Outcome> all;
  for (const auto& some : each) all.insert(all.end(), some.begin(), some.end());
  fmt::print(
      "\n| target | reachable by the grid | met | given up | missed | work over the best of the "
      "grid, median | 95 % | choosing over one simulation, median |\n");
  std::vector<double> ratios;
  int missed = 0;
  for (const double target : targets) print_row(all, target);
  for (const Outcome& one : all) {
    if (one.is_met && one.best_work) ratios.push_back(one.ratio());
    missed += one.is_met && one.error > one.target ? 1 : 0;
  }
  EXPECT_EQ(missed, 0);
  EXPECT_LE(quantile(ratios, 0.5), median_ratio);
}

}  // namespace
}  // namespace pleuel::test::chosen_setting_test
