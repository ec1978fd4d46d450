#include "core/response/reaction_signal.hpp"

#include <array>

#include <fmt/format.h>

#include "core/joints/joint_residual.hpp"
#include "core/response/vector_component.hpp"

namespace pleuel {

namespace {

/// Coordinates of both markers (a frame and six displacements each), and equations.
constexpr int max_coordinates = 2 * (6 + 6), max_equations = 7;
using WideDual = DualOf<max_coordinates + max_equations>;

std::vector<int> local_coordinates(const JointTopology& topology) {
  std::vector<int> coordinates;
  for (const Marker& marker : topology.markers) {
    for (int i = 0; i < marker.frame.size(); ++i) coordinates.push_back(marker.frame.offset + i);
    for (int index : marker.elastic) {
      if (index >= 0) coordinates.push_back(index);
    }
  }
  return coordinates;
}

/// The numbers of a joint in another scalar type, number by number: make(value, derivative).
template <class Scalar, class Make>
JointData<Scalar> seed_data(const JointData<double>& data, const JointData<double>& derivative,
                            const Make& make) {
  JointData<Scalar> seeded;
  for (std::size_t i = 0; i < 2; ++i) {
    seeded.points[i] = data.points[i].binaryExpr(derivative.points[i], make);
  }
  for (std::size_t i = 0; i < data.directions.size(); ++i) {
    seeded.directions.emplace_back(data.directions[i].binaryExpr(derivative.directions[i], make));
  }
  seeded.offset = make(data.offset, derivative.offset);
  seeded.length = make(data.length, derivative.length);
  std::size_t i = 0;
  seeded.drive = data.drive.transformed<Scalar>(
      [&](double parameter) { return make(parameter, derivative.drive.parameters[i++]); });
  return seeded;
}

JointData<WideDual> as_constants(const JointData<double>& data) {
  return seed_data<WideDual>(data, data, [](double value, double) { return WideDual(value); });
}

JointData<Dual> seeded(const JointData<double>& data, const JointData<double>& derivative) {
  return seed_data<Dual>(data, derivative, [](double value, double change) {
    return Dual(value, Dual::DerType::Constant(change));
  });
}

class ReactionSignal final : public Signal {
 public:
  ReactionSignal(const JointModel& joint, const ReactionPart& part)
      : joint_(joint),
        part_(part),
        coordinates_(local_coordinates(joint.topology)),
        constants_(as_constants(joint.data)) {
    for (const auto& [variable, derivative] : joint.derivatives) {
      derivatives_.push_back({variable, seeded(joint.data, derivative)});
    }
  }

  int channels() const override { return 1; }
  std::string describe(int) const override {
    return fmt::format("joint {}, {}", joint_.name, component_name(part_.direction));
  }

  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values(0) = evaluate(joint_.data, load<double>(state), state.time);
  }

  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    Local<WideDual> local = load<WideDual>(state);
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      local.q[i].derivatives()[static_cast<int>(i)] = 1.0;
    }
    for (int i = 0; i < joint_.equations(); ++i) {
      local.lambda[static_cast<std::size_t>(i)].derivatives()[max_coordinates + i] = 1.0;
    }
    const WideDual y = evaluate(constants_, local, state.time);
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      gradient.q(coordinates_[i]) += weight * y.derivatives()[static_cast<int>(i)];
    }
    for (int i = 0; i < joint_.equations(); ++i) {
      gradient.lambda(multiplier(state) + i) += weight * y.derivatives()[max_coordinates + i];
    }
    const Local<Dual> constant = load<Dual>(state);
    for (const auto& [variable, data] : derivatives_) {
      gradient.design(variable) += weight * derivative_of(evaluate(data, constant, state.time));
    }
  }

 private:
  /// Rates do not matter at position level, but the kinematics wants them.
  template <class Scalar>
  struct Local {
    std::array<Scalar, max_coordinates> q, v, a;
    std::array<Scalar, max_equations> lambda;
  };

  /// Index in λ of the first equation.
  Eigen::Index multiplier(const State& state) const {
    return joint_.topology.multiplier - state.q.size();
  }

  template <class Scalar>
  Local<Scalar> load(const State& state) const {
    Local<Scalar> local;
    local.v.fill(Scalar(0));
    local.a.fill(Scalar(0));
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      local.q[i] = Scalar(state.q(coordinates_[i]));
    }
    for (int i = 0; i < joint_.equations(); ++i) {
      local.lambda[static_cast<std::size_t>(i)] = Scalar(state.lambda(multiplier(state) + i));
    }
    return local;
  }

  template <class Scalar>
  Scalar evaluate(const JointData<Scalar>& data, const Local<Scalar>& local, double time) const {
    std::array<Scalar, max_coordinates> forces;
    std::array<Scalar, max_equations> equations;
    forces.fill(Scalar(0));
    JointEvaluation<Scalar> evaluation(joint_.topology, data, time);
    evaluation.set_state(local.q.data(), local.v.data(), local.a.data());
    evaluation.evaluate(ConstraintLevel::position, local.lambda.data(), forces.data(),
                        equations.data());
    const Wrench<Scalar>& wrench = evaluation.wrench();
    return component_of<Scalar>(
        part_.kind == ReactionPart::Kind::force ? wrench.force : wrench.moment, part_.direction);
  }

  const JointModel& joint_;
  ReactionPart part_;
  std::vector<int> coordinates_;
  JointData<WideDual> constants_;
  std::vector<DesignDerivative<JointData<Dual>>> derivatives_;
};

}  // namespace

std::unique_ptr<Signal> make_reaction_signal(const JointModel& joint, const ReactionPart& part) {
  return std::make_unique<ReactionSignal>(joint, part);
}

}  // namespace pleuel
