#include "core/trust/bending_range.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/trust/beam_state.hpp"
#include "core/trust/geometric_error.hpp"

namespace pleuel {

namespace {

/// Errors that are as good as none, relative.
constexpr double tolerable_bending = 0.01;
/// Deformations that cannot be more than half of that off: errors grow as the square of rotations
/// by bending, but as the first power of twist, which turns the axes of bending.
constexpr double small_bending = 0.05, small_twist = 0.004, small_strain = 0.005;
/// Of the deflection of a cantilever under a force at its tip, 0.45 θ² is missed; others less.
constexpr double error_per_square = 0.45;

/// What is known of one body of the scene.
struct Finding {
  double rotation = 0.0;  ///< [rad]
  GeometricError error;
  bool is_imported = false;
};

GeometricError error_at(const TrustedRun& run, const BodyModel& body, int step) {
  State state;
  run.analysis.trajectory.states->load(step, state);
  return estimate_geometric_error(body, nodal_displacements(body, state));
}

Finding find_in(const TrustedRun& run, const BodyModel& body, const LargestDeformation& largest) {
  Finding finding{std::hypot(largest.bending, largest.twist), {}, body.is_imported()};
  if (body.is_imported()) {
    finding.error.deflection = error_per_square * largest.bending * largest.bending;
    return finding;
  }
  std::set<int> steps;  // without those of next to no deformation: there errors are round-off
  if (largest.bending >= small_bending) steps.insert(largest.bending_step);
  if (largest.twist >= small_twist) steps.insert(largest.twist_step);
  if (largest.strain >= small_strain) steps.insert(largest.strain_step);
  for (int step : steps) {
    const GeometricError error = error_at(run, body, step);
    if (error.largest() > finding.error.largest()) finding.error = error;
  }
  return finding;
}

/// Errors fall as the square of the number of frames.
int frames_for(double error, std::size_t frames) {
  constexpr double reserve = 1.1, most = 10.0;
  const double factor = reserve * std::sqrt(std::min(error, most) / tolerable_bending);
  return static_cast<int>(std::ceil(static_cast<double>(frames) * factor));
}

std::string rounded_percent(double share) {
  return share < 1.0 ? fmt::format("some {:.2g} %", 100.0 * share) : "100 % or more";
}

std::string sentence(const std::string& body, const Finding& finding, std::size_t frames) {
  const GeometricError& error = finding.error;
  const double most = error.largest();
  if (error.strain == most) {
    return fmt::format(
        "\"{}\" is stretched by {:.2g} %: linear elasticity is for small strains, and is off by "
        "as much. Do not trust these numbers; a stiffer member or smaller loads keep within it.",
        body, 100.0 * most);
  }
  const std::string what = fmt::format(
      "\"{}\" deforms until it has turned by {:.3g} rad against its frame: too far for linear "
      "elasticity, which is {} off there ({}).",
      body, finding.rotation, rounded_percent(most), error.most());
  if (finding.is_imported) {
    return what +
           " Do not trust these numbers; import it in several bodies, joined by fixed joints.";
  }
  return fmt::format("{} Do not trust these numbers; divide it: \"frames\": {}.", what,
                     frames_for(most, frames));
}

}  // namespace

std::vector<Doubt> doubt_bending_range(const TrustedRun& run) {
  const Model& model = run.analysis.model;
  const auto largest = largest_deformations(model, run.analysis.trajectory);
  std::map<std::string, Finding> worst;  // of its frames
  for (std::size_t i = 0; i < largest.size(); ++i) {
    const BodyModel& body = model.bodies[i];
    if (!body.is_elastic || body.elastic_size() == 0) continue;
    const Finding finding = find_in(run, body, largest[i]);
    Finding& known = worst[body.name];
    if (finding.error.largest() >= known.error.largest()) known = finding;
  }
  std::vector<Doubt> doubts;
  for (const auto& [body, finding] : worst) {
    if (finding.error.largest() <= tolerable_bending) continue;
    doubts.push_back({sentence(body, finding, model.parts(body).size()), true});
  }
  return doubts;
}

}  // namespace pleuel
