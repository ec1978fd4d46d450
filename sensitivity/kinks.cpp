#include "sensitivity/kinks.hpp"

#include "sensitivity/method_choice.hpp"

namespace pleuel {

namespace {

/// Gradients of two peaks that differ by less move alike, as far as an optimizer can tell.
constexpr double alike = 1e-2;

}  // namespace

std::vector<Kink> find_kinks(Analysis& analysis) {
  std::vector<SampledValue> values;  // of each response with ties: its value, then its other peaks
  for (std::size_t i = 0; i < analysis.reductions.size(); ++i) {
    const Reduction& reduction = analysis.reductions[i];
    if (reduction.ties.empty()) continue;
    values.push_back({i, reduction.samples});
    for (const PeakTie& tie : reduction.ties) values.push_back({i, tie.other_samples});
  }
  std::vector<Kink> kinks;
  if (values.empty()) return kinks;
  const Eigen::MatrixXd gradients =
      sampled_gradients(analysis, values, choose_method(analysis, values).method);
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < analysis.reductions.size(); ++i) {
    const Reduction& reduction = analysis.reductions[i];
    if (reduction.ties.empty()) continue;
    const Eigen::RowVectorXd own = gradients.row(row++);
    for (const PeakTie& tie : reduction.ties) {
      const double size = own.norm();
      const double difference = size > 0.0 ? (gradients.row(row) - own).norm() / size : 0.0;
      if (difference > alike) kinks.push_back({i, tie, difference});
      ++row;
    }
  }
  return kinks;
}

}  // namespace pleuel
