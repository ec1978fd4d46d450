#include "core/response/composed_signals.hpp"

#include "core/base/int_size.hpp"

namespace pleuel {

ProjectedSignal::ProjectedSignal(std::unique_ptr<Signal> inner, CoordinateMap map, int variables)
    : inner_(std::move(inner)),
      map_(std::move(map)),
      state_(map_),
      local_(map_.size(), int_size(map_.multipliers), variables) {}

void ProjectedSignal::observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) {
  state_.set(map_, state);
  inner_->observe(state_.local, values);
}

void ProjectedSignal::scatter(const Eigen::VectorXd& local, Eigen::VectorXd& all) const {
  const Eigen::VectorXd columns = map_.rows.transpose() * local;
  for (int i = 0; i < map_.columns(); ++i) {
    all(map_.coordinates[i]) += columns(i);
  }
}

void ProjectedSignal::add_gradient(const State& state, int channel, double weight,
                                   SignalGradient& gradient) {
  state_.set(map_, state);
  local_.set_zero();
  inner_->add_gradient(state_.local, channel, weight, local_);
  scatter(local_.q, gradient.q);
  scatter(local_.v, gradient.v);
  scatter(local_.a, gradient.a);
  for (std::size_t i = 0; i < map_.multipliers.size(); ++i) {
    gradient.lambda(map_.multipliers[i]) += local_.lambda(i);
  }
  gradient.design += local_.design;
  for (const auto& [variable, rows] : map_.derivatives) {
    gradient.design(variable) += local_.q.dot(rows * state_.q) + local_.v.dot(rows * state_.v) +
                                 local_.a.dot(rows * state_.a);
  }
}

}  // namespace pleuel
