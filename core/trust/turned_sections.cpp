#include "core/trust/turned_sections.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/beam/beam_place.hpp"
#include "core/response/make_responses.hpp"
#include "core/trust/beam_state.hpp"

namespace pleuel {

namespace {

/// Of the largest axial force; from where on it is another one.
constexpr double small_part = 0.02, serious_part = 0.1;
/// Of the shear force: smaller rotations make no difference to anything.
constexpr double small_rotation = 1e-3;

/// The shear forces across a beam at the place of a response.
Response shear_force(ResponseSettings settings, SectionForcePart part, const Model& model) {
  settings.section_part = part;
  return std::move(make_responses({settings}, model).front());
}

double largest_of(const Response& response, const State& state) {
  Signal& signal = *response.history()->signal;
  Eigen::VectorXd values(signal.channels());
  signal.observe(state, values);
  return values.lpNorm<Eigen::Infinity>();
}

/// What the rotation of a section makes of shear forces, at most, and the largest of these [N].
struct TurnedForce {
  double axial = 0.0, shear = 0.0;
};

TurnedForce turned_force(const TrustedRun& run, const ResponseSettings& settings,
                         const BodyModel& body) {
  constexpr int instants = 200;
  const Model& model = run.analysis.model;
  const Trajectory& trajectory = run.analysis.trajectory;
  const Response along_y = shear_force(settings, SectionForcePart::shear_y, model),
                 along_z = shear_force(settings, SectionForcePart::shear_z, model);
  const int node = find_place(body.beam, settings.station.value_or(settings.at)).node();
  TurnedForce largest;
  State state;
  for (int i = 0; i <= instants; ++i) {
    trajectory.states->load(i * trajectory.steps() / instants, state);
    const Eigen::VectorXd moved = nodal_displacements(body, state).col(node);
    const double y = largest_of(along_y, state), z = largest_of(along_z, state);
    largest.axial = std::max(largest.axial, y * std::abs(moved(5)) + z * std::abs(moved(4)));
    largest.shear = std::max({largest.shear, y, z});
  }
  return largest;
}

}  // namespace

std::vector<Doubt> doubt_turned_sections(const TrustedRun& run) {
  std::vector<Doubt> doubts;
  for (std::size_t i = 0; i < run.problem.responses.size(); ++i) {
    const ResponseSettings& settings = run.problem.responses[i];
    if (settings.type != ResponseType::section_force ||
        settings.section_part != SectionForcePart::axial) {
      continue;
    }
    const auto parts = run.analysis.model.parts(settings.bodies.front());
    // Each frame of a divided beam turns with its part.
    if (parts.size() != 1 || !parts.front()->is_beam() || !parts.front()->is_elastic) continue;
    const TurnedForce turned = turned_force(run, settings, *parts.front());
    const double axial = run.analysis.histories[i].lpNorm<Eigen::Infinity>();
    if (turned.axial <= small_part * axial || turned.axial <= small_rotation * turned.shear)
      continue;
    doubts.push_back(
        {fmt::format(
             "the axial force \"{}\" of \"{}\" is that along its body frame, {:.3g} N at most; "
             "the beam is bent, and its turned section takes up to {:.2g} N of the shear "
             "force of {:.3g} N besides. Divide the beam: \"frames\".",
             settings.name, settings.bodies.front(), axial, turned.axial, turned.shear),
         turned.axial > serious_part * axial,
         {settings.name}});
  }
  return doubts;
}

}  // namespace pleuel
