#include <map>

#include "core/base/eager_matrices.hpp"
#include "core/base/relative_error.hpp"
#include "core/jobs/parallel.hpp"
#include "core/response/monitors.hpp"
#include "core/trust/checks.hpp"
#include "core/trust/refined_runs.hpp"
#include "core/trust/resolution.hpp"
#include "tests/random/seeds.hpp"
#include "tests/random/simulated_scene.hpp"
#include "tests/support/test.hpp"

/// What warnings about resolution are worth, over all random mechanisms together.
namespace pleuel::test::random_resolution_test {
namespace {

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
}  // namespace pleuel::test::random_resolution_test
