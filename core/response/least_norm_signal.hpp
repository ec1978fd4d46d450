#pragma once

#include <memory>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"
#include "core/response/term_product.hpp"
#include "core/start/least_norm.hpp"

namespace pleuel {

/// A signal of multipliers where constraints are redundant: sees those of least norm in place of
/// those of the constraints that were kept.
class LeastNormSignal final : public Signal {
 public:
  /// @param norm   of the model, shared by its signals: what one has set serves the others
  /// @param model  with redundant constraints; must outlive this
  LeastNormSignal(std::unique_ptr<Signal> inner, std::shared_ptr<LeastNorm> norm,
                  const Model& model);

  int channels() const override { return inner_->channels(); }
  std::string describe(int channel) const override { return inner_->describe(channel); }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override;
  /// Along changes that keep the constraints and their redundancy: others do not occur.
  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override;
  bool is_determined(const State& state) override;

 private:
  void set(const State& state);
  void add_change_of_forces(const Eigen::VectorXd& motion, const Eigen::VectorXd& multipliers,
                            SignalGradient& gradient);

  std::unique_ptr<Signal> inner_;
  std::shared_ptr<LeastNorm> norm_;
  TermProduct joints_;
  State least_, at_rest_;
  SignalGradient local_;
  Eigen::VectorXd rows_;
};

}  // namespace pleuel
