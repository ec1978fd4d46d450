#include <algorithm>
#include <cmath>
#include <complex>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/linear/linearization.hpp"
#include "core/linear/modes.hpp"
#include "core/response/full_mechanism.hpp"
#include "core/scene/shown_unit.hpp"
#include "core/trust/check_list.hpp"

namespace pleuel {

namespace {

/// Relative change of a frequency that is worth a word.
constexpr double small_shift = 1e-2;

std::vector<const Response*> frequencies_of_mechanism(const TrustedRun& run) {
  std::vector<const Response*> found;
  for (const Response& response : run.analysis.responses) {
    if (response.mode() && !response.mode()->choice.counts_damping()) found.push_back(&response);
  }
  return found;
}

std::vector<std::string> names_of(const std::vector<const Response*>& responses) {
  std::vector<std::string> names;
  for (const Response* response : responses) names.push_back(response->name);
  return names;
}

/// A frequency that is another one by more than is worth a word, as it may be looked at otherwise.
struct Shift {
  const Response* response;
  std::string shown, other;  ///< as people see them: "12.4 Hz"
};

/// In the unit of a response.
std::string frequency_text(const TrustedRun& run, const Response& response, double frequency) {
  const ShownUnit unit = unit_of(find_response(run.problem, response.name));
  return fmt::format("{:.5g}{}", unit.shown(frequency), unit.suffix());
}

/// @param others  frequencies of the mechanism, one a mode
std::vector<Shift> shifts(const TrustedRun& run, const std::vector<const Response*>& responses,
                          const Eigen::VectorXd& others) {
  std::vector<Shift> found;
  for (const Response* response : responses) {
    const int mode = run.analysis.mechanism_modes[response - run.analysis.responses.data()];
    if (mode >= others.size()) continue;
    const double shown = run.analysis.mechanism_frequencies(mode);
    if (std::abs(others(mode) - shown) <= small_shift * std::abs(shown)) continue;
    found.push_back({response, frequency_text(run, *response, shown),
                     frequency_text(run, *response, others(mode))});
  }
  return found;
}

void add_missing_stress(const TrustedRun& run, const std::vector<const Response*>& responses,
                        std::vector<Finding>& findings) {
  const std::string& why = run.analysis.vibrating->without_equilibrium;
  if (why.empty()) return;
  findings.push_back({fmt::format("natural frequencies are those of undeformed members: the "
                                  "equilibrium with the motion and the loads at t = 0, about which "
                                  "they would vibrate, was not found ({}).",
                                  why),
                      true, names_of(responses)});
}

/// Small motions have constant coefficients only in axes that turn with the mechanism.
void add_turning(const TrustedRun& run, const std::vector<const Response*>& responses,
                 std::vector<Finding>& findings) {
  const Analysis& analysis = run.analysis;
  const State& state = analysis.vibrating->initial.state;
  if (!analysis.modes_left_out.empty() || state.v.isZero(0.0)) return;
  const Mechanism& mechanism = model_of_modes(analysis).mechanism;
  const Eigen::VectorXd turning =
      frequencies_of(linearize(mechanism, state, turning_of(mechanism, state), false));
  std::vector<std::string> told, names;
  for (const auto& [response, shown, other] : shifts(run, responses, turning)) {
    told.push_back(fmt::format("\"{}\" is {} and {}", response->name, shown, other));
    names.push_back(response->name);
  }
  if (names.empty()) return;
  const double speed = fastest_turn(mechanism, state).omega.norm();
  const std::string beside =
      speed > 0.0
          ? fmt::format(
                " (seen from beside the machine a whirl is faster or slower by the speed, {})",
                frequency_text(run, *responses.front(), speed))
          : "";
  findings.push_back(
      {fmt::format("frequencies are not high against the speed at which the mechanism moves at "
                   "t = 0: in axes that stand still and in axes that turn with the bodies {}. "
                   "Where all bodies turn alike the second is right{}; where only some turn, as a "
                   "rotor on a tower, neither is. Do not rely on {}.",
                   fmt::join(told, ", "), beside, names.size() == 1 ? "it" : "them"),
       true, names});
}

}  // namespace

std::vector<Finding> check_frequencies(const TrustedRun& run) {
  std::vector<Finding> findings;
  if (!run.analysis.modes_left_out.empty()) {
    findings.push_back(
        {fmt::format("natural frequencies are those of the motion in the plane and of "
                     "what effects leave in it only, as the mechanism cannot be "
                     "started in space: {}",
                     run.analysis.modes_left_out)});
  }
  const std::vector<const Response*> responses = frequencies_of_mechanism(run);
  if (responses.empty()) return findings;
  add_turning(run, responses, findings);
  add_missing_stress(run, responses, findings);
  return findings;
}

}  // namespace pleuel
