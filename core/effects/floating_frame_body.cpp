#include "core/effects/floating_frame_body.hpp"

#include <limits>

#include "core/beam/invariants.hpp"
#include "core/effects/body_equations.hpp"
#include "core/effects/make_body_equations.hpp"

namespace pleuel {

namespace {

/// What a virtual displacement μ of a body multiplies its inertia, elastic and damping forces with.
struct BodyMultipliers {
  Eigen::Vector3d force;                      ///< of f, body axes
  Eigen::Vector3d moment;                     ///< of T, body axes
  Eigen::Ref<const Eigen::VectorXd> elastic;  ///< of F (n)
};

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// of_y: the derivative of μᵀR with respect to y.
struct BodyAdjoint {
  Matrix3d N, M, B;
  Vector3d c, shape_v;

  // The adjoint of axial() is −skew().
  BodyAdjoint(const BodyMotion& p, const BodyMultipliers& mu)
      : N(-skew<double>(mu.moment)),
        M(N * p.X),
        B(N * p.Y),
        c(p.X.transpose() * mu.force + N * p.a0),
        shape_v(p.Y.transpose() * mu.force) {}
};

/// `Pairs` is the number of pairs (k, l) where the compiler may know it.
template <int Pairs>
void add_sums(const Invariants<double>& body, const InvariantLayout& layout, const BodyMotion& p,
              const BodyMultipliers& mu, double* sums) {
  using Row = Eigen::Matrix<double, Pairs, 1, 0, Pairs == Eigen::Dynamic ? 9 : Pairs, 1>;
  const BodyAdjoint of(p, mu);
  const Eigen::Index pairs = body.pairs.size();
  Row of_moment_q(pairs), of_moment_v(pairs);
  double* of_shape = layout.shape(sums).data();
  double* of_mixed = layout.mixed(sums).data();
  double* of_mass_matrix = layout.mass_matrix(sums).data();
  double* of_stiffness = layout.stiffness(sums).data();
  double* of_damping = layout.damping(sums).data();
  for (int i = 0; i < body.size(); ++i) {
    const double q = p.q(i), v = p.v(i), a = p.a(i), e = mu.elastic(i);
    Eigen::Map<Vector3d>(of_shape + 3 * i) += q * of.c + v * of.shape_v + a * mu.force + e * p.a0;
    // W_kl = H_kl + S_kl q, and the H_lk that stands beside it in M; in rows k, by columns.
    const Matrix3d of_W =
        q * of.M.transpose() + v * of.B.transpose() + a * of.N.transpose() + e * p.X;
    Eigen::Map<Matrix3d>(of_mixed + 9 * i) += of_W + q * of.M;
    for (Eigen::Index pair = 0; pair < pairs; ++pair) {
      const auto [k, l] = body.pairs[pair];
      of_moment_q(pair) = of_W(k, l);
      of_moment_v(pair) = e * p.Y(k, l);
    }
    for (int entry = body.pattern.row_start[i]; entry < body.pattern.row_start[i + 1]; ++entry) {
      const int j = body.pattern.column[entry];
      Eigen::Map<Row>(layout.moments(sums, entry), pairs) +=
          p.q(j) * of_moment_q + p.v(j) * of_moment_v;
      of_mass_matrix[entry] += e * p.a(j);
      of_stiffness[entry] += e * p.q(j);
      of_damping[entry] += e * p.v(j);
    }
  }
  layout.mass(sums) += mu.force.dot(p.a0);
  layout.first_moment(sums) += of.c;
  layout.second_moment(sums) += of.M;
}

/// sums += ∂(μᵀR)/∂I: the residual of a body (general_body_equations.hpp) is linear in its
/// invariants, μᵀR = Σ sums · I. The same chain of formulas, backwards.
/// @param layout    of the body's invariants; `sums` has so many entries
/// @param motion    of the body
void add_invariant_sums(const Invariants<double>& body, const InvariantLayout& layout,
                        const BodyMotion& motion, const BodyMultipliers& mu, double* sums) {
  switch (body.pairs.size()) {
    case 4:
      return add_sums<4>(body, layout, motion, mu, sums);  // planar motion
    case 9:
      return add_sums<9>(body, layout, motion, mu, sums);  // spatial motion
    default:
      return add_sums<Eigen::Dynamic>(body, layout, motion, mu, sums);
  }
}

}  // namespace

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
