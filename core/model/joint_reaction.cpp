#include "core/model/joint_reaction.hpp"

#include <array>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/frame/marker_kinematics.hpp"
#include "core/frame/number_data.hpp"
#include "core/joints/joint_term.hpp"

namespace pleuel {

namespace {

/// Coordinates of both markers (a frame and six displacements each), and equations.
constexpr int max_coordinates = 2 * (6 + 6), max_equations = 7;

template <class Scalar>
struct Local {
  std::array<Scalar, max_coordinates> q;
  std::array<Scalar, max_equations> lambda;
};

template <class Scalar>
Local<Scalar> load(const JointReaction& reaction, const State& state) {
  Local<Scalar> local;
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
  return joint_wrench(topology, data, time, local.q.data(), local.lambda.data());
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
  const int directions = coordinates + joint_.equations();
  const Local<WideDual> fixed = load<WideDual>(*this, state);
  Columns columns(6, directions);
  for (int first = 0; first < directions; first += wide_slots) {
    const SeedGroup seed(first);
    Local<WideDual> local = fixed;
    for (int i = 0; i < coordinates; ++i) seed(local.q[i], i);
    for (int i = 0; i < joint_.equations(); ++i) seed(local.lambda[i], coordinates + i);
    const auto wrench = evaluate(joint_.topology, numbers_->constants, local, state.time);
    for (int i = 0; i < wide_slots && first + i < directions; ++i) {
      for (int row = 0; row < 6; ++row) columns(row, first + i) = derivative_of(wrench(row), i);
    }
  }
  Derivatives result;
  result.q = columns.leftCols(coordinates);
  result.lambda = columns.rightCols(joint_.equations());
  const Local<Dual> constant = load<Dual>(*this, state);
  for (const auto& [variable, data] : numbers_->by_variable) {
    result.design.push_back(
        {variable, derivative_matrix(evaluate(joint_.topology, data, constant, state.time))});
  }
  return result;
}

}  // namespace pleuel
