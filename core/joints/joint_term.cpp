#include "core/joints/joint_term.hpp"

#include <algorithm>

#include "core/joints/joint_linearization.hpp"
#include "core/joints/joint_numbers.hpp"

namespace pleuel {

namespace {

class JointTerm : public Term {
 public:
  JointTerm(JointTopology topology, JointData<double> data,
            const std::vector<DesignDerivative<JointData<double>>>& derivatives)
      : topology_(std::move(topology)),
        data_(std::move(data)),
        dual_data_(cast_data<WideDual>(data_)),
        coordinates_(local_coordinates(topology_)) {
    for (const auto& [variable, derivative] : derivatives) {
      derivatives_.push_back({variable, seed_data(data_, derivative)});
    }
  }

  std::string name() const override { return "joint " + topology_.name; }

  void declare_entries(EntryList& entries) const override {
    for (int row : coordinates_) {
      for (int col : coordinates_) entries.emplace_back(row, col);
      for (int i = 0; i < equations(); ++i) entries.emplace_back(row, topology_.multiplier + i);
    }
    for (int i = 0; i < equations(); ++i) {
      for (int col : coordinates_) entries.emplace_back(topology_.multiplier + i, col);
    }
  }

  void add_residual(const State& state, ConstraintLevel level, Eigen::VectorXd& residual) override {
    const Result<double> result = evaluate(data_, load<double>(state), state.time, level);
    for (int i = 0; i < local_size(); ++i) residual(coordinate(i)) += result.forces[index(i)];
    for (int i = 0; i < equations(); ++i) {
      residual(topology_.multiplier + i) += result.equations[index(i)];
    }
  }

  void linearize(const State& state, const WeightList& weights, ConstraintLevel level,
                 Eigen::VectorXd& residual, const EntryBlocks& entries) override {
    if (level == ConstraintLevel::position) {
      linearize_position(state, weights, residual, entries);
      return;
    }
    add_residual(state, level, residual);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      write_dual_tangent(state, weights[i], level, entries.block(i));
    }
  }

  void add_design_derivative(const State& state, ConstraintLevel level,
                             Eigen::MatrixXd& columns) override {
    for (const auto& [variable, data] : derivatives_) {
      const Result<Dual> result = evaluate(data, load<Dual>(state), state.time, level);
      for (int i = 0; i < local_size(); ++i) {
        columns(coordinate(i), variable) += derivative_of(result.forces[index(i)]);
      }
      for (int i = 0; i < equations(); ++i) {
        columns(topology_.multiplier + i, variable) += derivative_of(result.equations[index(i)]);
      }
    }
  }

 private:
  /// Bounds the number of local coordinates and equations together.
  static constexpr int max_slots = JointLinearization::max_size + 7;
  using WideDual = DualOf<max_slots>;

  template <class Scalar>
  struct Local {
    std::array<Scalar, max_slots> q, v, a, lambda;
  };
  template <class Scalar>
  struct Result {
    std::array<Scalar, max_slots> forces, equations;
  };

  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  int local_size() const { return static_cast<int>(coordinates_.size()); }
  int equations() const { return static_cast<int>(topology_.equations.size()); }
  int coordinate(int i) const { return coordinates_[index(i)]; }

  /// The fast way, for the time loop.
  void linearize_position(const State& state, const WeightList& weights, Eigen::VectorXd& residual,
                          const EntryBlocks& entries) const {
    const int size = local_size(), count = equations();
    JointLinearization::Vector q(size);
    for (int i = 0; i < size; ++i) q(i) = state.q(coordinate(i));
    JointLinearization joint(topology_, data_, state.time, q.data(), size);
    for (std::size_t k = 0; k < weights.size(); ++k) {
      std::fill_n(entries.block(k), size * (size + count) + count * size, 0.0);
    }
    const auto first = topology_.multiplier - state.q.size();
    for (int i = 0; i < count; ++i) {
      joint.evaluate(topology_.equations[index(i)]);
      const double lambda = state.lambda(first + i);
      residual(topology_.multiplier + i) += joint.value();
      for (int row = 0; row < size; ++row) {
        residual(coordinate(row)) += lambda * joint.gradient()(row);
      }
      for (std::size_t k = 0; k < weights.size(); ++k) {
        add_equation(joint, i, weights[k].q, lambda, entries.block(k));
      }
    }
  }

  void add_equation(const JointLinearization& joint, int equation, double weight, double lambda,
                    double* entries) const {
    const int size = local_size(), stride = size + equations();
    for (int row = 0; row < size; ++row) {
      const double gradient = joint.gradient()(row);
      entries[row * stride + size + equation] = gradient;
      entries[size * stride + equation * size + row] = weight * gradient;
      if (weight == 0.0) continue;
      for (int col = 0; col < size; ++col) {
        entries[row * stride + col] += weight * lambda * joint.hessian()(row, col);
      }
    }
  }

  /// At any level, by dual numbers.
  void write_dual_tangent(const State& state, const Weights& weights, ConstraintLevel level,
                          double* entries) const {
    Local<WideDual> local = load<WideDual>(state);
    for (int i = 0; i < local_size(); ++i) {
      local.q[index(i)].derivatives()[i] = weights.q;
      local.v[index(i)].derivatives()[i] = weights.v;
      local.a[index(i)].derivatives()[i] = weights.a;
    }
    for (int i = 0; i < equations(); ++i) {
      local.lambda[index(i)].derivatives()[local_size() + i] = 1.0;
    }
    const Result<WideDual> result = evaluate(dual_data_, local, state.time, level);
    for (int row = 0; row < local_size(); ++row) {
      for (int col = 0; col < local_size() + equations(); ++col) {
        *entries++ = result.forces[index(row)].derivatives()[col];
      }
    }
    for (int row = 0; row < equations(); ++row) {
      for (int col = 0; col < local_size(); ++col) {
        *entries++ = result.equations[index(row)].derivatives()[col];
      }
    }
  }

  template <class Scalar>
  Local<Scalar> load(const State& state) const {
    Local<Scalar> local;
    for (int i = 0; i < local_size(); ++i) {
      local.q[index(i)] = Scalar(state.q(coordinate(i)));
      local.v[index(i)] = Scalar(state.v(coordinate(i)));
      local.a[index(i)] = Scalar(state.a(coordinate(i)));
    }
    const auto first = topology_.multiplier - state.q.size();
    for (int i = 0; i < equations(); ++i) local.lambda[index(i)] = Scalar(state.lambda(first + i));
    return local;
  }

  template <class Scalar>
  Result<Scalar> evaluate(const JointData<Scalar>& data, const Local<Scalar>& local, double time,
                          ConstraintLevel level) const {
    Result<Scalar> result;
    for (int i = 0; i < local_size(); ++i) result.forces[index(i)] = Scalar(0);
    JointEvaluation<Scalar> evaluation(topology_, data, time);
    evaluation.set_state(local.q.data(), local.v.data(), local.a.data());
    evaluation.evaluate(level, local.lambda.data(), result.forces.data(), result.equations.data());
    return result;
  }

  JointTopology topology_;
  JointData<double> data_;
  JointData<WideDual> dual_data_;
  std::vector<DesignDerivative<JointData<Dual>>> derivatives_;
  std::vector<int> coordinates_;
};

}  // namespace

std::unique_ptr<Term> make_joint_term(
    JointTopology topology, JointData<double> data,
    std::vector<DesignDerivative<JointData<double>>> derivatives) {
  return std::make_unique<JointTerm>(std::move(topology), std::move(data), derivatives);
}

}  // namespace pleuel
