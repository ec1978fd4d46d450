#include "picture/companions.hpp"

#include <algorithm>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/make_responses.hpp"

namespace pleuel {

namespace {

constexpr int most_instants = 6000;
/// Multipliers of least norm take a decomposition an instant.
constexpr int most_instants_if_redundant = 400;

bool is_asked_for(const ProblemFile& problem, const ResponseSettings& wanted) {
  return std::any_of(problem.responses.begin(), problem.responses.end(),
                     [&](const ResponseSettings& response) {
                       return response.what == wanted.what && is_peak(response.over_time) &&
                              !response.from && !response.to;
                     });
}

ResponseSettings largest(const std::string& name, const AnyResponse& what) {
  return {name, what, OverTime::max_abs};
}

std::vector<ResponseSettings> drive_settings(const ProblemFile& problem) {
  std::vector<ResponseSettings> wanted;
  for (const Joint& joint : problem.scene.joints) {
    if (!joint.drive) continue;
    const bool turns = joint.drive->coordinate == DrivenCoordinate::angle;
    wanted.push_back(
        largest((turns ? "torque of the drive " : "force of the drive ") + joint.name,
                DriveResponse{joint.name, turns ? DriveNumber::torque : DriveNumber::force}));
    wanted.push_back(
        largest("power of the drive " + joint.name, DriveResponse{joint.name, DriveNumber::power}));
  }
  return wanted;
}

std::vector<ResponseSettings> wanted_settings(const ProblemFile& problem) {
  std::vector<ResponseSettings> wanted = drive_settings(problem);
  for (const Joint& joint : problem.scene.joints) {
    wanted.push_back(
        largest("force in the joint " + joint.name,
                ReactionResponse{joint.name, ReactionKind::force, magnitude_direction}));
  }
  wanted.push_back(largest("kinetic energy", EnergyResponse{.kind = EnergyKind::kinetic}));
  wanted.push_back(largest("elastic energy", EnergyResponse{.kind = EnergyKind::elastic}));
  std::erase_if(wanted, [&](const auto& settings) { return is_asked_for(problem, settings); });
  return wanted;
}

/// The responses that the model has; settings without one are removed.
std::vector<Response> possible_responses(std::vector<ResponseSettings>& settings,
                                         const Model& model) {
  std::vector<Response> responses;
  std::vector<ResponseSettings> possible;
  for (const ResponseSettings& one : settings) {
    try {
      std::vector<Response> made = make_responses({one}, model);
      responses.push_back(std::move(made.front()));
      possible.push_back(one);
    } catch (const InputError&) {  // as of energies of a mechanism that is all rigid
    }
  }
  settings = std::move(possible);
  return responses;
}

Companions observe(std::vector<ResponseSettings> settings, const Analysis& analysis) {
  const std::vector<Response> responses = possible_responses(settings, analysis.model);
  const bool is_redundant = !analysis.model.mechanism.system->left_out().empty();
  const int steps = analysis.trajectory.steps();
  const int most = is_redundant ? most_instants_if_redundant : most_instants;
  const int stride = std::max(1, (steps + most - 1) / most);
  const Eigen::Index instants = steps / stride + 1;
  Companions companions;
  companions.time.resize(instants);
  for (const ResponseSettings& one : settings) {
    companions.all.push_back({one, Eigen::VectorXd::Zero(instants)});
  }
  for (Eigen::Index i = 0; i < instants; ++i) {
    const int step = static_cast<int>(i) * stride;
    const State state = analysis.trajectory.state_at(step);
    companions.time(i) = analysis.trajectory.time(step);
    for (std::size_t k = 0; k < responses.size(); ++k) {
      responses[k].history()->signal->observe(state, companions.all[k].history.segment(i, 1));
    }
  }
  for (Companion& companion : companions.all) {
    companion.value = companion.history.cwiseAbs().maxCoeff(&companion.peak);
  }
  return companions;
}

}  // namespace

Companions find_companions(const ProblemFile& problem, const Analysis& analysis) {
  return observe(wanted_settings(problem), analysis);
}

Companions find_drive_efforts(const ProblemFile& problem, const Analysis& analysis) {
  return observe(drive_settings(problem), analysis);
}

}  // namespace pleuel
