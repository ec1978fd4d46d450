/// How processor time grows with the size of a mechanism: elements of the slider-crank, and rigid
/// four-bars, side by side or connected. For each the start (building the model, its redundant
/// constraints, the initial state), a step of a simulation with its responses, and of a gradient by
/// direct differentiation; last the exponent of a power law through the larger half.

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "sensitivity/sampled_gradients.hpp"

namespace pleuel {
namespace {

constexpr int few = 10, many = 210;  ///< steps

/// Processor time of a call, the least of some.
double seconds(const std::function<void()>& call, int repetitions = 3) {
  double least = 1e300;
  for (int i = 0; i < repetitions; ++i) {
    const std::clock_t start = std::clock();
    call();
    least = std::min(least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return least;
}

struct Costs {
  double size, start, step, gradient;  ///< [s]; a step each
};

/// @param problem_with  the problem with so many steps
Costs measure(double size, const std::function<ProblemFile(int)>& problem_with) {
  const ProblemFile short_problem = problem_with(few), long_problem = problem_with(many);
  const Eigen::VectorXd x = start_design(short_problem);
  Costs costs{size, 0.0, 0.0, 0.0};
  const double of_few = seconds([&] { analyze(short_problem, x); });
  const double of_many = seconds([&] { analyze(long_problem, x); });
  costs.step = (of_many - of_few) / (many - few);
  costs.start = of_few - few * costs.step;
  if (x.size() == 0) return costs;
  const auto analysis = analyze(long_problem, x);
  const auto values = response_values(*analysis);
  costs.gradient =
      seconds([&] { sampled_gradients(*analysis, values, ExactMethod::direct); }) / many;
  return costs;
}

/// Slope of log time over log size by least squares.
double exponent(const std::vector<Costs>& all, double Costs::*cost) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (std::size_t i = all.size() / 2; i < all.size(); ++i) {
    const double a = std::log(all[i].size), b = std::log(all[i].*cost);
    n += 1.0;
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

void print(const std::string& title, const std::vector<Costs>& all) {
  fmt::print("{}\n    size   start [ms]   step [us]   gradient [us a step]\n", title);
  for (const Costs& costs : all) {
    fmt::print("{:8.0f}   {:10.2f}   {:9.2f}   {:9.2f}\n", costs.size, 1e3 * costs.start,
               1e6 * costs.step, 1e6 * costs.gradient);
  }
  fmt::print("exponent   {:10.2f}   {:9.2f}", exponent(all, &Costs::start),
             exponent(all, &Costs::step));
  if (all.back().gradient > 0.0) fmt::print("   {:9.2f}", exponent(all, &Costs::gradient));
  fmt::print("\n\n");
}

ProblemFile slider_crank(int elements, int steps) {
  return read_problem(std::string(PLEUEL_SOURCE_DIR) + "/problems/slider_crank.json",
                      {fmt::format("/scene/bodies/rod/elements={}", elements),
                       fmt::format("/scene/bodies/crank/elements={}", elements),
                       fmt::format("/simulation/end_time={:.17g}", 2.5e-5 * steps)})
      .complete();
}

std::string bar(const std::string& name, double x1, double y1, double x2, double y2) {
  return fmt::format(R"("{}": {{"type": "beam", "from": [{}, {}, 0], "to": [{}, {}, 0],
      "material": "steel", "elements": 1, "section": {{"type": "circle", "diameter": "10 mm"}}}})",
                     name, x1, y1, x2, y2);
}

std::string pin(const std::string& name, const std::string& a, const std::string& b, double x,
                double y, const std::string& drive = "") {
  return fmt::format(
      R"("{}": {{"type": "revolute", "bodies": ["{}", "{}"], "at": [{}, {}, 0], "axis": [0, 0, 1]{}}})",
      name, a, b, x, y, drive);
}

/// Connected: a bar from the rocker of each four-bar drives the next crank; apart: all cranks are
/// driven.
enum class Neighbours { apart, connected };
ProblemFile four_bars(int count, Neighbours neighbours, int steps) {
  const std::string drive =
      R"(, "drive": {"type": "ramp-to-speed", "speed": "10 rad/s", "ramp": "0.1 s"})";
  std::vector<std::string> bodies, joints;
  for (int i = 0; i < count; ++i) {
    const double x = i;
    bodies.push_back(bar(fmt::format("crank{}", i), x, 0.0, x, 0.1));
    bodies.push_back(bar(fmt::format("coupler{}", i), x, 0.1, x + 0.35, 0.25));
    bodies.push_back(bar(fmt::format("rocker{}", i), x + 0.35, 0.0, x + 0.35, 0.25));
    const auto name = [i](const char* body) { return fmt::format("{}{}", body, i); };
    joints.push_back(pin(name("a"), "ground", name("crank"), x, 0.0,
                         neighbours == Neighbours::connected && i > 0 ? "" : drive));
    joints.push_back(pin(name("b"), name("crank"), name("coupler"), x, 0.1));
    joints.push_back(pin(name("c"), name("coupler"), name("rocker"), x + 0.35, 0.25));
    joints.push_back(pin(name("d"), name("rocker"), "ground", x + 0.35, 0.0));
    if (neighbours == Neighbours::apart || i == 0) continue;
    bodies.push_back(bar(name("bar"), x - 0.65, 0.1, x, 0.1));
    joints.push_back(pin(name("e"), fmt::format("rocker{}", i - 1), name("bar"), x - 0.65, 0.1));
    joints.push_back(pin(name("f"), name("bar"), name("crank"), x, 0.1));
  }
  return read_problem_text(
             fmt::format(
                 R"({{"scene": {{"gravity": [0, 0, 0], "materials": {{"steel": {{"young": "210 GPa",
          "poisson": 0.3, "density": "7850 kg/m^3"}}}}, "bodies": {{{}}}, "joints": {{{}}}}},
          "effects": {{"elasticity": "off"}},
          "simulation": {{"end_time": {:.17g}, "step": 1e-4}},
          "responses": {{"torque": {{"type": "drive-torque", "joint": "a0",
                                     "over_time": "max-abs"}}}}}})",
                 fmt::join(bodies, ", "), fmt::join(joints, ", "), 1e-4 * steps),
             "four_bars.json")
      .complete();
}

}  // namespace
}  // namespace pleuel

int main() {
  using namespace pleuel;
  std::vector<Costs> elements, apart, connected;
  for (int n = 8; n <= 512; n *= 2) {
    elements.push_back(measure(n, [n](int steps) { return slider_crank(n, steps); }));
  }
  print("slider_crank, elements a member", elements);
  for (int n : {8, 16, 32, 64, 125, 250, 500}) {
    apart.push_back(measure(n, [n](int steps) { return four_bars(n, Neighbours::apart, steps); }));
    connected.push_back(
        measure(n, [n](int steps) { return four_bars(n, Neighbours::connected, steps); }));
  }
  print("rigid four-bars, each driven", apart);
  print("rigid four-bars, the first driven", connected);
}
