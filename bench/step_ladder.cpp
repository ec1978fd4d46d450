/// Error against processor time of the flexible slider-crank that EXUDYN computed, for a ladder of
/// elements and steps; rotary inertia is off, since the other code has none. The error is that of
/// the rod's deflection, largest over largest: against the stored history of EXUDYN (every 0.5 ms;
/// it contains the difference of the two models) and against a finer run of the same model.

#include <ctime>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"

namespace pleuel {
namespace {

constexpr int instants = 300;  ///< of the stored history, after the start
constexpr double end_time = 0.15;

/// Every 0.5 ms.
Eigen::VectorXd stored_history() {
  std::ifstream stream(PLEUEL_SOURCE_DIR "/tests/data/slider_crank_exudyn_rod10mm.csv");
  Eigen::VectorXd history(instants + 1);
  std::string line;
  std::getline(stream, line);
  for (double& value : history) {
    std::getline(stream, line);
    std::istringstream cells(line);
    std::string cell;
    for (int column = 0; column <= 4; ++column) std::getline(cells, cell, ',');
    value = std::stod(cell);
  }
  return history;
}

struct Mesh {
  int rod, crank;
};

struct Run {
  Eigen::VectorXd history;  ///< every 0.5 ms
  double seconds;           ///< processor time, the least of some
};

Run run(const Mesh& mesh, int steps, int repetitions) {
  const ProblemFile problem =
      read_problem(std::string(PLEUEL_SOURCE_DIR) + "/problems/slider_crank_exudyn.json",
                   {fmt::format("/scene/bodies/rod/elements={}", mesh.rod),
                    fmt::format("/scene/bodies/crank/elements={}", mesh.crank),
                    fmt::format("/simulation/step={:.17g}", end_time / steps),
                    "/effects/rotary_inertia=off"})
          .complete();
  Run result{{}, 1e300};
  for (int i = 0; i < repetitions; ++i) {
    const std::clock_t start = std::clock();
    const auto analysis = analyze(problem, Eigen::VectorXd());
    result.seconds =
        std::min(result.seconds, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    const int every = analysis->trajectory.steps() / instants;
    result.history.resize(instants + 1);
    for (int k = 0; k <= instants; ++k) result.history(k) = analysis->histories[0](0, k * every);
  }
  return result;
}

double error(const Eigen::VectorXd& history, const Eigen::VectorXd& reference) {
  return (history - reference).lpNorm<Eigen::Infinity>() / reference.lpNorm<Eigen::Infinity>();
}

}  // namespace
}  // namespace pleuel

int main() {
  using namespace pleuel;
  const Eigen::VectorXd stored = stored_history();
  const Run fine = run({16, 8}, 48000, 1);
  fmt::print("rod/crank  step [s]   time [ms]   error: EXUDYN   own\n");
  for (const Mesh mesh : {Mesh{2, 1}, Mesh{4, 2}, Mesh{8, 4}}) {
    for (const int steps : {300, 600, 1500, 3000, 6000, 12000}) {
      const Run found = run(mesh, steps, 7);
      fmt::print("{:3}/{:<3}    {:8.3g}   {:9.2f}   {:13.1e}   {:.1e}\n", mesh.rod, mesh.crank,
                 end_time / steps, 1e3 * found.seconds, error(found.history, stored),
                 error(found.history, fine.history));
    }
  }
}
