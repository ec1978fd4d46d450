#include "sensitivity/sampled_gradients.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>

#include "core/base/int_size.hpp"
#include "core/response/history_reduction.hpp"
#include "core/response/linearized_expression.hpp"
#include "sensitivity/adjoint.hpp"
#include "sensitivity/direct.hpp"
#include "sensitivity/frequency_sensitivity.hpp"
#include "sensitivity/initial_sensitivity.hpp"

namespace pleuel {

std::string to_string(ExactMethod method) {
  return method == ExactMethod::direct ? "direct" : "adjoint";
}

namespace {

using Gradients = Eigen::MatrixXd;  // values × variables

/// Of the parameter adjoints that are kept on the way back. More functions than fit into it take
/// the way several times; its linear systems are cheap beside their many right-hand sides.
constexpr Eigen::Index most_adjoint_bytes = 48 << 20;

/// Part of a value: samples of the signal of one response that is no expression.
struct Part {
  std::size_t response;
  std::vector<Sample> samples;
  double weight;
};

/// What samples are samples of.
enum class SamplesOf { history, signal };

std::vector<Sample> samples_of_signal(const Analysis& analysis, const SampledValue& value,
                                      SamplesOf of) {
  if (of == SamplesOf::signal) return value.samples;
  return observed_samples(analysis.responses[value.response], analysis.trajectory.time,
                          value.samples);
}

/// A value itself, or what its expression is made from.
std::vector<Part> parts_of(const Analysis& analysis, const SampledValue& value,
                           SamplesOf of = SamplesOf::history) {
  if (!analysis.responses[value.response].expression()) {
    return {{value.response, samples_of_signal(analysis, value, of), 1.0}};
  }
  std::vector<Part> parts;
  for (const WeightedResponse& one : linearized(analysis, value.response).parts) {
    const auto replaced = std::ranges::find(value.replaced, one.response, &SampledValue::response);
    const SampledValue part =
        replaced != value.replaced.end()
            ? *replaced
            : SampledValue{one.response, analysis.reductions[one.response].samples};
    parts.push_back(
        {one.response, samples_of_signal(analysis, part, SamplesOf::history), one.weight});
  }
  return parts;
}

/// A sample of a value at a step that is known.
struct WeightedSample {
  Eigen::Index value;
  Signal* signal;
  int channel;
  double weight;
};

class SampledGradients {
 public:
  SampledGradients(Analysis& analysis, const std::vector<SampledValue>& values, SamplesOf of)
      : analysis_(analysis),
        mechanism_(analysis.model.mechanism),
        gradients_(Gradients::Zero(values.size(), mechanism_.system->variables())),
        part_(mechanism_.system->coordinates(), mechanism_.system->multipliers(),
              mechanism_.system->variables()) {
    if (!analysis.model.has_derivatives) {
      throw std::logic_error("an analysis of values only is differentiated");
    }
    for (std::size_t i = 0; i < values.size(); ++i) add_value(i, values[i], of);
  }

  Gradients direct() {
    if (uses_.empty() || gradients_.cols() == 0) return gradients_;
    const int last_step = uses_.rbegin()->first;
    const auto is_any = [](const WeightedSample&) { return true; };
    differentiate_until(last_step, mechanism_, analysis_.trajectory,
                        [&](int step, const State& state, const StateSensitivity& s) {
                          for_each_use(step, state, is_any, [&](const WeightedSample& use) {
                            gradients_.row(use.value) +=
                                part_.q.transpose() * s.q + part_.v.transpose() * s.v +
                                part_.a.transpose() * s.a + part_.lambda.transpose() * s.lambda +
                                part_.design.transpose();
                          });
                        });
    return gradients_;
  }

  Gradients adjoint() {
    if (uses_.empty() || gradients_.cols() == 0) return gradients_;
    const std::vector<Eigen::Index> order = latest_first();
    const Eigen::Index count = order.size();
    const Eigen::Index most = most_functions_at_once();
    for (Eigen::Index first = 0; first < count; first += most) {
      add_adjoint({order.begin() + first, order.begin() + std::min(first + most, count)});
    }
    return gradients_;
  }

 private:
  /// The parameter adjoints of each function wait for the end of the way back.
  Eigen::Index most_functions_at_once() const {
    const Eigen::Index numbers = mechanism_.system->parameter_adjoint_count();
    const auto most = most_adjoint_bytes / static_cast<Eigen::Index>(sizeof(double));
    return std::max<Eigen::Index>(1, most / std::max<Eigen::Index>(1, numbers));
  }

  /// @param order  values, those of which the last sample comes latest first
  void add_adjoint(const std::vector<Eigen::Index>& order) {
    std::vector<Eigen::Index> column(gradients_.rows(), -1);
    for (std::size_t i = 0; i < order.size(); ++i) {
      column[order[i]] = static_cast<Eigen::Index>(i);
    }
    Eigen::Index active = 0;
    const auto set = [&](int step, const State& state, StateAdjoint& adjoint) {
      for_each_use(
          step, state, [&](const WeightedSample& use) { return column[use.value] >= 0; },
          [&](const WeightedSample& use) {
            const Eigen::Index j = column[use.value];
            active = std::max(active, j + 1);
            adjoint.q.col(j) += part_.q;
            adjoint.v.col(j) += part_.v;
            adjoint.a.col(j) += part_.a;
            adjoint.lambda.col(j) += part_.lambda;
            gradients_.row(use.value) += part_.design.transpose();
          });
      return static_cast<int>(active);
    };
    const Eigen::MatrixXd found =
        adjoint_gradients(mechanism_, analysis_.trajectory, int_size(order), set);
    for (std::size_t i = 0; i < order.size(); ++i) {
      gradients_.row(order[i]) += found.col(i).transpose();
    }
  }

  void add_value(std::size_t i, const SampledValue& value, SamplesOf of) {
    const Eigen::Index row = i;
    if (analysis_.responses[value.response].expression()) {
      require_derivatives(analysis_, value.response);
      gradients_.row(row) += linearized(analysis_, value.response).design.transpose();
    }
    for (const Part& part : parts_of(analysis_, value, of)) add_part(row, part);
  }

  void add_part(Eigen::Index row, const Part& part) {
    const Response& response = analysis_.responses[part.response];
    if (const auto* constant = std::get_if<DesignConstant>(&response.source)) {
      gradients_.row(row) += part.weight * constant->derivatives.transpose();
    } else if (response.mode()) {
      gradients_.row(row) += part.weight * frequency_gradient(*response.mode());
    } else {
      Signal* signal = response.history()->signal.get();
      for (const Sample& sample : part.samples) {
        uses_[sample.step].push_back({row, signal, sample.channel, part.weight * sample.weight});
      }
    }
  }

  Eigen::RowVectorXd frequency_gradient(const ModeChoice& choice) {
    if (gradients_.cols() == 0) return Eigen::RowVectorXd(0);
    Model& model = analysis_.full ? analysis_.full->model : analysis_.model;
    const InitialState& about = analysis_.vibrating->initial;
    if (!about_sensitivity_) about_sensitivity_ = initial_sensitivity(model.mechanism, about);
    return frequency_sensitivity(model, about.state, *about_sensitivity_, choice).transpose();
  }

  /// Calls visit(use) for what is sampled at a step and wanted, with its derivatives in part_.
  template <class Wanted, class Visit>
  void for_each_use(int step, const State& state, const Wanted& is_wanted, const Visit& visit) {
    const auto found = uses_.find(step);
    if (found == uses_.end()) return;
    for (const WeightedSample& use : found->second) {
      if (!is_wanted(use)) continue;
      part_.set_zero();
      use.signal->add_gradient(state, use.channel, use.weight, part_);
      visit(use);
    }
  }

  /// The values with samples; those of which the last one comes latest come first: going back in
  /// time they are the first to count.
  std::vector<Eigen::Index> latest_first() const {
    std::vector<Eigen::Index> order;
    for (auto step = uses_.rbegin(); step != uses_.rend(); ++step) {
      for (const WeightedSample& use : step->second) {
        if (std::find(order.begin(), order.end(), use.value) == order.end()) {
          order.push_back(use.value);
        }
      }
    }
    return order;
  }

  Analysis& analysis_;
  Mechanism& mechanism_;
  Gradients gradients_;
  std::map<int, std::vector<WeightedSample>> uses_;  ///< by step
  SignalGradient part_;                              ///< scratch
  /// Of the state about which the mechanism vibrates, where frequencies are asked for.
  std::optional<StateSensitivity> about_sensitivity_;
};

/// What is measured in the mechanism without elasticity, and which of the values it is taken from.
struct RigidValues {
  std::vector<SampledValue> values;
  std::vector<Eigen::Index> rows;
  std::vector<double> weights;
};

RigidValues rigid_values(const Analysis& analysis, const std::vector<SampledValue>& values,
                         SamplesOf of) {
  RigidValues rigid;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (const Part& part : parts_of(analysis, values[i], of)) {
      const ResponseHistory* history = analysis.responses[part.response].history();
      if (!history || !history->rigid_response) continue;
      rigid.values.push_back({*history->rigid_response, part.samples});
      rigid.rows.push_back(i);
      rigid.weights.push_back(part.weight);
    }
  }
  return rigid;
}

Gradients gradients_of(Analysis& analysis, const std::vector<SampledValue>& values,
                       ExactMethod method, SamplesOf of) {
  SampledGradients run(analysis, values, of);
  Gradients gradients = method == ExactMethod::direct ? run.direct() : run.adjoint();
  const RigidValues rigid = rigid_values(analysis, values, of);
  if (rigid.values.empty()) return gradients;
  const Gradients found = gradients_of(*analysis.rigid, rigid.values, method, SamplesOf::signal);
  for (std::size_t i = 0; i < rigid.rows.size(); ++i) {
    gradients.row(rigid.rows[i]) -= rigid.weights[i] * found.row(i);
  }
  return gradients;
}

}  // namespace

Eigen::MatrixXd sampled_gradients(Analysis& analysis, const std::vector<SampledValue>& values,
                                  ExactMethod method) {
  return gradients_of(analysis, values, method, SamplesOf::history);
}

Eigen::MatrixXd observed_gradients(Analysis& analysis, const std::vector<SampledValue>& values,
                                   ExactMethod method) {
  return gradients_of(analysis, values, method, SamplesOf::signal);
}

int last_step(const Analysis& analysis, const SampledValue& value) {
  int last = -1;
  for (const Part& part : parts_of(analysis, value)) {
    for (const Sample& sample : part.samples) last = std::max(last, sample.step);
  }
  return last;
}

std::vector<SampledValue> response_values(const Analysis& analysis) {
  std::vector<SampledValue> values;
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    values.push_back({i, analysis.reductions[i].samples});
  }
  return values;
}

}  // namespace pleuel
