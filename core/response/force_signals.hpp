#pragma once

#include <memory>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"
#include "core/response/term_product.hpp"
#include "core/scene/response_settings.hpp"
#include "core/start/redundancy.hpp"

namespace pleuel {

/// The effort −λ of its equation: the torque [N m] about the joint's axis that a drive of an angle exerts
/// on the second body of its joint, or the force [N] along the axis (of a distance: along the
/// connection) of a drive of a displacement. Or its power −λ ḟ(t) [W]: what the drive f(t) supplies
/// to the mechanism, −λᵀ ∂Φ/∂t.
/// @param joint  must outlive the signal
std::unique_ptr<Signal> make_drive_signal(const JointModel& joint, DriveNumber number);

/// Position and velocity of a joint, length and pull of a spring, power of a motor: what a gauge of
/// the model reads (core/system/term.hpp).
/// @param response  its name
/// @throws InputError where the model has no such gauge
std::unique_ptr<Signal> make_gauge_signal(const std::string& response,
                                          const JointMotionResponse& motion, const Model& model);
std::unique_ptr<Signal> make_gauge_signal(const std::string& response, const LoadResponse& load,
                                          const Model& model);

/// What a joint, its drive included, exerts on its second body at that body's point of the joint:
///     force = −(∂Φ/∂P₂)ᵀ λ [N],    moment about the point = −(∂Φ/∂θ₂)ᵀ λ [N m]
/// Springs, dampers and motors in the joint are loads and no part of it.
///
/// In motion in a plane a joint carries the force in the plane and the moment normal to it. The
/// other components are zero here: so they are by symmetry, as long as bodies, joints and loads are
/// symmetric about the plane, which is what motion in a plane requires.
///
/// The signal is written in the numbers of the joint: local ones where the joint has a map, so that
/// a ProjectedSignal must lead there.
/// @param joint  must outlive the signal
std::unique_ptr<Signal> make_reaction_signal(const JointModel& joint, const ReactionResponse& part);

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
