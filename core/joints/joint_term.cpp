#include "core/joints/joint_term.hpp"

#include <algorithm>

#include "core/base/int_size.hpp"
#include "core/frame/number_data.hpp"
#include "core/joints/joint_linearization.hpp"
#include "core/joints/joint_residual.hpp"

namespace pleuel {

namespace {

class JointTerm : public Term {
 public:
  JointTerm(JointTopology topology, JointData<double> data,
            const std::vector<DesignDerivative<JointData<double>>>& derivatives)
      : topology_(std::move(topology)),
        data_(std::move(data)),
        coordinates_(coordinate_indices(topology_.markers)) {
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
    const int size = local_size(), count = equations();
    const Local<double> local = load<double>(state);
    JointLinearization joint(topology_, data_, state.time, local.q.data(), size);
    if (level == ConstraintLevel::position) {
      linearize_positions(joint, state, weights, residual, entries);
      return;
    }
    JointLinearization::Hessian curvature = JointLinearization::Hessian::Zero(size, size);
    const auto first = topology_.multiplier - state.q.size();
    for (int i = 0; i < count; ++i) {
      joint.clear_hessian();
      joint.evaluate(topology_.equations[index(i)], 1.0);
      const double lambda = state.lambda(first + i);
      residual(topology_.multiplier + i) += value_of(joint, local, level);
      for (int row = 0; row < size; ++row) {
        residual(coordinate(row)) += lambda * joint.gradient()(row);
      }
      curvature += lambda * joint.hessian();
      const EquationTangent tangent = tangent_of(joint, local, level);
      for (std::size_t k = 0; k < weights.size(); ++k) {
        write_equation(joint, tangent, i, weights[k], entries.block(k));
      }
    }
    for (std::size_t k = 0; k < weights.size(); ++k) {
      write_curvature(curvature, weights[k], entries.block(k));
    }
    if (level != ConstraintLevel::acceleration) return;
    const Result<double> result = evaluate(data_, local, state.time, level);
    for (int i = 0; i < count; ++i) {
      residual(topology_.multiplier + i) += result.equations[index(i)];
    }
    add_third_derivatives(state, weights, entries);
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

  int parameter_adjoint_count() const override { return int_size(derivatives_); }

  void add_parameter_adjoints(const State& state, ConstraintLevel level, const ConstColumns& mu,
                              Columns sums) override {
    const Local<Dual> local = load<Dual>(state);
    for (std::size_t k = 0; k < derivatives_.size(); ++k) {
      const Result<Dual> result = evaluate(derivatives_[k].data, local, state.time, level);
      auto sum = sums.row(k);
      for (int i = 0; i < local_size(); ++i) {
        sum += derivative_of(result.forces[index(i)]) * mu.row(coordinate(i));
      }
      for (int i = 0; i < equations(); ++i) {
        sum += derivative_of(result.equations[index(i)]) * mu.row(topology_.multiplier + i);
      }
    }
  }

  void add_design_gradients(const ConstColumns& sums, Eigen::MatrixXd& gradients) const override {
    for (std::size_t k = 0; k < derivatives_.size(); ++k) {
      gradients.row(derivatives_[k].variable) += sums.row(k);
    }
  }

 private:
  /// Bounds the number of local coordinates and equations together.
  static constexpr int max_slots = JointLinearization::max_size + 7;

  template <class Scalar>
  struct Local {
    std::array<Scalar, max_slots> q, v, a, lambda;
  };
  template <class Scalar>
  struct Result {
    typename JointEvaluation<Scalar>::Kinematics::Coordinates forces;
    std::array<Scalar, max_slots> equations;
  };

  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  int local_size() const { return int_size(coordinates_); }
  int equations() const { return int_size(topology_.equations); }
  int coordinate(int i) const { return coordinates_[index(i)]; }

  /// At position level, where one Hessian of all equations together is enough.
  void linearize_positions(JointLinearization& joint, const State& state, const WeightList& weights,
                           Eigen::VectorXd& residual, const EntryBlocks& entries) const {
    const int size = local_size(), count = equations(), stride = size + count;
    const auto first = topology_.multiplier - state.q.size();
    for (int i = 0; i < count; ++i) {
      const double lambda = state.lambda(first + i);
      joint.evaluate(topology_.equations[index(i)], lambda);
      residual(topology_.multiplier + i) += joint.value();
      for (int row = 0; row < size; ++row) {
        const double slope = joint.gradient()(row);
        residual(coordinate(row)) += lambda * slope;
        for (std::size_t k = 0; k < weights.size(); ++k) {
          double* block = entries.block(k);
          block[row * stride + size + i] = slope;
          block[size * stride + i * size + row] = weights[k].q * slope;
        }
      }
    }
    for (std::size_t k = 0; k < weights.size(); ++k) {
      write_curvature(joint.hessian(), weights[k], entries.block(k));
    }
  }

  /// dΦ/dt = gᵀv + Φ_t of one equation; zero on the level of accelerations.
  double value_of(const JointLinearization& joint, const Local<double>& local,
                  ConstraintLevel level) const {
    if (level == ConstraintLevel::acceleration) return 0.0;
    return joint.gradient().dot(Eigen::Map<const Eigen::VectorXd>(local.v.data(), local_size())) +
           joint.rate();
  }

  /// Derivatives of one equation at a level; of d²Φ/dt² without that by q.
  struct EquationTangent {
    JointLinearization::Vector q, v, a;
  };
  EquationTangent tangent_of(JointLinearization& joint, const Local<double>& local,
                             ConstraintLevel level) const {
    const int size = local_size();
    const JointLinearization::Vector zero = JointLinearization::Vector::Zero(size);
    const Eigen::Map<const Eigen::VectorXd> v(local.v.data(), size);
    const JointLinearization::Vector by_q = joint.hessian().transpose() * v + joint.gradient_rate();
    if (level == ConstraintLevel::velocity) return {by_q, joint.gradient(), zero};
    return {zero, by_q + joint.hessian() * v + joint.gradient_rate(), joint.gradient()};
  }

  void write_equation(const JointLinearization& joint, const EquationTangent& tangent, int equation,
                      const Weights& weights, double* entries) const {
    const int size = local_size(), stride = size + equations();
    for (int row = 0; row < size; ++row) {
      entries[row * stride + size + equation] = joint.gradient()(row);
      entries[size * stride + equation * size + row] =
          weights.q * tangent.q(row) + weights.v * tangent.v(row) + weights.a * tangent.a(row);
    }
  }

  /// Of all equations together.
  void write_curvature(const JointLinearization::Hessian& curvature, const Weights& weights,
                       double* entries) const {
    const int size = local_size(), stride = size + equations();
    for (int row = 0; row < size; ++row) {
      for (int col = 0; col < size; ++col) {
        entries[row * stride + col] = weights.q * curvature(row, col);
      }
    }
  }

  /// ∂(d²Φ/dt²)/∂q, by dual numbers.
  void add_third_derivatives(const State& state, const WeightList& weights,
                             const EntryBlocks& entries) {
    const auto uses_q = [](const Weights& w) { return w.q != 0.0; };
    if (std::ranges::none_of(weights, uses_q)) return;
    // Tens of kilobytes a joint, which most simulations do without.
    if (!wide_data_) wide_data_ = std::make_unique<JointData<WideDual>>(cast_data<WideDual>(data_));
    const Local<WideDual> fixed = load<WideDual>(state);
    for (int first = 0; first < local_size(); first += wide_slots) {
      Local<WideDual> local = fixed;
      const SeedGroup seed(first);
      for (int i = 0; i < local_size(); ++i) seed(local.q[index(i)], i);
      const Result<WideDual> result =
          evaluate(*wide_data_, local, state.time, ConstraintLevel::acceleration);
      add_third_derivatives(result, first, weights, entries);
    }
  }

  /// Those by coordinates from the first one of a group on.
  void add_third_derivatives(const Result<WideDual>& result, int first, const WeightList& weights,
                             const EntryBlocks& entries) const {
    const int size = local_size(), count = equations();
    const int columns = std::min(wide_slots, size - first);
    for (std::size_t k = 0; k < weights.size(); ++k) {
      double* rows = entries.block(k) + size * (size + count) + first;
      for (int i = 0; i < count; ++i, rows += size) {
        const auto& derivatives = result.equations[index(i)].derivatives();
        for (int col = 0; col < columns; ++col) rows[col] += weights[k].q * derivatives[col];
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
    JointEvaluation<Scalar> evaluation(topology_, data, time, local.q.data(), local.v.data(),
                                       local.a.data());
    Result<Scalar> result;
    evaluation.evaluate(level, local.lambda.data(), result.equations.data());
    result.forces = evaluation.forces();
    return result;
  }

  JointTopology topology_;
  JointData<double> data_;
  std::unique_ptr<JointData<WideDual>> wide_data_;  ///< once it is needed
  std::vector<DesignDerivative<JointData<Dual>>> derivatives_;
  std::vector<int> coordinates_;
};

}  // namespace

std::unique_ptr<Term> make_joint_term(
    JointTopology topology, JointData<double> data,
    std::vector<DesignDerivative<JointData<double>>> derivatives) {
  return std::make_unique<JointTerm>(std::move(topology), std::move(data), derivatives);
}

template <class Scalar>
Eigen::Matrix<Scalar, 6, 1> joint_wrench(const JointTopology& topology,
                                         const JointData<Scalar>& data, double time,
                                         const Scalar* q, const Scalar* lambda) {
  using Evaluation = JointEvaluation<Scalar>;
  // Rates do not matter at position level, but the kinematics wants them.
  typename Evaluation::Kinematics::Coordinates rest;
  rest.fill(Scalar(0));
  std::vector<Scalar> equations(topology.equations.size());
  Evaluation evaluation(topology, data, time, q, rest.data(), rest.data());
  evaluation.evaluate(ConstraintLevel::position, lambda, equations.data());
  Eigen::Matrix<Scalar, 6, 1> result;
  result << evaluation.wrench().force, evaluation.wrench().moment;
  return result;
}

template Eigen::Matrix<double, 6, 1> joint_wrench(const JointTopology&, const JointData<double>&,
                                                  double, const double*, const double*);
template Eigen::Matrix<Dual, 6, 1> joint_wrench(const JointTopology&, const JointData<Dual>&,
                                                double, const Dual*, const Dual*);
template Eigen::Matrix<WideDual, 6, 1> joint_wrench(const JointTopology&,
                                                    const JointData<WideDual>&, double,
                                                    const WideDual*, const WideDual*);

}  // namespace pleuel
