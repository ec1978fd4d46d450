#pragma once

#include "core/system/term.hpp"

namespace pleuel {

/// ½ (θᵀθ − 1) = 0 for the Euler parameters of one body.
class EulerParameterNorm : public Term {
 public:
  /// @param body        for its name
  /// @param first       index of e₀ in q
  /// @param multiplier  row of the constraint (counted from the number of coordinates)
  EulerParameterNorm(std::string body, int first, int multiplier)
      : body_(std::move(body)), first_(first), multiplier_(multiplier) {}

  std::string name() const override { return "norm of the Euler parameters of " + body_; }
  void declare_entries(EntryList& entries) const override;
  void add_residual(const State& state, ConstraintLevel level, Eigen::VectorXd& residual) override;
  void linearize(const State& state, const WeightList& weights, ConstraintLevel level,
                 Eigen::VectorXd& residual, const EntryBlocks& entries) override;
  void add_design_derivative(const State&, ConstraintLevel, Eigen::MatrixXd&) override {}

 private:
  std::string body_;
  int first_, multiplier_;
};

}  // namespace pleuel
