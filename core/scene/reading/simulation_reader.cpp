#include "core/scene/reading/simulation_reader.hpp"

#include <cmath>

#include <fmt/format.h>

#include "core/scene/reading/key_reader.hpp"

namespace pleuel {

namespace {

enum class InitialState { consistent, quasi_static, periodic };

/// The end is a whole number of periods up to round-off: it becomes exact.
void fit_to_end(const JsonNode& node, SimulationSettings& settings) {
  constexpr double round_off = 1e-6;
  const double periods = settings.end_time / settings.period, whole = std::round(periods);
  if (whole < 1.0 || std::abs(periods - whole) > round_off * whole) {
    node.fail_with_value(fmt::format(
        "must fit into /simulation/end_time a whole number of times, and does so {:.6g} times",
        periods));
  }
  settings.period = settings.end_time / whole;
}

/// What a motion that repeats itself cannot be combined with.
void check_periodic(const JsonNode& node, const SimulationSettings& settings) {
  const Formulation& formulation = settings.formulation;
  if (formulation.constraints == ConstraintForm::index_1 && formulation.baumgarte == 0.0 &&
      !formulation.is_projected) {
    node.fail(
        "is \"periodic\", but with the formulation \"index-1\" joints drift apart, which does not "
        "repeat itself: add \"projection\": true or \"baumgarte\", or take another formulation");
  }
  if (settings.local_error > 0.0) {
    node.fail(
        "is \"periodic\", which needs the same steps in each period: leave out \"local_error\"");
  }
}

void read_initial_state(const JsonNode& node, const NumberReader& numbers,
                        SimulationSettings& settings) {
  const bool is_object = node.value().is_object();
  if (is_object) node.allow_keys({"type", "period"});
  const auto type = read_choice<InitialState>(is_object ? node.at("type") : node,
                                              {{"consistent", InitialState::consistent},
                                               {"quasi-static", InitialState::quasi_static},
                                               {"periodic", InitialState::periodic}});
  settings.quasi_static_start = type == InitialState::quasi_static;
  const auto period = is_object ? node.find("period") : std::nullopt;
  if (type != InitialState::periodic) {
    if (period) period->fail("is for the initial state \"periodic\" only");
    return;
  }
  check_periodic(node, settings);
  settings.period = settings.end_time;
  if (!period) return;
  settings.period = numbers.fixed(*period, quantities::time, Range::positive);
  fit_to_end(*period, settings);
}

}  // namespace

SimulationSettings read_simulation(const JsonNode& node, NumberReader& numbers) {
  SimulationSettings settings;
  read_keys(node, numbers, settings);
  if (const auto state = node.find("initial_state")) read_initial_state(*state, numbers, settings);
  return settings;
}

}  // namespace pleuel
