#include "core/trust/low_slenderness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/beam/beam_shape.hpp"
#include "core/model/resolve_beam.hpp"
#include "core/trust/beam_state.hpp"

namespace pleuel {

namespace {

/// Shares that change nothing by a percent, but for what is near a resonance.
constexpr double small_shear_share = 2e-3;
/// Planes that store less than this share of the energy of bending do not count.
constexpr double still_plane = 1e-6;
/// Rotations of a beam that are round-off [rad].
constexpr double straight_beam = 1e-11;

struct Energies {
  double bending = 0.0, shear = 0.0;  // [J]

  double share() const { return bending > 0.0 ? shear / bending : 0.0; }
};

/// One beam of a problem, whose sections say how stiff in shear it is.
class BeamStiffness {
 public:
  BeamStiffness(const ProblemFile& problem, const Eigen::VectorXd& x, const std::string& name)
      : design_(x.begin(), x.end()),
        beam_(std::get<BeamBody>(find_named(problem.scene.bodies, name)->shape)) {}

  /// EI [N m²] and κ G A [N] of an element in a plane.
  std::pair<double, double> of(const BodyModel& body, std::size_t element,
                               std::size_t plane) const {
    const BeamElement<double>& e = body.beam.elements[element];
    const Section& section = beam_.segments[body.mesh.elements[element].segment].section;
    const double nu = e.young / (2.0 * e.shear) - 1.0;
    const ShearArea<double> area = shear_area(section, e.section, nu, design_);
    return {e.young * (plane == 0 ? e.section.inertia_z : e.section.inertia_y),
            e.shear * (plane == 0 ? area.along_y : area.along_z)};
  }

  /// What bending stores in a body that is the beam or one of its frames, and shear would.
  Energies energies(const BodyModel& body, const State& state, std::size_t plane) const {
    const Eigen::MatrixXd nodal = nodal_displacements(body, state);
    Energies sum;
    for (std::size_t e = 0; e < body.beam.elements.size(); ++e) {
      const auto [stiffness, shear_stiffness] = of(body, e, plane);
      const double length = body.beam.elements[e].length;
      const ElementForm<double> form = form_of(body.beam.elements[e]);
      Eigen::Matrix<double, 12, 1> q;
      q << nodal.col(e), nodal.col(e + 1);
      const auto curvature = [&](double xi) {
        return (plane == 0 ? deflection_y_row(xi, form, 2) : deflection_z_row(xi, form, 2)).dot(q);
      };
      const double a = curvature(0.0), b = curvature(1.0);
      const double force = stiffness * (b - a) / length;
      sum.bending += stiffness * length * (a * a + a * b + b * b) / 6.0;
      sum.shear += 0.5 * length * force * force / shear_stiffness;
    }
    return sum;
  }

 private:
  Design<double> design_;
  const BeamBody& beam_;
};

/// Of half waves along the whole beam: π² EI/(κ G A L²), of the plane in which it is larger.
double share_by_proportions(const TrustedRun& run, const std::string& name) {
  const BeamStiffness stiffness(run.problem, run.x, name);
  double length = 0.0, largest = 0.0;
  for (const BodyModel* part : run.analysis.model.parts(name)) {
    for (std::size_t e = 0; e < part->beam.elements.size(); ++e) {
      length += part->beam.elements[e].length;
      for (const std::size_t plane : {0, 1}) {
        const auto [bending, shear] = stiffness.of(*part, e, plane);
        largest = std::max(largest, bending / shear);
      }
    }
  }
  return std::pow(std::numbers::pi / length, 2) * largest;
}

/// The most half waves that a frequency or a load of buckling of a problem is about; 0: none is
/// asked for.
int most_half_waves(const ProblemFile& problem) {
  int most = 0;
  for (const ResponseSettings& response : problem.responses) {
    const bool is_load =
        response.type == ResponseType::buckling || response.type == ResponseType::lateral_buckling;
    if (is_load) most = std::max(most, 1);
    if (response.type == ResponseType::frequency) most = std::max(most, response.mode.number + 1);
  }
  return most;
}

}  // namespace

double shear_share(const ProblemFile& problem, const Eigen::VectorXd& x, const Model& model,
                   const std::string& beam, const State& state) {
  const BeamStiffness stiffness(problem, x, beam);
  std::array<Energies, 2> planes;
  for (const BodyModel* part : model.parts(beam)) {
    for (const std::size_t plane : {0, 1}) {
      const Energies energies = stiffness.energies(*part, state, plane);
      planes[plane].bending += energies.bending;
      planes[plane].shear += energies.shear;
    }
  }
  const double all = planes[0].bending + planes[1].bending;
  double largest = 0.0;
  for (const Energies& one : planes) {
    if (one.bending > still_plane * all) largest = std::max(largest, one.share());
  }
  return largest;
}

std::vector<ConcernedBeam> find_slenderness(const TrustedRun& run) {
  const Model& model = run.analysis.model;
  const int half_waves = most_half_waves(run.problem);
  const auto& largest = largest_deformations(run);
  std::map<std::string, double> shares;
  State state;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const BodyModel& body = model.bodies[i];
    if (!body.is_beam() || !body.is_elastic) continue;
    const auto& beam = std::get<BeamBody>(find_named(run.problem.scene.bodies, body.name)->shape);
    if (beam.has_shear) continue;
    double& share = shares[body.name];  // of a divided beam, with each frame where this bends most
    if (half_waves > 0) {
      share = std::max(share, half_waves * half_waves * share_by_proportions(run, body.name));
    }
    if (largest[i].bending <= straight_beam) continue;
    run.analysis.trajectory.states->load(largest[i].bending_step, state);
    share = std::max(share, shear_share(run.problem, run.x, model, body.name, state));
  }
  std::vector<ConcernedBeam> found;
  for (const auto& [name, share] : shares) {
    if (share > small_shear_share) found.push_back({name, share});
  }
  std::ranges::stable_sort(found, std::ranges::greater(), &ConcernedBeam::indicator);
  return found;
}

}  // namespace pleuel
