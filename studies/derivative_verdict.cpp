#include "studies/derivative_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pleuel {

namespace {

/// Central differences of simulations reach about 1e-8; a wrong term shows as 1e-3 and more.
constexpr double agreement = 1e-6;
constexpr double wrong = 1e-3;
/// Deviations of noise beyond which noise is no excuse.
constexpr double most_deviations = 10.0;

double least_derivative(const DerivativeEvidence& evidence, double difference) {
  return std::max(std::abs(difference), 1e-2 * evidence.response / evidence.size);
}

/// The difference with the least of noise and truncation, and both.
struct BestDifference {
  double value = 0.0, noise = 0.0, truncation = 0.0;
};

/// The largest step shows no truncation: it counts only where it is the only one.
BestDifference best_resolved(const DerivativeEvidence& evidence,
                             const std::vector<CentralDifference>& curve) {
  const auto noise_at = [&](double step) {
    return (evidence.scatter / (std::sqrt(2.0) * step) + evidence.remainder) / evidence.size;
  };
  BestDifference best{curve.back().value, noise_at(curve.back().step), 0.0};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < curve.size(); ++k) {
    const double noise = noise_at(curve[k].step);
    const double below = k > 0 ? std::abs(curve[k].value - curve[k - 1].value) : 0.0;
    const double truncation = std::max(below, std::abs(curve[k].value - curve[k + 1].value));
    if (noise + truncation >= least) continue;
    least = noise + truncation;
    best = {curve[k].value, noise, truncation};
  }
  return best;
}

/// By noise however large it is; by truncation only up to a size that no wrong term has.
bool is_excused(double distance, double nearest_error, const BestDifference& best) {
  const double noise = most_deviations * best.noise;
  return distance <= noise || (nearest_error <= wrong && distance <= noise + best.truncation);
}

}  // namespace

std::string to_string(DerivativeVerdict verdict) {
  switch (verdict) {
    case DerivativeVerdict::agrees:
      return "agrees";
    case DerivativeVerdict::noise:
      return "noise";
    case DerivativeVerdict::kink:
      return "kink";
    default:
      return "differs";
  }
}

JudgedDerivative judge_derivative(const DerivativeEvidence& evidence,
                                  std::vector<CentralDifference> curve) {
  const auto by_step = [](const CentralDifference& a, const CentralDifference& b) {
    return a.step < b.step;
  };
  const auto by_error = [](const CentralDifference& a, const CentralDifference& b) {
    return a.error < b.error;
  };
  std::sort(curve.begin(), curve.end(), by_step);
  for (CentralDifference& difference : curve) {
    const double distance = std::abs(evidence.derivative - difference.value);
    difference.error =
        distance == 0.0 ? 0.0 : distance / least_derivative(evidence, difference.value);
  }
  const CentralDifference& nearest = *std::min_element(curve.begin(), curve.end(), by_error);
  const BestDifference best = best_resolved(evidence, curve);
  const double uncertain = best.noise + best.truncation;
  JudgedDerivative judged;
  judged.derivative = evidence.derivative;
  judged.error = nearest.error;
  judged.step = nearest.step;
  judged.resolution = uncertain == 0.0 ? 0.0 : uncertain / least_derivative(evidence, best.value);
  if (nearest.error <= agreement) {
    judged.verdict = DerivativeVerdict::agrees;
  } else if (evidence.has_kink) {
    judged.verdict = DerivativeVerdict::kink;
  } else if (is_excused(std::abs(evidence.derivative - best.value), nearest.error, best)) {
    judged.verdict = DerivativeVerdict::noise;
  }
  judged.curve = std::move(curve);
  return judged;
}

}  // namespace pleuel
