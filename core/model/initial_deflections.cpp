#include "core/model/initial_deflections.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <fmt/format.h>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/model/attachment.hpp"
#include "core/model/elastic_builders.hpp"
#include "core/model/model.hpp"
#include "core/system/term.hpp"

namespace pleuel {

namespace {

/// The stiffness of a body, elastic coordinates × elastic coordinates.
Eigen::SparseMatrix<double> stiffness_of(const Invariants<double>& invariants) {
  const ElasticPattern& pattern = invariants.pattern;
  std::vector<Eigen::Triplet<double>> entries;
  for (int row = 0; row < pattern.size; ++row) {
    for (int k = pattern.row_start[row]; k < pattern.row_start[row + 1]; ++k) {
      entries.emplace_back(row, pattern.column[k], invariants.stiffness(k));
    }
  }
  Eigen::SparseMatrix<double> matrix(pattern.size, pattern.size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Elastic forces of a body against its frame, with geometric stiffening where it has it, and their
/// derivatives; elastic coordinates alone.
class ElasticForces {
 public:
  /// @param model  must outlive this
  /// @param size   of the state of the mechanism
  ElasticForces(const BodyModel& model, const State& size)
      : model_(model), linear_(stiffness_of(model.invariants)), state_(size) {
    state_.q.setZero();
    state_.v.setZero();
    if (!model.has_stiffening) return;
    stiffening_ = make_stiffening(model);
    stiffening_->declare_entries(places_);
  }

  /// K.
  const Eigen::SparseMatrix<double>& linear() const { return linear_; }
  void set(const Eigen::VectorXd& q) { state_.q.segment(model_.elastic_offset(), q.size()) = q; }

  Eigen::VectorXd forces() {
    const Eigen::VectorXd q = elastic(state_.q);
    Eigen::VectorXd sum = linear_ * q;
    if (!stiffening_) return sum;
    Eigen::VectorXd residual = Eigen::VectorXd::Zero(state_.q.size() + state_.lambda.size());
    stiffening_->add_residual(state_, ConstraintLevel::position, residual);
    return sum + elastic(residual);
  }

  Eigen::SparseMatrix<double> tangent() {
    if (!stiffening_) return linear_;
    Eigen::VectorXd values(places_.size());
    stiffening_->write_tangent(state_, {.q = 1.0}, ConstraintLevel::position, values.data());
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t k = 0; k < places_.size(); ++k) {
      entries.emplace_back(places_[k].first - model_.elastic_offset(),
                           places_[k].second - model_.elastic_offset(), values(k));
    }
    Eigen::SparseMatrix<double> matrix(linear_.rows(), linear_.cols());
    matrix.setFromTriplets(entries.begin(), entries.end());
    return linear_ + matrix;
  }

  /// By all design variables, at fixed coordinates: n × variables.
  Eigen::MatrixXd design_derivatives(int variables) {
    Eigen::MatrixXd columns =
        Eigen::MatrixXd::Zero(state_.q.size() + state_.lambda.size(), variables);
    if (stiffening_) {
      stiffening_->add_design_derivative(state_, ConstraintLevel::position, columns);
    }
    Eigen::MatrixXd sum = columns.middleRows(model_.elastic_offset(), model_.elastic_size());
    const Eigen::VectorXd q = elastic(state_.q);
    for (const auto& [variable, change] : model_.invariants_x) {
      sum.col(variable) += stiffness_of(change) * q;
    }
    return sum;
  }

 private:
  Eigen::VectorXd elastic(const Eigen::VectorXd& all) const {
    return all.segment(model_.elastic_offset(), model_.elastic_size());
  }

  const BodyModel& model_;
  Eigen::SparseMatrix<double> linear_;
  State state_;
  std::unique_ptr<Term> stiffening_;
  EntryList places_;
};

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Newton's steps that no longer fall below this share of the shape are round-off.
constexpr double stalled_step = 1e-6;
/// Where places are held in the assembly they weigh as much as so many times the stiffest coordinate.
constexpr double held_place = 1e3;

/// What the file gives: a row each, and the displacements and rates along them.
struct GivenDeflections {
  MatrixXd rows;      ///< S, places × elastic coordinates
  MatrixXd measures;  ///< d, ḋ: places × 2
};

/// Solves  A x − Sᵀ μ = f,  S x = d  for several right-hand sides.
class HeldShape {
 public:
  HeldShape(const Eigen::SparseMatrix<double>& matrix, const MatrixXd& rows)
      : rows_(rows), factors_(matrix) {
    by_pull_ = factors_.solve(MatrixXd(rows.transpose()));
    compliance_.emplace(rows * by_pull_);
  }

  struct Solution {
    MatrixXd x, pulls;
  };
  Solution solve(const MatrixXd& f, const MatrixXd& d) const {
    const MatrixXd free = factors_.solve(f);
    const MatrixXd pulls = compliance_->solve(d - rows_ * free);
    return {free + by_pull_ * pulls, pulls};
  }
  /// What the places move by unit pulls on them: S A⁻¹ Sᵀ.
  MatrixXd compliance() const { return rows_ * by_pull_; }

 private:
  MatrixXd rows_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
  MatrixXd by_pull_;
  std::optional<DenseLu> compliance_;
};

class InitialShape {
 public:
  InitialShape(std::size_t body, const std::vector<BodyModel>& bodies, const BuildContext& context,
               const State& size)
      : context_(context),
        body_(context.scene.bodies[body]),
        model_(bodies[body]),
        elastic_(model_, size) {
    for (const InitialDeflection& one : body_.initial_deflections) {
      places_.emplace_back(body_.name, one.at, bodies, context);
    }
    given_ = given();
    const MatrixXd none = MatrixXd::Zero(model_.elastic_size(), 1);
    linear_.emplace(elastic_.linear(), given_.rows);
    require_independence(linear_->compliance());
    rate_ = linear_->solve(none, given_.measures.col(1));
    find_shape(linear_->solve(none, given_.measures.col(0)));
  }

  /// What the weights of the assembly are made with.
  struct Scale {
    double factor;  ///< of the stiffness
    VectorXd held;  ///< besides, on the diagonal: places are held
  };
  /// @param weight  of the softest of the given displacements
  Scale scale(double weight) const {
    const MatrixXd& rows = given_.rows;
    const double stiffness = linear_->compliance().diagonal().cwiseInverse().minCoeff();
    const double factor = weight / stiffness;
    const double stiffest = factor * elastic_.linear().diagonal().maxCoeff();
    return {factor, held_place * stiffest * rows.cwiseAbs2().colwise().sum().transpose()};
  }

  /// @param scale  of the start: weights differ between designs as the stiffness does
  BentStart start(const Scale& scale) const {
    BentStart bent{model_.elastic_offset(), scale.factor * elastic_.linear(), {}, given_.rows};
    for (Eigen::Index i = 0; i < scale.held.size(); ++i) {
      if (scale.held(i) > 0.0) bent.weight.coeffRef(i, i) += scale.held(i);
    }
    for (const auto& [variable, change] : model_.invariants_x) {
      bent.weight_x.emplace_back(variable, scale.factor * stiffness_of(change));
    }
    return bent;
  }

  VectorXd shape() const { return shape_.x; }
  VectorXd rate() const { return rate_.x; }

  /// Of shape and rate, n × 2 each, one a variable:
  ///     K_T q' − Sᵀ μ' = S'ᵀ μ − f_x,   S q' = d' − S' q
  std::vector<MatrixXd> derivatives(const std::set<int>& variables) {
    const MatrixXd of_forces = elastic_.design_derivatives(context_.variables());
    std::vector<MatrixXd> result;
    for (const int variable : variables) {
      const GivenDeflections change = given_change(variable);
      MatrixXd both(model_.elastic_size(), 2);
      both.col(0) = tangent_
                        ->solve(change.rows.transpose() * shape_.pulls - of_forces.col(variable),
                                change.measures.col(0) - change.rows * shape_.x)
                        .x;
      both.col(1) = linear_
                        ->solve(change.rows.transpose() * rate_.pulls - stiffness_change(variable),
                                change.measures.col(1) - change.rows * rate_.x)
                        .x;
      result.push_back(std::move(both));
    }
    return result;
  }

 private:
  static Eigen::Vector3d direction_of(const InitialDeflection& one) {
    return {one.direction[0], one.direction[1], one.direction[2]};
  }

  /// A displacement u v w of a place, local axes, from the elastic coordinates of the body.
  MatrixXd widened(const Attachment::Rows& rows, const MatrixXd& values) const {
    MatrixXd wide = MatrixXd::Zero(3, model_.elastic_size());
    for (std::size_t k = 0; k < rows.coordinates.size(); ++k) {
      wide.col(rows.coordinates[k] - model_.elastic_offset()) = values.col(k).head<3>();
    }
    return wide;
  }

  GivenDeflections none() const {
    const Eigen::Index count = places_.size();
    return {MatrixXd::Zero(count, model_.elastic_size()), MatrixXd::Zero(count, 2)};
  }

  GivenDeflections given() const {
    GivenDeflections result = none();
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const InitialDeflection& one = body_.initial_deflections[i];
      const Eigen::Index row = i;
      const Attachment::Rows& rows = places_[i].displacement_rows();
      const Eigen::Vector3d local = places_[i].local_direction(direction_of(one), context_.design);
      result.rows.row(row) = local.transpose() * widened(rows, rows.values);
      result.measures(row, 0) = resolve(one.displacement, context_.design);
      result.measures(row, 1) = resolve(one.rate, context_.design);
    }
    return result;
  }

  GivenDeflections given_change(int variable) const {
    GivenDeflections result = none();
    const Design<Dual> seeded = context_.seeded(variable);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const InitialDeflection& one = body_.initial_deflections[i];
      const Eigen::Index row = i;
      const Attachment::Rows& rows = places_[i].displacement_rows();
      const Vector3<Dual> turning = places_[i].local_direction(direction_of(one), seeded);
      const Eigen::Vector3d local = places_[i].local_direction(direction_of(one), context_.design);
      result.rows.row(row) = derivative_matrix(turning).transpose() * widened(rows, rows.values);
      for (const auto& [of, change] : rows.derivatives) {
        if (of == variable) result.rows.row(row) += local.transpose() * widened(rows, change);
      }
      result.measures(row, 0) = derivative_of(resolve(one.displacement, seeded));
      result.measures(row, 1) = derivative_of(resolve(one.rate, seeded));
    }
    return result;
  }

  /// Of compliances C between the places: none is zero, and their correlations are not singular.
  void require_independence(const MatrixXd& compliance) const {
    const VectorXd own = compliance.diagonal();
    for (Eigen::Index i = 0; i < own.size(); ++i) {
      if (own(i) > 1e-12 * own.maxCoeff() && own(i) > 0.0) continue;
      fail(i,
           "cannot be: the frame of the body holds the place in this direction, or effects left "
           "out keep it from moving");
    }
    const VectorXd scale = own.cwiseSqrt().cwiseInverse();
    MatrixXd correlation = scale.asDiagonal() * compliance * scale.asDiagonal();
    for (Eigen::Index i = 1; i < own.size(); ++i) {
      if (symmetric_eigenvalues(correlation.topLeftCorner(i + 1, i + 1))(0) > 1e-10) continue;
      fail(i, "says the same as those before it, or contradicts them");
    }
  }

  [[noreturn]] void fail(std::size_t i, const char* why) const {
    throw InputError(fmt::format("/scene/bodies/{}/initial_deflections/{} {}", body_.name, i, why));
  }

  /// By Newton's method from the linear shape: a bent beam is shorter, without axial force.
  void find_shape(HeldShape::Solution start) {
    constexpr int most_iterations = 30;
    shape_ = std::move(start);
    double size = 0.0, before = std::numeric_limits<double>::infinity();
    for (int i = 0; i < most_iterations; ++i) {
      elastic_.set(shape_.x);
      tangent_.emplace(elastic_.tangent(), given_.rows);
      const HeldShape::Solution step =
          tangent_->solve(given_.rows.transpose() * shape_.pulls - elastic_.forces(),
                          given_.measures.col(0) - given_.rows * shape_.x);
      shape_.x += step.x;
      shape_.pulls += step.pulls;
      size = std::max(size, shape_.x.norm());
      // Steps end in round-off: of bending, the condition of the stiffness makes it more than 1e-13.
      const double moved = step.x.norm();
      const bool is_stalled = moved <= stalled_step * size && moved > 0.3 * before;
      if (moved <= 1e-13 * size || is_stalled) {
        elastic_.set(shape_.x);
        return;
      }
      before = moved;
    }
    throw InputError(fmt::format(
        "/scene/bodies/{}/initial_deflections: no shape with these deflections was found; are they "
        "too large?",
        body_.name));
  }

  VectorXd stiffness_change(int variable) const {
    for (const auto& [of, change] : model_.invariants_x) {
      if (of == variable) return stiffness_of(change) * rate_.x;
    }
    return VectorXd::Zero(model_.elastic_size());
  }

  const BuildContext& context_;
  const Body& body_;
  const BodyModel& model_;
  ElasticForces elastic_;
  std::vector<Attachment> places_;
  GivenDeflections given_;
  std::optional<HeldShape> linear_, tangent_;
  HeldShape::Solution shape_, rate_;
};

}  // namespace

namespace {

/// @param weight  of the softest of the given displacements
InitialShape::Scale scale_at_start(std::size_t body, std::size_t bodies,
                                   const BuildContext& context, const State& size, double weight) {
  const BuildContext start{context.scene,           context.effects,     context.start,
                           context.start,           context.plane,       context.gravity,
                           context.differentiation, context.beam_effects};
  std::vector<BodyModel> models(bodies);
  const int offset = 0;
  models[body] = make_body_model(context.scene.bodies[body], start, offset);
  return InitialShape(body, models, start, size).scale(weight);
}

}  // namespace

void set_initial_deflections(std::size_t body, const std::vector<BodyModel>& bodies,
                             const BuildContext& context, double weight, Mechanism& mechanism) {
  const Body& of = context.scene.bodies[body];
  const BodyModel& model = bodies[body];
  if (of.initial_deflections.empty() || model.elastic_size() == 0) return;
  InitialShape initial(body, bodies, context, mechanism.guess);
  const int offset = model.elastic_offset(), size = model.elastic_size();
  mechanism.guess.q.segment(offset, size) = initial.shape();
  mechanism.guess.v.segment(offset, size) = initial.rate();
  mechanism.bent_starts.push_back(
      initial.start(scale_at_start(body, bodies.size(), context, mechanism.guess, weight)));
  std::set<int> variables = context.differentiated(variables_of(of, context.scene));
  for (const auto& [variable, change] : model.invariants_x) variables.insert(variable);
  const std::vector<MatrixXd> changes = initial.derivatives(variables);
  std::size_t k = 0;
  for (const int variable : variables) {
    mechanism.guess_q_x.col(variable).segment(offset, size) = changes[k].col(0);
    mechanism.guess_v_x.col(variable).segment(offset, size) = changes[k++].col(1);
  }
}

}  // namespace pleuel
