#include "core/model/elastic_forces.hpp"

#include <vector>

#include "core/base/eager_matrices.hpp"
#include "core/model/beam_shapes.hpp"

namespace pleuel {

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

ElasticForces::ElasticForces(const BodyModel& model, const State& size)
    : model_(model), linear_(stiffness_of(model.invariants)), state_(size) {
  state_.q.setZero();
  state_.v.setZero();
  if (!model.has_stiffening) return;
  stiffening_ = make_stiffening(model);
  stiffening_->declare_entries(places_);
}

void ElasticForces::set(const Eigen::VectorXd& q) {
  state_.q.segment(model_.elastic_offset(), q.size()) = q;
}

Eigen::VectorXd ElasticForces::elastic(const Eigen::VectorXd& all) const {
  return all.segment(model_.elastic_offset(), model_.elastic_size());
}

Eigen::VectorXd ElasticForces::forces() {
  const Eigen::VectorXd q = elastic(state_.q);
  Eigen::VectorXd sum = linear_ * q;
  if (!stiffening_) return sum;
  Eigen::VectorXd residual = Eigen::VectorXd::Zero(state_.q.size() + state_.lambda.size());
  stiffening_->add_residual(state_, ConstraintLevel::position, residual);
  return sum + elastic(residual);
}

Eigen::SparseMatrix<double> ElasticForces::tangent() {
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

Eigen::MatrixXd ElasticForces::design_derivatives(int variables) {
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

}  // namespace pleuel
