#pragma once

#include <memory>

#include <Eigen/SparseCore>

#include "core/model/model.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// The stiffness of a body, elastic coordinates × elastic coordinates.
Eigen::SparseMatrix<double> stiffness_of(const Invariants<double>& invariants);

/// Elastic forces of a body against its frame, with geometric stiffening where it has it, and their
/// derivatives; elastic coordinates alone.
class ElasticForces {
 public:
  /// @param model  must outlive this
  /// @param size   of the state of the mechanism
  ElasticForces(const BodyModel& model, const State& size);

  /// K.
  const Eigen::SparseMatrix<double>& linear() const { return linear_; }
  void set(const Eigen::VectorXd& q);

  Eigen::VectorXd forces();
  Eigen::SparseMatrix<double> tangent();
  /// By all design variables, at fixed coordinates: n × variables.
  Eigen::MatrixXd design_derivatives(int variables);

 private:
  Eigen::VectorXd elastic(const Eigen::VectorXd& all) const;

  const BodyModel& model_;
  Eigen::SparseMatrix<double> linear_;
  State state_;
  std::unique_ptr<Term> stiffening_;
  EntryList places_;
};

}  // namespace pleuel
