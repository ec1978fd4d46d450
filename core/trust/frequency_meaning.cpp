#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/linear/linearization.hpp"
#include "core/linear/modes.hpp"
#include "core/response/full_mechanism.hpp"
#include "core/response/modal_vectors.hpp"
#include "core/scene/shown_unit.hpp"
#include "core/trust/check_list.hpp"

namespace pleuel {

namespace {

/// Relative change of a frequency that is worth a word.
constexpr double small_shift = 1e-2;

std::vector<const Response*> modes_of_mechanism(const TrustedRun& run) {
  std::vector<const Response*> found;
  for (const Response& response : run.analysis.responses) {
    if (response.mode()) found.push_back(&response);
  }
  return found;
}

std::vector<std::string> names_of(const std::vector<const Response*>& responses) {
  std::vector<std::string> names;
  for (const Response* response : responses) names.push_back(response->name);
  return names;
}

/// In the unit of a response.
std::string number_text(const TrustedRun& run, const Response& response, double number) {
  const ShownUnit unit = unit_of(find_response(run.problem, response.name));
  return fmt::format("{:.5g}{}", unit.shown(number), unit.suffix());
}

/// What a response would be in axes that turn with the bodies; none where that cannot be told.
std::optional<double> number_in_turning_axes(const LinearizedModes& turning,
                                             const ModeChoice& choice) {
  try {
    return number_of(choice.of, turning.modes(find_mode(turning, choice)));
  } catch (const InputError&) {
  } catch (const SimulationError&) {
  }
  return std::nullopt;
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
  const Model& model = model_of_modes(analysis);
  std::vector<std::string> told, names;
  const Response* frequency = nullptr;
  for (const bool is_damped : {false, true}) {
    std::optional<LinearizedModes> turning;
    for (const Response* response : responses) {
      const ModeChoice& choice = response->mode()->choice;
      if (choice.counts_damping() != is_damped) continue;
      const MotionAxes axes(model.mechanism, state, axes_of(choice));
      if (axes.kind() == MotionAxes::Kind::rotor) continue;  // is right
      if (!turning) turning.emplace(model, state, is_damped, MotionAxes::Kind::turning);
      const double shown = analysis.reductions[response - analysis.responses.data()].value;
      const double other = number_in_turning_axes(*turning, choice).value_or(shown);
      if (std::abs(other - shown) <= small_shift * std::abs(shown)) continue;
      told.push_back(fmt::format("\"{}\" is {} and {}", response->name,
                                 number_text(run, *response, shown),
                                 number_text(run, *response, other)));
      names.push_back(response->name);
      if (!is_damped) frequency = response;
    }
  }
  if (names.empty()) return;
  const double speed = fastest_turn(model.mechanism, state).omega.norm();
  const std::string beside =
      speed > 0.0 && frequency != nullptr
          ? fmt::format(
                " (seen from beside the machine a whirl is faster or slower by the speed, {})",
                number_text(run, *frequency, speed))
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
  const std::vector<const Response*> responses = modes_of_mechanism(run);
  if (responses.empty()) return findings;
  add_turning(run, responses, findings);
  add_missing_stress(run, responses, findings);
  return findings;
}

}  // namespace pleuel
