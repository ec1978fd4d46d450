/// How constraints and their sensitivities drift with each formulation, as CSV on standard output:
/// without arguments in thirty revolutions of a slider-crank, the data of docs/drift.svg, else in a
/// problem with overrides.
///
///     build/bench/bench/drift > drift.csv && docs/draw_drift.py drift.csv > docs/drift.svg
///     build/bench/bench/drift problems/hard/dead_centres.json "/simulation/end_time=10 s"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "sensitivity/direct.hpp"
#include "studies/stability.hpp"

namespace pleuel {
namespace {

struct Case {
  std::filesystem::path file;
  std::vector<std::string> overrides;
};

/// A driven mechanism that closes: thirty revolutions, whose phase does not depend on the design.
Case drawn_case() {
  return {std::filesystem::path(PLEUEL_SOURCE_DIR) / "problems/hard/impossible_designs.json",
          {"/variables/crank_length/start=60 mm", "/simulation/end_time=10 s",
           "/simulation/step=1 ms"}};
}

/// Points of each curve.
constexpr int windows = 100;

/// The largest of a window of time.
struct Drift {
  double position = 0.0;     ///< |Φ| [m or rad]
  double sensitivity = 0.0;  ///< |Φ_q s_q + Φ_x| x: per relative change of the variable, likewise
};

ProblemFile read(Case observed, const ComparedFormulation& formulation) {
  observed.overrides.insert(observed.overrides.end(), formulation.overrides.begin(),
                            formulation.overrides.end());
  return read_problem(observed.file, observed.overrides).complete();
}

/// Φ and dΦ/dx at one instant.
class Observer {
 public:
  Observer(System& system, const Eigen::VectorXd& x)
      : system_(system), x_(x), tangent_(system.make_matrix()) {}

  Drift operator()(const State& state, const StateSensitivity& sensitivity) {
    constexpr auto level = ConstraintLevel::position;
    const Eigen::Index n = state.q.size(), m = state.lambda.size();
    system_.linearize(state, Weights{.q = 1.0}, level, residual_, tangent_);
    system_.design_derivative(state, level, design_);
    const Eigen::MatrixXd slopes =
        tangent_.bottomLeftCorner(m, n) * sensitivity.q + design_.bottomRows(m);
    return {residual_.tail(m).lpNorm<Eigen::Infinity>(),
            (slopes * x_.asDiagonal()).lpNorm<Eigen::Infinity>()};
  }

 private:
  System& system_;
  Eigen::VectorXd x_, residual_;
  System::Matrix tangent_;
  Eigen::MatrixXd design_;
};

std::vector<Drift> observe(Analysis& analysis, const Eigen::VectorXd& x) {
  std::vector<Drift> drifts(windows);
  const double end = analysis.trajectory.time(analysis.trajectory.steps());
  Observer observer(*analysis.model.mechanism.system, x);
  differentiate(analysis.model.mechanism, analysis.trajectory,
                [&](int, const State& state, const StateSensitivity& sensitivity) {
                  const Drift now = observer(state, sensitivity);
                  const int window =
                      std::min(windows - 1, static_cast<int>(windows * state.time / end));
                  Drift& worst = drifts[static_cast<std::size_t>(window)];
                  worst.position = std::max(worst.position, now.position);
                  worst.sensitivity = std::max(worst.sensitivity, now.sensitivity);
                });
  return drifts;
}

void print(const std::string& formulation, double end, const std::vector<Drift>& drifts) {
  for (std::size_t i = 0; i < drifts.size(); ++i) {
    fmt::print("{},{:.6g},{:.4e},{:.4e}\n", formulation,
               end * static_cast<double>(i + 1) / static_cast<double>(drifts.size()),
               drifts[i].position, drifts[i].sensitivity);
  }
}

}  // namespace
}  // namespace pleuel

int main(int argc, char** argv) {
  using namespace pleuel;
  const Case observed = argc < 2 ? drawn_case() : Case{argv[1], {argv + 2, argv + argc}};
  fmt::print("formulation,time,position,sensitivity\n");
  for (const ComparedFormulation& formulation : compared_formulations()) {
    if (formulation.name.starts_with("index-3, ")) continue;  // another scheme
    const ProblemFile problem = read(observed, formulation);
    const Eigen::VectorXd x = start_design(problem);
    const auto analysis = analyze(problem, x);
    print(formulation.name, problem.simulation.end_time, observe(*analysis, x));
  }
}
