#include "core/start/least_norm.hpp"

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/start/assembly.hpp"

namespace pleuel {

LeastNorm::LeastNorm(const Mechanism& mechanism)
    : mechanism_(mechanism),
      system_(*mechanism.system),
      matrix_(system_.make_matrix()),
      solver_(matrix_, mechanism.elastic),
      position_(system_.coordinates(), system_.multipliers()),
      forceless_(system_.multipliers(), system_.left_out().size()) {}

// With S the weights of the assembly, S p + Φ_qᵀ c = φ and Φ_q p = 0 have p = 0 for a row φ that
// follows from the others. The rows of those that are left out say c_i = 0; their columns are φ_i.
void LeastNorm::set(const State& state) {
  if (is_set_ && position_.time == state.time && position_.q == state.q) return;
  is_set_ = false;
  const int n = system_.coordinates(), m = system_.multipliers();
  position_.time = state.time;
  position_.q = state.q;
  projection_matrix(mechanism_, position_, matrix_);
  if (!solver_.factorize(matrix_)) {
    throw SimulationError(fmt::format(
        "the reactions of least norm are not determined at t = {:.6g} s: the mechanism is in a "
        "singular position",
        state.time));
  }
  const std::vector<int>& left_out = system_.left_out();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(n + m, forceless_.cols());
  for (std::size_t i = 0; i < left_out.size(); ++i) {
    rows.col(i).head(n) = Eigen::VectorXd(matrix_.col(n + left_out[i])).head(n);
  }
  solver_.solve(rows);
  forceless_ = -rows.bottomRows(m);
  for (std::size_t i = 0; i < left_out.size(); ++i) {
    forceless_(left_out[i], i) = 1.0;
  }
  weights_ =
      Cholesky(forceless_.transpose() * mechanism_.reaction_weight.asDiagonal() * forceless_);
  is_set_ = true;
}

Eigen::VectorXd LeastNorm::share(const Eigen::VectorXd& b) const {
  return forceless_ * weights_.solve(forceless_.transpose() * b);
}

Eigen::VectorXd LeastNorm::apply(const Eigen::VectorXd& multipliers) const {
  return multipliers - share(mechanism_.reaction_weight.cwiseProduct(multipliers));
}

Eigen::VectorXd LeastNorm::motion(const Eigen::VectorXd& b) {
  const int n = system_.coordinates(), m = system_.multipliers();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n + m);
  x.tail(m) = b;
  for (int i : system_.left_out()) x(n + i) = 0.0;
  solver_.solve(x);
  return x.head(n);
}

LeastNorm::Slope LeastNorm::slope(const Eigen::VectorXd& multipliers, const Eigen::VectorXd& g) {
  const Eigen::VectorXd& weight = mechanism_.reaction_weight;
  const Eigen::VectorXd lambda = apply(multipliers);
  Slope slope;
  slope.beta = share(g);
  slope.lambda = g - weight.cwiseProduct(slope.beta);
  slope.alpha = motion(slope.lambda);
  slope.y = motion(weight.cwiseProduct(lambda));
  slope.left = multipliers - lambda;
  return slope;
}

}  // namespace pleuel
