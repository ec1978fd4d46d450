#include "core/trust/far_bending.hpp"

#include <algorithm>
#include <functional>
#include <map>

#include <fmt/format.h>

#include "core/base/find_named.hpp"
#include "core/base/number_text.hpp"
#include "core/trust/beam_state.hpp"

namespace pleuel {

namespace {

/// Errors that are as good as none, relative.
constexpr double tolerable_error = 0.01;
/// Rotations that cannot change anything by that [rad]: errors grow as the square of bending, but as
/// the first power of twist, which turns the axes of bending where there is any.
constexpr double small_bending = 0.05, small_twist = 0.004, no_bending = 1e-3;
/// Of the deflection of a cantilever under a force at its tip, 0.45 θ² is missed; of others less.
constexpr double error_per_square = 0.45;

/// The same body of the scene, of all of its frames what deforms most: in the motion, and in the
/// equilibrium about which natural frequencies are those of small vibrations.
std::map<std::string, LargestDeformation> largest_of_bodies(const TrustedRun& run) {
  const Model& model = run.analysis.model;
  const auto& largest = largest_deformations(run);
  std::map<std::string, LargestDeformation> of_bodies;
  for (std::size_t i = 0; i < largest.size(); ++i) {
    const BodyModel& body = model.bodies[i];
    if (!body.is_elastic || body.elastic_size() == 0) continue;
    LargestDeformation& most = of_bodies[body.name];
    most.bending = std::max(most.bending, largest[i].bending);
    most.twist = std::max(most.twist, largest[i].twist);
    most.strain = std::max(most.strain, largest[i].strain);
  }
  const Analysis& analysis = run.analysis;
  if (!analysis.vibrating) return of_bodies;
  for (const BodyModel& body : model_of_modes(analysis).bodies) {
    if (!body.is_elastic) continue;
    record_deformation(body, analysis.vibrating->initial.state, 0, of_bodies[body.name]);
  }
  return of_bodies;
}

double indicator_of(const LargestDeformation& most) {
  const double by_twist = most.bending > no_bending ? most.twist / small_twist : 0.0;
  return std::max(most.bending / small_bending, by_twist);
}

bool is_beam(const ProblemFile& problem, const std::string& name) {
  return std::holds_alternative<BeamBody>(find_named(problem.scene.bodies, name)->shape);
}

bool can_be_divided(const ProblemFile& problem, const std::string& name) {
  const auto is_none = [](const Number& number) {
    return !number.is_bound() && number.constant == 0.0;
  };
  const auto* beam = std::get_if<BeamBody>(&find_named(problem.scene.bodies, name)->shape);
  return beam != nullptr && is_none(beam->damping.mass) && is_none(beam->damping.modal);
}

Finding stretched(const std::string& body, double strain) {
  return {fmt::format(
              "\"{}\" is stretched by {:.2g} %: linear elasticity is for small strains, and is off "
              "by as much. Do not trust these numbers; a stiffer member or smaller loads keep "
              "within it.",
              body, 100.0 * strain),
          true};
}

Finding bent(const std::string& body, double rotation, double error, const std::string& why) {
  return {fmt::format(
              "\"{}\" deforms until it has turned by {:.3g} rad against its frame: too far for "
              "linear elasticity, which is off by some {} there. Do not trust these numbers: more "
              "\"frames\" would help, but {}.",
              body, rotation, rough_percent(error), why),
          true};
}

}  // namespace

std::vector<ConcernedBeam> find_far_bending(const TrustedRun& run) {
  std::vector<ConcernedBeam> found;
  for (const auto& [name, most] : largest_of_bodies(run)) {
    const double indicator = indicator_of(most);
    if (indicator > 1.0 && can_be_divided(run.problem, name)) found.push_back({name, indicator});
  }
  std::ranges::stable_sort(found, std::ranges::greater(), &ConcernedBeam::indicator);
  return found;
}

std::vector<Finding> check_untold_bending(const TrustedRun& run,
                                          const std::vector<std::string>& bodies,
                                          const std::string& why) {
  std::vector<Finding> findings;
  for (const auto& [name, most] : largest_of_bodies(run)) {
    const double error = error_per_square * most.bending * most.bending;
    const bool is_meant = std::ranges::find(bodies, name) != bodies.end();
    if (is_meant && error > tolerable_error)
      findings.push_back(bent(name, most.bending, error, why));
  }
  return findings;
}

std::vector<Finding> check_linear_elasticity(const TrustedRun& run) {
  std::vector<Finding> findings;
  std::vector<std::string> imported, damped;
  for (const auto& [name, most] : largest_of_bodies(run)) {
    if (most.strain > tolerable_error) {
      findings.push_back(stretched(name, most.strain));
    } else if (!is_beam(run.problem, name)) {
      imported.push_back(name);
    } else if (!can_be_divided(run.problem, name)) {
      damped.push_back(name);
    }
  }
  const auto add = [&](const std::vector<std::string>& bodies, const char* why) {
    const std::vector<Finding> more = check_untold_bending(run, bodies, why);
    findings.insert(findings.end(), more.begin(), more.end());
  };
  add(imported, "this body is from a file: import it in several, joined by fixed joints");
  add(damped, "its damping is of the motion against one of them: damp it by \"stiffness\" only");
  return findings;
}

}  // namespace pleuel
