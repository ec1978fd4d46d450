/// Effort and accuracy of all gradient methods on the slider-crank, whose members are divided into
/// segments with a width and a height of their own: one line (CSV) for each number of variables,
/// elements and method. Times are the shortest of several, in one run: their ratios to the
/// simulation alone can be compared between machines.
///
///     sensitivity_bench [ENDTIME in s, default 0.01] > sensitivity.csv

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "bench/direct_coupled.hpp"
#include "core/scene/problem_reader.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"

namespace pleuel::bench {
namespace {

/// Divides both members into segments of the sections' start values, each with its own variables.
ProblemFile divided_slider_crank(int segments, int elements, double end_time) {
  ProblemFile problem =
      read_problem(std::filesystem::path(PLEUEL_SOURCE_DIR) / "problems" / "slider_crank.json", {})
          .complete();
  problem.variables.clear();
  problem.constraints.clear();
  problem.objective.reset();
  problem.simulation.end_time = end_time;
  problem.simulation.newton_tolerance = 1e-12;
  std::erase_if(problem.responses,
                [](const ResponseSettings& response) { return response.name != "rod_bow"; });
  problem.responses.front().over_time = OverTime::rms;
  for (Body& body : problem.scene.bodies) {
    auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam == nullptr) continue;
    beam->segments.clear();
    for (int i = 0; i < segments; ++i) {
      const auto add = [&](const char* what, double start) {
        problem.variables.push_back({fmt::format("{}_{}_{}", body.name, what, i + 1), start,
                                     0.5 * start, 2.0 * start, "m"});
        return Number::bound(static_cast<int>(problem.variables.size()) - 1);
      };
      RectangleSection section;
      section.width = add("width", 0.012 + 1e-4 * (i % 7));
      section.height = add("height", 0.015 + 1e-4 * (i % 5));
      beam->segments.push_back({section, elements / segments, std::nullopt});
    }
  }
  return problem;
}

double shortest_seconds(const std::function<void()>& function) {
  double shortest = std::numeric_limits<double>::infinity(), sum = 0.0;
  for (int i = 0; i < 5 && (i < 2 || sum < 1.0) && sum < 20.0; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    function();
    const auto end = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(end - begin).count();
    shortest = std::min(shortest, seconds);
    sum += seconds;
  }
  return shortest;
}

/// d J / d(relative change of all variables along a fixed direction), by differences of sixth order
/// of simulations: tells which method is right, not only that they agree.
double directional_reference(const ProblemFile& problem, const Eigen::VectorXd& x,
                             const Eigen::VectorXd& direction) {
  const auto value = [&](double t) {
    return analyze(problem, x.cwiseProduct(Eigen::VectorXd::Ones(x.size()) + t * direction))
        ->reductions.front()
        .value;
  };
  const double h = 4e-3;
  return (45 * (value(h) - value(-h)) - 9 * (value(2 * h) - value(-2 * h)) +
          (value(3 * h) - value(-3 * h))) /
         (60 * h);
}

class Comparison {
 public:
  Comparison(int segments, int elements, double end_time)
      : problem_(divided_slider_crank(segments, elements, end_time)),
        elements_(elements),
        x_(start_design(problem_)),
        direction_(x_.size()),
        simulation_(shortest_seconds([&] { analysis_ = analyze(problem_, x_); })) {
    for (Eigen::Index i = 0; i < x_.size(); ++i) direction_(i) = i % 3 == 0 ? 1.0 : -0.4;
    reference_ = directional_reference(problem_, x_, direction_);
  }

  void run() {
    print("simulation", simulation_, std::numeric_limits<double>::quiet_NaN());
    const auto values = response_values(*analysis_);
    compare("direct", [&] { return sampled_gradients(*analysis_, values, ExactMethod::direct); });
    compare("adjoint", [&] { return sampled_gradients(*analysis_, values, ExactMethod::adjoint); });
    compare("direct-coupled", [&] { return direct_coupled_gradients(*analysis_, values); });
    if (x_.size() > 16) return;
    compare("forward-difference",
            [&] { return forward_differences(problem_, x_, *analysis_, 1e-6); });
  }

 private:
  /// Of a method with the simulation that it needs.
  void compare(const std::string& method, const std::function<Eigen::MatrixXd()>& compute) {
    Eigen::MatrixXd gradients;
    const double seconds = shortest_seconds([&] { gradients = compute(); });
    const double found = gradients.row(0) * x_.cwiseProduct(direction_);
    print(method, simulation_ + seconds, std::abs(found - reference_) / std::abs(reference_));
  }

  void print(const std::string& method, double seconds, double error) const {
    fmt::print("{},{},{},{:.6g},{:.4g},{:.3g}\n", elements_, x_.size(), method, seconds,
               seconds / simulation_, error);
    std::fflush(stdout);
  }

  ProblemFile problem_;
  int elements_;
  Eigen::VectorXd x_, direction_;
  std::unique_ptr<Analysis> analysis_;
  double simulation_;
  double reference_ = 0.0;
};

}  // namespace
}  // namespace pleuel::bench

int main(int argc, char** argv) {
  const double end_time = argc > 1 ? std::atof(argv[1]) : 0.01;
  fmt::print("elements,variables,method,seconds,ratio,error\n");
  for (int elements : {8, 16, 64}) {
    for (int segments : {1, 4, 16, 64}) {
      if (segments > elements) continue;
      pleuel::bench::Comparison(segments, elements, end_time).run();
    }
  }
}
