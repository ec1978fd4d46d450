#include "core/effects/floating_frame_body.hpp"

#include <limits>

#include "core/effects/invariant_sums.hpp"
#include "core/effects/make_body_equations.hpp"

namespace pleuel {

using Eigen::Vector3d;

FloatingFrameBody::FloatingFrameBody(
    std::string name, BodyFrame frame, Invariants<double> invariants,
    const std::vector<DesignDerivative<Invariants<double>>>& derivatives, const Vector3d& gravity)
    : name_(std::move(name)),
      frame_(std::move(frame)),
      invariants_(std::move(invariants)),
      layout_(invariants_),
      gravity_(gravity),
      equations_(make_body_equations(frame_, invariants_)) {
  evaluated_.setConstant(frame_.size() + invariants_.size(), 3,
                         std::numeric_limits<double>::quiet_NaN());
  flat_derivatives_.resize(layout_.size(), derivatives.size());
  derivatives_.reserve(derivatives.size());
  for (const auto& [variable, data] : derivatives) {
    flat_derivatives_.col(variables_.size()) = layout_.flatten(data).sparseView();
    variables_.push_back(variable);
    PartialInvariants partial = without_zeros(data);
    derivatives_.push_back({variable,
                            std::move(partial.coordinates),
                            make_derivative_forces(frame_, std::move(partial.data)),
                            {},
                            {}});
  }
}

void FloatingFrameBody::declare_entries(EntryList& entries) const {
  declare_body_entries(frame_, invariants_.pattern, entries);
}

/// Nothing is left to do at the state evaluated last.
void FloatingFrameBody::evaluate(const State& state) {
  const int size = frame_.size() + invariants_.size(), first = frame_.offset;
  const auto q = state.q.segment(first, size), v = state.v.segment(first, size),
             a = state.a.segment(first, size);
  if (evaluated_.col(0) == q && evaluated_.col(1) == v && evaluated_.col(2) == a) return;
  evaluated_ << q, v, a;
  set_body_motion(frame_, gravity_, q, v, a, motion_);
  equations_->evaluate(motion_);
}

void FloatingFrameBody::add_residual(const State& state, ConstraintLevel,
                                     Eigen::VectorXd& residual) {
  evaluate(state);
  equations_->add_forces(motion_, residual);
}

/// Forces of dI/dx at the state evaluated last.
void FloatingFrameBody::evaluate(Derivative& derivative) {
  derivative.elastic.q = motion_.q(derivative.coordinates);
  derivative.elastic.v = motion_.v(derivative.coordinates);
  derivative.elastic.a = motion_.a(derivative.coordinates);
  derivative.of_invariants->set_forces(motion_, derivative.elastic, derivative.forces);
}

void FloatingFrameBody::add_design_derivative(const State& state, ConstraintLevel,
                                              Eigen::MatrixXd& columns) {
  evaluate(state);
  const int m = frame_.size();
  for (Derivative& derivative : derivatives_) {
    evaluate(derivative);
    auto column = columns.col(derivative.variable);
    column.segment(frame_.offset, m) += derivative.forces.head(m);
    for (std::size_t i = 0; i < derivative.coordinates.size(); ++i) {
      column(frame_.offset + m + derivative.coordinates[i]) +=
          derivative.forces(m + static_cast<Eigen::Index>(i));
    }
  }
}

void FloatingFrameBody::add_parameter_adjoints(const State& state, ConstraintLevel,
                                               const ConstColumns& mu, Columns sums) {
  if (!is_designed()) return;
  evaluate(state);
  const int k = frame_.translations(), rotations = frame_.rotations();
  for (Eigen::Index i = 0; i < mu.cols(); ++i) {
    const auto of_body = mu.col(i).segment(frame_.offset, frame_.size() + invariants_.size());
    const Vector3d force = motion_.frame.A.transpose() * (frame_.basis * of_body.head(k));
    const Vector3d moment = motion_.frame.G.leftCols(rotations) * of_body.segment(k, rotations);
    add_invariant_sums(invariants_, layout_, motion_,
                       {force, moment, of_body.tail(invariants_.size())}, sums.col(i).data());
  }
}

void FloatingFrameBody::add_design_gradients(const ConstColumns& sums,
                                             Eigen::MatrixXd& gradients) const {
  if (!is_designed()) return;
  const Eigen::MatrixXd found = flat_derivatives_.transpose() * sums;
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    gradients.row(variables_[i]) += found.row(i);
  }
}

void FloatingFrameBody::linearize(const State& state, const WeightList& weights,
                                  ConstraintLevel level, Eigen::VectorXd& residual,
                                  const EntryBlocks& entries) {
  add_residual(state, level, residual);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    equations_->write_tangent(motion_, weights[i], entries.block(i));
  };
}

}  // namespace pleuel
