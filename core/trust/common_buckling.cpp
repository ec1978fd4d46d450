#include "core/trust/common_buckling.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.hpp"
#include "core/integration/equilibrium.hpp"
#include "core/response/full_mechanism.hpp"
#include "core/trust/unstable_members.hpp"

namespace pleuel {

namespace {

constexpr const char* unseen = "Motion in a plane does not have this buckling.";

Doubt not_judged(const std::vector<std::string>& pressed, const std::string& reason) {
  return {fmt::format("Whether \"{}\" {} together with the elastic bodies beside {} was not looked "
                      "at: each member is judged by itself, with its neighbours as rigid, as the "
                      "mechanism {}",
                      fmt::join(pressed, "\", \""), pressed.size() == 1 ? "buckles" : "buckle",
                      pressed.size() == 1 ? "it" : "them", reason),
          false};
}

Doubt not_simulated(const std::vector<std::string>& pressed, const std::exception& error) {
  return not_judged(pressed, fmt::format("cannot be simulated in space: {}", error.what()));
}

/// Of the mechanism in space.
int coordinates_in_space(const Model& model) {
  return model.mechanism.system->coordinates() + model.effects.front().coordinates_saved;
}

}  // namespace

std::vector<Doubt> doubt_common_buckling(const TrustedRun& run,
                                         const std::vector<std::string>& pressed) {
  if (coordinates_in_space(run.analysis.model) > most_judged_coordinates) {
    return {not_judged(
        pressed, fmt::format("has more than {} coordinates in space.", most_judged_coordinates))};
  }
  ProblemFile space = with_all_modes(run.problem);
  space.effects.geometric_stiffening = EffectChoice::on;
  space.responses.clear();
  try {
    const std::unique_ptr<Analysis> analysis = analyze(space, run.x);
    return doubt_instability(space.scene, *analysis, unseen);
  } catch (const UnstableEquilibrium& error) {
    return {
        {fmt::format("In space {}. {} Make it stiffer, or hold it.", error.what(), unseen), true}};
  } catch (const SimulationError& error) {
    return {not_simulated(pressed, error)};
  } catch (const InputError& error) {
    return {not_simulated(pressed, error)};
  }
}

}  // namespace pleuel
