#include "sensitivity/kinks.hpp"

#include <algorithm>

#include "core/base/eager_matrices.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/method_choice.hpp"

namespace pleuel {

namespace {

/// The other peaks of all ties, in the order of the responses.
std::vector<SampledValue> other_peaks(const Analysis& analysis) {
  std::vector<SampledValue> values;
  for (std::size_t i = 0; i < analysis.reductions.size(); ++i) {
    for (const PeakTie& tie : analysis.reductions[i].ties) {
      values.push_back({i, tie.other_samples});
    }
  }
  return values;
}

/// @param own     gradients of the responses that have ties, a row each
/// @param others  those of their other peaks
std::vector<Kink> kinks_of(const Analysis& analysis, const std::vector<DesignVariable>& variables,
                           const Eigen::MatrixXd& own, const Eigen::MatrixXd& others) {
  const Eigen::VectorXd scales = step_scales(variables, analysis.x);
  std::vector<Kink> kinks;
  Eigen::Index first = 0, row = 0;
  for (std::size_t i = 0; i < analysis.reductions.size(); ++i) {
    const Reduction& reduction = analysis.reductions[i];
    if (reduction.ties.empty()) continue;
    const Eigen::RowVectorXd gradient = own.row(first++);
    for (const PeakTie& tie : reduction.ties) {
      const double difference = gradient_difference(gradient, others.row(row), scales);
      if (difference > least_kink) kinks.push_back({i, tie, difference});
      ++row;
    }
  }
  return kinks;
}

/// Responses that have ties.
std::vector<Eigen::Index> tied_responses(const Analysis& analysis) {
  std::vector<Eigen::Index> tied;
  for (std::size_t i = 0; i < analysis.reductions.size(); ++i) {
    if (!analysis.reductions[i].ties.empty()) tied.push_back(i);
  }
  return tied;
}

}  // namespace

double gradient_difference(const Eigen::RowVectorXd& g, const Eigen::RowVectorXd& h,
                           const Eigen::VectorXd& scales) {
  const auto size = [&](const Eigen::RowVectorXd& gradient) {
    return gradient.cwiseProduct(scales.transpose()).norm();
  };
  const double largest = std::max(size(g), size(h));
  return largest > 0.0 ? size(g - h) / largest : 0.0;
}

std::vector<Kink> find_kinks(Analysis& analysis, const std::vector<DesignVariable>& variables) {
  std::vector<SampledValue> values;
  for (const std::size_t i : tied_responses(analysis)) {
    values.push_back({i, analysis.reductions[i].samples});
  }
  if (values.empty()) return {};
  const Eigen::Index own = values.size();
  const std::vector<SampledValue> others = other_peaks(analysis);
  values.insert(values.end(), others.begin(), others.end());
  const Eigen::MatrixXd gradients =
      sampled_gradients(analysis, values, choose_method(analysis, values).method);
  return kinks_of(analysis, variables, gradients.topRows(own), gradients.bottomRows(others.size()));
}

GradientsAndKinks gradients_and_kinks(Analysis& analysis,
                                      const std::vector<DesignVariable>& variables,
                                      ExactMethod method) {
  std::vector<SampledValue> values = response_values(analysis);
  const Eigen::Index responses = values.size();
  const std::vector<SampledValue> others = other_peaks(analysis);
  values.insert(values.end(), others.begin(), others.end());
  const Eigen::MatrixXd all = sampled_gradients(analysis, values, method);
  const Eigen::MatrixXd gradients = all.topRows(responses);
  return {gradients, kinks_of(analysis, variables, gradients(tied_responses(analysis), Eigen::all),
                              all.bottomRows(others.size()))};
}

}  // namespace pleuel
