#include "core/system/linear_forces.hpp"

namespace pleuel {

LinearForces::LinearForces(System& system, ConstraintLevel level)
    : system_(system),
      level_(level),
      with_(system.coordinates(), system.multipliers()),
      without_(with_),
      tangent_without_(system.make_matrix()) {}

void LinearForces::set(const State& place, const Eigen::VectorXd& a,
                       const Eigen::VectorXd& lambda) {
  with_.time = without_.time = place.time;
  with_.q = without_.q = place.q;
  with_.a = a;
  with_.lambda = lambda;
}

void LinearForces::set(const State& place, const Eigen::VectorXd& lambda) {
  set(place, without_.a, lambda);
}

const Eigen::VectorXd& LinearForces::residual() {
  system_.residual(with_, level_, residual_);
  system_.residual(without_, level_, residual_without_);
  residual_ -= residual_without_;
  return residual_;
}

void LinearForces::tangent(System::Matrix& matrix) {
  system_.tangent(with_, {.q = 1.0}, level_, matrix);
  system_.tangent(without_, {.q = 1.0}, level_, tangent_without_);
  // The columns of multipliers, which are the same in both, are F_λ.
  const Eigen::Index count = matrix.outerIndexPtr()[system_.coordinates()];
  matrix.coeffs().head(count) -= tangent_without_.coeffs().head(count);
}

const Eigen::MatrixXd& LinearForces::design_derivative() {
  system_.design_derivative(with_, level_, columns_);
  system_.design_derivative(without_, level_, columns_without_);
  columns_ -= columns_without_;
  return columns_;
}

void LinearForces::add_parameter_adjoints(const ConstColumns& mu, Columns sums) {
  system_.add_parameter_adjoints(with_, level_, mu, sums);
  minus_mu_ = -mu;
  system_.add_parameter_adjoints(without_, level_, minus_mu_, sums);
}

}  // namespace pleuel
