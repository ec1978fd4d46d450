#include "core/trust/bent_beams.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/base/number_text.hpp"
#include "core/beam/beam_shape.hpp"
#include "core/model/resolve_beam.hpp"

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
    if (response.is<BucklingResponse, LateralBucklingResponse>()) most = std::max(most, 1);
    const auto* one = response.as<ModeResponse>();
    const bool is_frequency = one != nullptr && one->mode.of == ModeNumber::frequency;
    if (is_frequency) most = std::max(most, one->mode.number + 1);
  }
  return most;
}

}  // namespace

Eigen::MatrixXd nodal_displacements(const BodyModel& body, const State& state) {
  const auto q = state.q.segment(body.elastic_offset(), body.elastic_size());
  return body.places.displacements(q);
}

double elongation_of(const BodyModel& body, const Eigen::MatrixXd& nodal, int element) {
  const auto from = nodal.col(element), to = nodal.col(element + 1);
  const double linear = to(0) - from(0);
  if (!body.has_stiffening) return linear;
  const ElementForm<double> form = form_of(body.beam.elements[element]);
  const auto along = [&](double moved, double first, double last, double shear) {
    // The slopes of the axis are by γ steeper than the sections are turned.
    const double angle = shear * (moved / form.length - 0.5 * (first + last));
    return slope_integral<double>(moved, first + angle, last + angle, form.length);
  };
  return linear + 0.5 * (along(to(1) - from(1), from(5), to(5), form.shear_y) +
                         along(to(2) - from(2), -from(4), -to(4), form.shear_z));
}

namespace {

void keep_bending(double value, int step, LargestDeformation& largest) {
  if (value <= largest.bending) return;
  largest.bending = value;
  largest.bending_step = step;
}

void record_beam(const BodyModel& body, const State& state, int step, LargestDeformation& largest) {
  const Eigen::MatrixXd nodal = nodal_displacements(body, state);
  const double bending = std::sqrt(nodal.bottomRows(2).colwise().squaredNorm().maxCoeff());
  keep_bending(bending, step, largest);
  largest.twist = std::max(largest.twist, nodal.row(3).cwiseAbs().maxCoeff());
  if (nodal.row(0).isZero(0.0)) return;
  for (int e = 0; e + 1 < nodal.cols(); ++e) {
    const double length = body.beam.elements[e].length;
    largest.strain = std::max(largest.strain, std::abs(elongation_of(body, nodal, e)) / length);
  }
}

void record_imported(const BodyModel& body, const State& state, int step,
                     LargestDeformation& largest) {
  const double turned = nodal_displacements(body, state).bottomRows(3).colwise().norm().maxCoeff();
  keep_bending(turned, step, largest);
}

}  // namespace

void record_deformation(const BodyModel& body, const State& state, int step,
                        LargestDeformation& largest) {
  if (!body.is_elastic || body.elastic_size() == 0) return;
  if (body.is_imported()) {
    record_imported(body, state, step, largest);
  } else {
    record_beam(body, state, step, largest);
  }
}

namespace {

std::vector<LargestDeformation> find_largest(const Model& model, const Trajectory& trajectory) {
  std::vector<LargestDeformation> all(model.bodies.size());
  for (int step = 0; step <= trajectory.steps(); ++step) {
    const State state = trajectory.state_at(step);
    for (std::size_t i = 0; i < all.size(); ++i) {
      record_deformation(model.bodies[i], state, step, all[i]);
    }
  }
  return all;
}

}  // namespace

const std::vector<LargestDeformation>& largest_deformations(const TrustedRun& run) {
  auto& found = run.shared->deformations;
  if (!found) found = find_largest(run.analysis.model, run.analysis.trajectory);
  return *found;
}

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
    const State state = run.analysis.trajectory.state_at(largest[i].bending_step);
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
