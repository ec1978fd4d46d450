#include "core/trust/beam_state.hpp"

#include <cmath>

#include "core/base/eager_matrices.hpp"
#include "core/beam/beam_shape.hpp"

namespace pleuel {

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

void keep_larger(double value, int step, double& largest, int& at) {
  if (value <= largest) return;
  largest = value;
  at = step;
}

void record_beam(const BodyModel& body, const State& state, int step, LargestDeformation& largest) {
  const Eigen::MatrixXd nodal = nodal_displacements(body, state);
  const double bending = std::sqrt(nodal.bottomRows(2).colwise().squaredNorm().maxCoeff());
  keep_larger(bending, step, largest.bending, largest.bending_step);
  keep_larger(nodal.row(3).cwiseAbs().maxCoeff(), step, largest.twist, largest.twist_step);
  if (nodal.row(0).isZero(0.0)) return;
  for (int e = 0; e + 1 < nodal.cols(); ++e) {
    const double length = body.beam.elements[e].length;
    keep_larger(std::abs(elongation_of(body, nodal, e)) / length, step, largest.strain,
                largest.strain_step);
  }
}

void record_imported(const BodyModel& body, const State& state, int step,
                     LargestDeformation& largest) {
  const double turned = nodal_displacements(body, state).bottomRows(3).colwise().norm().maxCoeff();
  keep_larger(turned, step, largest.bending, largest.bending_step);
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
  State state;
  for (int step = 0; step <= trajectory.steps(); ++step) {
    trajectory.states->load(step, state);
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

}  // namespace pleuel
