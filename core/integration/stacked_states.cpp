#include "core/integration/stacked_states.hpp"

#include <cmath>
#include <numbers>

#include "core/mechanism/mechanism.hpp"

namespace pleuel {

StackedStates::StackedStates(const Mechanism& mechanism, double step)
    : n_(mechanism.system->coordinates()),
      rotations_(mechanism.rotations),
      angles_(mechanism.angles),
      units_(4 * n_) {
  const Eigen::VectorXd &scale = mechanism.scale, rate = scale / step;
  units_ << scale, rate, rate / step, rate / step;
}

Eigen::VectorXd StackedStates::change(const SchemeState& from, const SchemeState& to) const {
  Eigen::VectorXd change(4 * n_);
  change << difference(rotations_, to.q, from.q) - whole_turns(angles_, from.q, to.q),
      to.v - from.v, to.a - from.a, to.w - from.w;
  return change.cwiseQuotient(units_);
}

SchemeState StackedStates::moved(const SchemeState& from, const Eigen::VectorXd& change) const {
  const Eigen::VectorXd move = change.cwiseProduct(units_);
  SchemeState to = from;
  advance(rotations_, from.q, move.head(n_), to.q);
  to.v += move.segment(n_, n_);
  to.a += move.segment(2 * n_, n_);
  to.w += move.tail(n_);
  return to;
}

Eigen::MatrixXd StackedStates::stack(const StateSensitivity& s) const {
  Eigen::MatrixXd columns(4 * n_, s.q.cols());
  columns << s.q, s.v, s.a, s.w;
  return units_.cwiseInverse().asDiagonal() * columns;
}

StateSensitivity StackedStates::unstack(const Eigen::MatrixXd& columns) const {
  const Eigen::MatrixXd s = units_.asDiagonal() * columns;
  return {s.topRows(n_), s.middleRows(n_, n_), s.middleRows(2 * n_, n_), s.bottomRows(n_), {}};
}

Eigen::VectorXd whole_turns(const std::vector<int>& angles, const Eigen::VectorXd& from,
                            const Eigen::VectorXd& to) {
  constexpr double turn = 2.0 * std::numbers::pi;
  Eigen::VectorXd turns = Eigen::VectorXd::Zero(from.size());
  for (const int i : angles) turns(i) = turn * std::round((to(i) - from(i)) / turn);
  return turns;
}

}  // namespace pleuel
