#include "core/trust/common_buckling.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/full_mechanism.hpp"
#include "core/start/elastic_stability.hpp"
#include "core/start/equilibrium.hpp"
#include "core/trust/unstable_members.hpp"

namespace pleuel {

namespace {

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

Doubt out_of_plane(const std::string& what) {
  return {what + ". Motion in a plane does not have this buckling. Make it stiffer, or hold it.",
          true};
}

/// Not serious: loads need not last as long as buckling takes, and motion in a plane shows it unless
/// all is symmetric.
Doubt in_plane(const std::string& what) {
  return {what +
              " in the plane of motion. Loads that do not last may do no harm. In the motion what "
              "is exactly symmetric stays so: a small load to one side tells.",
          false};
}

/// Negative eigenvalues of the stiffness of a planar mechanism at the instant that is nearest.
int unstable_in_plane(const Analysis& analysis, double time) {
  const Trajectory& trajectory = analysis.trajectory;
  Eigen::Index nearest = 0;
  (trajectory.time.array() - time).abs().minCoeff(&nearest);
  State state;
  trajectory.states->load(static_cast<int>(nearest), state);
  return elastic_stability(analysis.model.mechanism, state).negative;
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
    const auto found = find_instability(
        space.scene, *analysis, [&](double time) { return unstable_in_plane(run.analysis, time); });
    if (!found) return {};
    return {found->is_new ? out_of_plane(found->text) : in_plane(found->text)};
  } catch (const UnstableEquilibrium& error) {
    return {out_of_plane(fmt::format("In space {}", error.what()))};
  } catch (const SimulationError& error) {
    return {not_simulated(pressed, error)};
  } catch (const InputError& error) {
    return {not_simulated(pressed, error)};
  }
}

}  // namespace pleuel
