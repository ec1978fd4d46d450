#include "core/model/joint_reaction.hpp"

#include <array>

#include "core/base/int_size.hpp"
#include "core/frame/number_data.hpp"
#include "core/joints/joint_residual.hpp"

namespace pleuel {

namespace {

/// Coordinates of both markers (a frame and six displacements each), and equations.
constexpr int max_coordinates = 2 * (6 + 6), max_equations = 7;
using WideDual = DualOf<max_coordinates + max_equations>;

/// Rates do not matter at position level, but the kinematics wants them.
template <class Scalar>
struct Local {
  std::array<Scalar, max_coordinates> q, v, a;
  std::array<Scalar, max_equations> lambda;
};

template <class Scalar>
Local<Scalar> load(const JointReaction& reaction, const State& state) {
  Local<Scalar> local;
  local.v.fill(Scalar(0));
  local.a.fill(Scalar(0));
  const std::vector<int>& coordinates = reaction.coordinates();
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    local.q[i] = Scalar(state.q(coordinates[i]));
  }
  for (int i = 0; i < reaction.joint().equations(); ++i) {
    local.lambda[i] = Scalar(state.lambda(reaction.multiplier(state) + i));
  }
  return local;
}

template <class Scalar>
Eigen::Matrix<Scalar, 6, 1> evaluate(const JointTopology& topology, const JointData<Scalar>& data,
                                     const Local<Scalar>& local, double time) {
  std::array<Scalar, max_equations> equations;
  JointEvaluation<Scalar> evaluation(topology, data, time, local.q.data(), local.v.data(),
                                     local.a.data());
  evaluation.evaluate(ConstraintLevel::position, local.lambda.data(), equations.data());
  Eigen::Matrix<Scalar, 6, 1> result;
  result << evaluation.wrench().force, evaluation.wrench().moment;
  return result;
}

}  // namespace

struct JointReaction::Numbers {
  JointData<WideDual> constants;
  std::vector<DesignDerivative<JointData<Dual>>> by_variable;
};

JointReaction::JointReaction(const JointModel& joint)
    : joint_(joint), coordinates_(coordinate_indices(joint.topology.markers)) {
  auto numbers = std::make_unique<Numbers>();
  numbers->constants = cast_data<WideDual>(joint.data);
  for (const auto& [variable, derivative] : joint.derivatives) {
    numbers->by_variable.push_back({variable, seed_data(joint.data, derivative)});
  }
  numbers_ = std::move(numbers);
}

JointReaction::~JointReaction() = default;

int JointReaction::multiplier(const State& state) const {
  return joint_.topology.multiplier - int_size(state.q);
}

JointReaction::Wrench JointReaction::wrench(const State& state) const {
  return evaluate(joint_.topology, joint_.data, load<double>(*this, state), state.time);
}

JointReaction::Derivatives JointReaction::derivatives(const State& state) const {
  const auto coordinates = int_size(coordinates_);
  Local<WideDual> local = load<WideDual>(*this, state);
  for (int i = 0; i < coordinates; ++i) {
    local.q[i].derivatives()[i] = 1.0;
  }
  for (int i = 0; i < joint_.equations(); ++i) {
    local.lambda[i].derivatives()[max_coordinates + i] = 1.0;
  }
  const auto wrench = evaluate(joint_.topology, numbers_->constants, local, state.time);
  Derivatives result;
  result.q.resize(6, coordinates);
  result.lambda.resize(6, joint_.equations());
  for (int row = 0; row < 6; ++row) {
    const auto& slopes = wrench(row).derivatives();
    result.q.row(row) = slopes.head(coordinates).transpose();
    result.lambda.row(row) = slopes.segment(max_coordinates, joint_.equations()).transpose();
  }
  const Local<Dual> constant = load<Dual>(*this, state);
  for (const auto& [variable, data] : numbers_->by_variable) {
    result.design.push_back(
        {variable, derivative_matrix(evaluate(joint_.topology, data, constant, state.time))});
  }
  return result;
}

}  // namespace pleuel
