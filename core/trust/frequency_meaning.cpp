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

/// Relative change that is worth a word.
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

bool is_near(double other, double shown) {
  return std::abs(other - shown) <= small_shift * std::abs(shown);
}

/// What the mode of a response becomes in other axes: of vibrations without damping the one in its place,
/// of others the nearest one; none if there is none.
std::optional<std::complex<double>> same_mode(const Analysis& analysis, std::size_t response,
                                              const Eigen::VectorXcd& others) {
  if (others.size() == 0) return std::nullopt;
  const int mode = analysis.mechanism_modes[response];
  if (analysis.responses[response].mode()->counts_damping()) {
    Eigen::Index nearest = 0;
    (others.array() - analysis.damped_modes(mode)).abs().minCoeff(&nearest);
    return others(nearest);
  }
  return mode < others.size() ? std::optional(others(mode)) : std::nullopt;
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
  std::vector<std::string> told, names;
  const Response* frequency = nullptr;
  for (const bool is_damped : {false, true}) {
    std::optional<Eigen::VectorXcd> turning;
    for (const Response* response : responses) {
      const ModeChoice& choice = *response->mode();
      if (choice.counts_damping() != is_damped) continue;
      const MotionAxes axes(mechanism, state, axes_of(choice));
      if (axes.kind() == MotionAxes::Kind::rotor) continue;  // is right
      if (!turning) {
        turning = modes_of(linearize(mechanism, state, turning_of(mechanism, state), is_damped));
      }
      const std::size_t i = response - analysis.responses.data();
      const auto mode = same_mode(analysis, i, *turning);
      if (!mode) continue;
      const double shown = analysis.reductions[i].value, other = number_of(choice.of, *mode);
      const double decay = is_damped ? analysis.damped_modes(analysis.mechanism_modes[i]).real()
                                     : mode->real();  // a ratio hides how that changes
      if (is_near(other, shown) && is_near(mode->real(), decay)) continue;
      told.push_back(fmt::format("\"{}\" is {} and {}", response->name,
                                 number_text(run, *response, shown),
                                 number_text(run, *response, other)));
      names.push_back(response->name);
      if (!is_damped) frequency = response;
    }
  }
  if (names.empty()) return;
  const double speed = fastest_turn(mechanism, state).omega.norm();
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
