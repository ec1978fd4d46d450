#include "core/response/force_signals.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "core/base/find_named.hpp"
#include "core/model/body_energy.hpp"
#include "core/model/joint_reaction.hpp"
#include "core/response/composed_signals.hpp"
#include "core/response/response.hpp"
#include "core/system/term.hpp"

namespace pleuel {

namespace {

TimeLaw<Dual> seed_law(const TimeLaw<double>& law, const TimeLaw<double>& derivative) {
  std::size_t i = 0;
  return law.transformed<Dual>([&](double parameter) {
    return Dual(parameter, Dual::Derivatives::Constant(derivative.parameters[i++]));
  });
}

/// −λ, times ḟ of the power.
class DriveSignal final : public Signal {
 public:
  DriveSignal(const JointModel& joint, DriveNumber number)
      : joint_(joint), is_power_(number == DriveNumber::power) {
    if (!is_power_) return;
    for (const auto& [variable, data] : joint.derivatives) {
      laws_.push_back({variable, seed_law(joint.data.drive, data.drive)});
    }
  }
  int channels() const override { return 1; }
  std::string describe(int) const override { return "drive"; }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values(0) = -state.lambda(joint_.drive_row) * rate(state);
  }
  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    gradient.lambda(joint_.drive_row) -= weight * rate(state);
    for (const auto& [variable, law] : laws_) {
      gradient.design(variable) -=
          weight * state.lambda(joint_.drive_row) * derivative_of(law.at(state.time).rate);
    }
  }

 private:
  double rate(const State& state) const {
    return is_power_ ? joint_.data.drive.at(state.time).rate : 1.0;
  }

  const JointModel& joint_;
  bool is_power_;
  std::vector<DesignDerivative<TimeLaw<Dual>>> laws_;  ///< of the power
};

}  // namespace

std::unique_ptr<Signal> make_drive_signal(const JointModel& joint, DriveNumber number) {
  return std::make_unique<DriveSignal>(joint, number);
}

namespace {

class GaugeSignal final : public Signal {
 public:
  GaugeSignal(std::shared_ptr<const Gauge> gauge, Reading reading, std::string name)
      : gauge_(std::move(gauge)), reading_(reading), name_(std::move(name)) {}

  int channels() const override { return 1; }
  std::string describe(int) const override { return name_; }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values(0) = gauge_->read(state, reading_);
  }
  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    gauge_->add_gradient(state, reading_, weight, gradient.q, gradient.v, gradient.design);
  }

 private:
  std::shared_ptr<const Gauge> gauge_;
  Reading reading_;
  std::string name_;
};

Reading reading_of(LoadNumber number) {
  switch (number) {
    case LoadNumber::spring_force:
      return Reading::force;
    case LoadNumber::motor_power:
      return Reading::motor_power;
    case LoadNumber::damper_power:
      return Reading::damper_power;
    default:
      return Reading::coordinate;
  }
}

/// @param name  of what is read
std::unique_ptr<Signal> make_gauge_signal(const std::string& response, const std::string& name,
                                          const std::optional<GaugeModel>& found, Reading reading,
                                          const Model& model) {
  if (!found) {
    refuse_response(response, fmt::format("\"{}\" has no such relative coordinate: one of its "
                                          "bodies is a point that does not turn",
                                          name));
  }
  auto signal = std::make_unique<GaugeSignal>(found->gauge, reading, name);
  if (!found->map) return signal;
  return std::make_unique<ProjectedSignal>(std::move(signal), *found->map,
                                           model.mechanism.system->variables());
}

}  // namespace

std::unique_ptr<Signal> make_gauge_signal(const std::string& response,
                                          const JointMotionResponse& motion, const Model& model) {
  const JointModel& joint = model.joint(motion.joint);
  const bool is_position = motion.derivative == TimeDerivative::none;
  return make_gauge_signal(
      response, motion.joint,
      motion.coordinate == DrivenCoordinate::angle ? joint.angle : joint.displacement,
      is_position ? Reading::coordinate : Reading::rate, model);
}

std::unique_ptr<Signal> make_gauge_signal(const std::string& response, const LoadResponse& load,
                                          const Model& model) {
  const LoadModel& one = *find_named(model.loads, load.load);
  return make_gauge_signal(response, load.load, one.gauge, reading_of(load.kind), model);
}

namespace {

class ReactionSignal final : public Signal {
 public:
  ReactionSignal(const JointModel& joint, const ReactionResponse& part)
      : reaction_(joint), part_(part) {}

  int channels() const override { return 1; }
  std::string describe(int) const override {
    return fmt::format("joint {}, {}", reaction_.joint().name, component_name(part_.direction));
  }

  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values(0) = component_of<double>(part_of(reaction_.wrench(state)), part_.direction);
  }

  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    const JointReaction::Derivatives derivatives = reaction_.derivatives(state);
    const Eigen::RowVector3d slope =
        weight * component_slope(part_of(reaction_.wrench(state)), part_.direction);
    const Eigen::RowVectorXd q = slope * part_of(derivatives.q);
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      gradient.q(reaction_.coordinates()[i]) += q(i);
    }
    const Eigen::RowVectorXd lambda = slope * part_of(derivatives.lambda);
    gradient.lambda.segment(reaction_.multiplier(state), lambda.size()) += lambda.transpose();
    for (const auto& [variable, wrench] : derivatives.design) {
      gradient.design(variable) += slope * part_of(wrench);
    }
  }

 private:
  /// The rows of the force or of the moment.
  template <class Rows>
  Eigen::Matrix<double, 3, Rows::ColsAtCompileTime> part_of(const Rows& rows) const {
    return rows.template middleRows<3>(part_.kind == ReactionKind::force ? 0 : 3);
  }

  JointReaction reaction_;
  ReactionResponse part_;
};

}  // namespace

std::unique_ptr<Signal> make_reaction_signal(const JointModel& joint,
                                             const ReactionResponse& part) {
  return std::make_unique<ReactionSignal>(joint, part);
}

LeastNormSignal::LeastNormSignal(std::unique_ptr<Signal> inner, std::shared_ptr<LeastNorm> norm,
                                 const Model& model)
    : inner_(std::move(inner)),
      norm_(std::move(norm)),
      joints_(terms_besides_bodies(model).acting, *model.mechanism.system),
      at_rest_(model.mechanism.system->coordinates(), model.mechanism.system->multipliers()),
      local_(model.mechanism.system->coordinates(), model.mechanism.system->multipliers(),
             model.mechanism.system->variables()),
      rows_(Eigen::VectorXd::Zero(model.mechanism.system->size())) {}

void LeastNormSignal::set(const State& state) {
  norm_->set(state);
  least_ = state;
  least_.lambda = norm_->apply(state.lambda);
}

void LeastNormSignal::observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) {
  set(state);
  inner_->observe(least_, values);
}

void LeastNormSignal::add_gradient(const State& state, int channel, double weight,
                                   SignalGradient& gradient) {
  set(state);
  local_.set_zero();
  inner_->add_gradient(least_, channel, weight, local_);
  const LeastNorm::Slope slope = norm_->slope(state.lambda, local_.lambda);
  gradient.v += local_.v;
  gradient.a += local_.a;
  gradient.lambda += slope.lambda;
  add_change_of_forces(slope.alpha, slope.left, local_);
  add_change_of_forces(slope.y, slope.beta, local_);
  gradient.q += local_.q;
  gradient.design += local_.design;
}

bool LeastNormSignal::is_determined(const State& state) {
  constexpr double round_off = 1e-6;
  set(state);
  for (int channel = 0; channel < channels(); ++channel) {
    local_.set_zero();
    inner_->add_gradient(least_, channel, 1.0, local_);
    const Eigen::VectorXd shared = norm_->slope(state.lambda, local_.lambda).beta;
    if (shared.norm() > round_off * local_.lambda.norm()) return false;
  }
  return true;
}

/// ∂(motionᵀ Φ_qᵀ λ)/∂(q, x): of what joints and loads exert, the part that is linear in λ.
void LeastNormSignal::add_change_of_forces(const Eigen::VectorXd& motion,
                                           const Eigen::VectorXd& multipliers,
                                           SignalGradient& gradient) {
  at_rest_.time = least_.time;
  at_rest_.q = least_.q;
  for (const double sign : {1.0, -1.0}) {
    at_rest_.lambda = sign > 0.0 ? multipliers : Eigen::VectorXd::Zero(multipliers.size());
    rows_.head(motion.size()) = sign * motion;
    joints_.add_gradient(at_rest_, ConstraintLevel::position, rows_, gradient);
  }
}

}  // namespace pleuel
