#include "core/trust/undetermined_reactions.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "core/trust/asked_responses.hpp"

namespace pleuel {

std::vector<Finding> check_undetermined_reactions(const TrustedRun& run) {
  if (std::ranges::none_of(run.analysis.model.effects, [](const EffectRecord& effect) {
        return effect.name == "redundant_constraints";
      })) {
    return {};
  }
  const Trajectory& trajectory = run.analysis.trajectory;
  State state;
  trajectory.states->load(trajectory.steps() / 2, state);
  Finding finding;
  std::string names;
  for (const std::size_t i : asked_parts(run.problem)) {
    const Response& response = run.analysis.responses[i];
    if (!response.history() || response.history()->signal->is_determined(state)) continue;
    finding.responses.push_back(response.name);
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", response.name);
  }
  if (names.empty()) return {};
  const bool is_one = finding.responses.size() == 1;
  finding.text = fmt::format(
      "{} {} not determined by the motion: joints hold more than they have to (`pleuel check` "
      "names "
      "them), and of all reactions that do so the smallest ones are shown. Real ones depend on how "
      "stiff each bearing is. Let joints hold what they do in the machine: of the two bearings of "
      "a "
      "shaft, for one, the first as \"spherical\", the second as \"point-on-line\".",
      names, is_one ? "is" : "are");
  return {finding};
}

}  // namespace pleuel
