#pragma once

#include <memory>

#include "core/response/signal.hpp"
#include "core/system/coordinate_map.hpp"

namespace pleuel {

/// A signal that is written in local coordinates q_l = P q of the generalized ones:
///     ∂y/∂q = Pᵀ ∂y/∂q_l,    ∂y/∂x = explicit part + ∂y/∂q_l · P_x q + …
class ProjectedSignal final : public Signal {
 public:
  /// @param variables  number of design variables
  ProjectedSignal(std::unique_ptr<Signal> inner, CoordinateMap map, int variables);

  int channels() const override { return inner_->channels(); }
  std::string describe(int channel) const override { return inner_->describe(channel); }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override;
  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override;

 private:
  void scatter(const Eigen::VectorXd& local, Eigen::VectorXd& all) const;

  std::unique_ptr<Signal> inner_;
  CoordinateMap map_;
  LocalState state_;
  SignalGradient local_;
};

}  // namespace pleuel
