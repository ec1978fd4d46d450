#include "tests/random/random_scene.hpp"

#include <functional>
#include <map>
#include <memory>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/relative_error.hpp"
#include "core/jobs/parallel.hpp"
#include "core/response/effect_measurement.hpp"
#include "core/response/monitors.hpp"
#include "core/trust/checks.hpp"
#include "core/trust/refined_runs.hpp"
#include "core/trust/resolution.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

/// Laws that hold for every mechanism, tried on random ones. The seeds are fixed by the build.

/// What a tolerance promises of effects that are left out.

/// What warnings about resolution are worth, over all random mechanisms together.

namespace pleuel::test::random_scene_test {
namespace {

/// Round-off of numbers in a file and of a step: some units in the last place.
constexpr double round_off = 1e-15;
/// What is measured with a few changed files is so much smaller than what others may do at most.
constexpr double of_few_samples = 10.0;
constexpr int samples = 4;

class RandomScene : public testing::TestWithParam<unsigned> {
 protected:
  void SetUp() override {
    SimulatedScene scene = simulated_scene(GetParam());
    if (!scene.analysis) GTEST_SKIP() << scene.failure;
    scene_ = scene.mechanism.file;
    problem_ = std::move(scene.problem);
    analysis_ = std::move(scene.analysis);
    values_ = values_of(*analysis_);
    magnitudes_ = magnitudes_of(*analysis_);
  }

  const std::string& name(Eigen::Index i) const { return problem_.responses[i].name; }

  /// Of the largest value in time. What is nothing but round-off (the bow of a member that nothing
  /// bends) has no size to be compared with.
  Eigen::VectorXd difference(const Eigen::VectorXd& one, const Eigen::VectorXd& other) const {
    constexpr double nothing = 1e-25;
    return (one - other).cwiseAbs().cwiseQuotient(magnitudes_.cwiseMax(nothing));
  }

  /// What round-off makes of the values, measured: files whose numbers differ in their last places
  /// only, of the mechanism in a general position, where no coordinate is zero.
  Eigen::VectorXd noise() const {
    const Json turned = rotated(scene_, general_rotation(GetParam() + 1000));
    const Eigen::VectorXd values = start_values(turned);
    Eigen::VectorXd noise = Eigen::VectorXd::Zero(values.size());
    for (unsigned seed = 0; seed < samples; ++seed) {
      const Json other = nudged(turned, seed, round_off);
      noise = noise.cwiseMax(difference(start_values(other), values));
    }
    return noise;
  }

  /// To 1e-9 of the largest value, or to what round-off does.
  void expect_same(const Json& other, const char* what, double allowed = 1e-9) const {
    const Eigen::VectorXd differences = difference(start_values(other), values_);
    if (differences.maxCoeff() <= allowed) return;
    const Eigen::VectorXd limits = (of_few_samples * noise()).cwiseMax(allowed);
    for (Eigen::Index i = 0; i < differences.size(); ++i) {
      EXPECT_LE(differences(i), limits(i)) << name(i) << " " << what;
    }
  }

  /// Largest difference of gradients, one a response: see gradient_error().
  Eigen::VectorXd gradient_errors(const Eigen::MatrixXd& gradients,
                                  const Eigen::MatrixXd& reference) const {
    const Eigen::VectorXd x = start_design(problem_);
    Eigen::VectorXd errors(gradients.rows());
    for (Eigen::Index i = 0; i < errors.size(); ++i) {
      errors(i) = gradient_error(gradients.row(i), reference.row(i), x, 1e3 * magnitudes_(i));
    }
    return errors;
  }

  /// What round-off makes of gradients by a method, measured as noise() is.
  Eigen::VectorXd gradient_noise(GradientMethod method, const Eigen::MatrixXd& reference) const {
    Eigen::VectorXd noise = Eigen::VectorXd::Zero(reference.rows());
    for (unsigned seed = 0; seed < samples; ++seed) {
      const ProblemFile problem = read(nudged(scene_, seed, round_off));
      const Eigen::VectorXd x = start_design(problem);
      noise = noise.cwiseMax(
          gradient_errors(gradients(problem, x, *analyze(problem, x), method), reference));
    }
    return noise;
  }

  /// Values with peaks held at the instants of this design, as smooth as the motion: a peak that
  /// moves past an instant has other samples, and the parabola through them is a bit off. By the
  /// envelope theorem they have the derivatives of the values.
  Eigen::VectorXd linearized(const Analysis& analysis) const {
    Eigen::VectorXd values = values_of(analysis);
    for (std::size_t i = 0; i < analysis.histories.size(); ++i) {
      if (analysis.histories[i].size() == 0) continue;
      double& value = values(i) = 0.0;
      for (const Sample& sample : analysis_->reductions[i].samples) {
        value += sample.weight * analysis.histories[i](sample.channel, sample.step);
      }
    }
    return values;
  }

  struct DifferenceErrors {
    Eigen::VectorXd of_gradients;   ///< against the differences of the step that fits best
    Eigen::VectorXd of_themselves;  ///< change from step to step, where that is smallest
  };

  /// Errors of gradients against central differences, extrapolated, one a response. Long steps see
  /// curvature, short ones round-off; of a chaotic motion none may be good.
  DifferenceErrors difference_errors(const Eigen::MatrixXd& gradients, double aim) const {
    const Eigen::VectorXd x = start_design(problem_);
    const auto values = [this](const Analysis& analysis) { return linearized(analysis); };
    const auto differences = [&](double step) {
      return gradients_by_differences(problem_, x, *analysis_, GradientMethod::central_difference,
                                      values, {.difference_step = step});
    };
    const Eigen::VectorXd unknown = Eigen::VectorXd::Constant(values_.size(), 1e300);
    DifferenceErrors errors{unknown, unknown};
    Eigen::MatrixXd before;
    for (const double step : {1e-4, 1e-3, 3e-3, 1e-2, 1e-5, 1e-6, 1e-7}) {
      Eigen::MatrixXd found;
      try {
        const Eigen::MatrixXd wide = differences(2.0 * step), narrow = differences(step);
        found = (4.0 * narrow - wide) / 3.0;
      } catch (const SimulationError&) {
        continue;  // a neighbour does not run
      }
      errors.of_gradients = errors.of_gradients.cwiseMin(gradient_errors(gradients, found));
      if (errors.of_gradients.maxCoeff() <= aim) break;
      if (before.size() > 0) {
        errors.of_themselves = errors.of_themselves.cwiseMin(gradient_errors(before, found));
      }
      before = found;
    }
    return errors;
  }

  Json scene_;
  ProblemFile problem_;
  std::unique_ptr<Analysis> analysis_;
  Eigen::VectorXd values_, magnitudes_;
};

TEST_P(RandomScene, AnswersTheSameWhicheverWayItLies) {
  expect_same(rotated(scene_, general_rotation(GetParam())), "turned");
}

TEST_P(RandomScene, AnswersTheSameUnderOtherNames) {
  expect_same(renamed(scene_), "renamed");
}

TEST_P(RandomScene, AnswersTheSameInOtherUnits) {
  expect_same(in_other_units(scene_), "in mm");
}

/// In space a drive's equation is the sine of its error, in a plane that error. Both torques are
/// the same but for the cosine, where constraints drift.
TEST_P(RandomScene, AnswersTheSameInAPlaneAndInSpace) {
  if (!is_planar(scene_)) GTEST_SKIP() << "moves in space";
  const double drift = monitor(analysis_->model, analysis_->trajectory).position_drift;
  expect_same(in_space(scene_), "in space", std::max(1e-9, drift * drift));
}

/// Changes of responses for relative changes of the design, against the larger of these changes and
/// of the response itself. Direct differentiation and the adjoint are the same formula in another
/// order: only round-off parts them.
TEST_P(RandomScene, HasTheSameGradientsByAllMethods) {
  const Eigen::VectorXd x = start_design(problem_);
  const Eigen::MatrixXd direct = gradients(problem_, x, *analysis_, GradientMethod::direct);
  const Eigen::MatrixXd adjoint = gradients(problem_, x, *analysis_, GradientMethod::adjoint);
  const Eigen::VectorXd errors = gradient_errors(adjoint, direct);
  if (errors.maxCoeff() > 1e-10) {
    const Eigen::VectorXd noise = gradient_noise(GradientMethod::direct, direct)
                                      .cwiseMax(gradient_noise(GradientMethod::adjoint, adjoint));
    for (Eigen::Index i = 0; i < errors.size(); ++i) {
      EXPECT_LE(errors(i), std::max(1e-10, of_few_samples * noise(i))) << name(i);
    }
  }
  constexpr double agreement = 1e-5;
  const DifferenceErrors differences = difference_errors(direct, agreement);
  for (Eigen::Index i = 0; i < values_.size(); ++i) {
    const double own = differences.of_themselves(i);
    ASSERT_LT(differences.of_gradients(i), 1e300) << "no neighbour runs";
    EXPECT_LE(differences.of_gradients(i),
              std::max(agreement, own < 1e300 ? of_few_samples * own : 0.0))
        << name(i);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomScene, testing::Range(first_seed, end_seed),
                         named_by_value());

/// So many seeds at most: each takes some simulations for each of three tolerances.
constexpr unsigned most_seeds = 45;

int count_left_out(const ProblemFile& problem) {
  int count = 0;
  for (const auto& [name, effect] : problem.effects.decisions.measured)
    count += effect.is_needed ? 0 : 1;
  return count;
}

TEST(RandomEffects, ThatAreLeftOutChangeNoResponseByMoreThanTheTolerance) {
  int left_out = 0;
  for (unsigned seed = first_seed; seed < std::min(end_seed, first_seed + most_seeds); ++seed) {
    const SimulatedScene scene = simulated_scene(seed);
    if (!scene.analysis) continue;
    ProblemFile complete = scene.problem;
    complete.effects = {};
    const auto [x, everything] = started(complete);
    for (const double tolerance : {0.1, 1e-2, 1e-3}) {
      ProblemFile lean = complete;
      lean.effects.tolerance = tolerance;
      decide_effects(lean);
      left_out += count_left_out(lean);
      const LargestChange change = largest_change(lean, *everything, *analyze(lean, x));
      EXPECT_LE(change.relative, tolerance) << "seed " << seed << ": " << change.response;
    }
  }
  EXPECT_GT(left_out, 0) << "nothing was left out: this shows nothing";
}

/// Runs something for each seed, several at a time. @return one result a seed
template <class Result, class Make>
std::vector<Result> for_all_seeds(const Make& make) {
  std::vector<Result> results(end_seed - first_seed);
  for_each_in_parallel(static_cast<int>(results.size()), available_threads(),
                       [&](int i) { results[i] = make(first_seed + static_cast<unsigned>(i)); });
  return results;
}

struct Kind {
  bool has_run = false;
  RandomMechanism mechanism;
};

TEST(RandomScenes, RunInSufficientNumberAndOfAllKinds) {
  const std::vector<Kind> kinds = for_all_seeds<Kind>([](unsigned seed) {
    SimulatedScene scene = simulated_scene(seed);
    return Kind{scene.analysis != nullptr, std::move(scene.mechanism)};
  });
  std::map<std::string, int> counts;
  for (const Kind& kind : kinds) {
    if (!kind.has_run) continue;
    const Json& simulation = kind.mechanism.file["simulation"];
    ++counts["all"];
    ++counts[kind.mechanism.kind];
    ++counts[simulation.value("formulation", "index-3")];
    if (kind.mechanism.is_spatial) ++counts["in space"];
    if (kind.mechanism.resonance_share > 0.4) ++counts["near resonance"];
    if (simulation.contains("initial_state")) ++counts["settled"];
    if (kind.mechanism.file["scene"].contains("gravity")) ++counts["gravity"];
    if (kind.mechanism.file["scene"].contains("loads")) ++counts["loads"];
  }
  EXPECT_GE(counts["all"], least_scenes);
  for (const char* kind :
       {"four-bar", "slider-crank", "spatial slider-crank", "chain", "in space", "index-3",
        "stabilized-index-2", "index-1", "settled", "gravity", "loads", "near resonance"}) {
    EXPECT_GE(counts[kind], least_scenes / 20) << kind;
  }
}

/// What finer runs say of the values of one scene.
struct Judged {
  bool has_run = false, is_converged = true;
  std::string warning;              ///< the first; empty: none
  std::vector<std::string> missed;  ///< sentences
};

bool is_named(const std::vector<Finding>& findings, const std::string& response) {
  return std::any_of(findings.begin(), findings.end(), [&](const Finding& finding) {
    return finding.text.find("\"" + response + "\"") != std::string::npos;
  });
}

const char* what_changes(const Refinement& refinement) {
  if (refinement.more_modes > 0) return "two modes more";
  return refinement.step < 1.0 ? "a quarter of the step" : "four times the elements";
}

Judged judge(unsigned seed, const SimulatedScene& scene) {
  Judged judged;
  if (!scene.analysis) return judged;
  judged.has_run = true;
  const Eigen::VectorXd x = start_design(scene.problem), values = values_of(*scene.analysis);
  const Monitors monitors = monitor(scene.analysis->model, scene.analysis->trajectory);
  const TrustedRun run{scene.problem, x, *scene.analysis, monitors};
  const std::vector<Finding> findings = check_resolution(run, judge_resolution(run));
  if (!findings.empty()) judged.warning = fmt::format("seed {}: {}", seed, findings.front().text);
  std::vector<Refinement> refinements = {{0.25, 1.0}, {1.0, 4.0}};
  if (has_reduced_beams(scene.analysis->model, scene.problem)) {
    refinements.push_back({1.0, 1.0, 2});
  }
  for (const Refinement& refinement : refinements) {
    const RefinedRun fine = make_refined_run(scene.problem, x, refinement);
    judged.is_converged = judged.is_converged && !fine.has_failed();
    if (fine.has_failed()) continue;
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      const auto index = static_cast<std::size_t>(i);
      const Eigen::MatrixXd& history = fine.histories[index];
      const double size = history.size() > 0 ? history.cwiseAbs().maxCoeff() : 0.0;
      const double change = value_error(values(i), fine.values(i), size);
      const std::string& name = scene.problem.responses[index].name;
      if (change > 0.01) judged.is_converged = false;
      if (change <= 0.1 || is_named(findings, name)) continue;
      judged.missed.push_back(fmt::format("seed {}: \"{}\" changes by {:.0f} % with {}", seed, name,
                                          100 * change, what_changes(refinement)));
    }
  }
  return judged;
}

/// What changes by more than a tenth with a quarter of the step, four times the elements or more
/// modes of reduced members is named by a warning; what changes by less than a hundredth rarely is.
void expect_warnings(const char* what, const std::vector<Judged>& all) {
  int scenes = 0, converged = 0, false_alarms = 0;
  for (const Judged& judged : all) {
    if (!judged.has_run) continue;
    ++scenes;
    for (const std::string& missed : judged.missed) ADD_FAILURE() << missed;
    if (!judged.is_converged) continue;
    ++converged;
    if (judged.warning.empty()) continue;
    ++false_alarms;
    fmt::print("{}\n", judged.warning);
  }
  fmt::print("{}: {} scenes, {} of them converged, {} of these warned of\n", what, scenes,
             converged, false_alarms);
  EXPECT_GE(scenes, least_scenes);
  constexpr int few = 30;  // of which no share can be told
  if (converged >= few) {
    EXPECT_LE(10 * false_alarms, converged);
  }
}

TEST(RandomScenes, AreWarnedOfWhatIsNotResolvedAndOfLittleElse) {
  expect_warnings("as they are", for_all_seeds<Judged>([](unsigned seed) {
                    return judge(seed, simulated_scene(seed));
                  }));
}

TEST(RandomScenes, AreWarnedOfWhatIsNotResolvedWhereStartsAndLoadsAreSudden) {
  expect_warnings("sudden", for_all_seeds<Judged>([](unsigned seed) {
                    return judge(seed, simulated(suddenly_loaded(random_scene(seed), seed)));
                  }));
}

}  // namespace
}  // namespace pleuel::test::random_scene_test
