#include "studies/derivative_check.hpp"

#include <array>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/relative_error.hpp"
#include "core/jobs/parallel.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/kinks.hpp"
#include "sensitivity/sampled_gradients.hpp"
#include "studies/noise.hpp"

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

constexpr double first_steps[] = {1e-5, 1e-4, 1e-6, 1e-3}, further_steps[] = {1e-7, 1e-2, 1e-8};

/// Where newton_tolerance is suspected to be too loose: the tightest that Newton's method reaches.
constexpr double tight_tolerances[] = {1e-12, 1e-10};
/// A derivative that is computed anew at the same design is the same to this.
constexpr double same_derivative = 1e-6;

/// Of each response, whether it has one near the design.
std::vector<bool> kinks_at(const ProblemFile& problem, Analysis& analysis) {
  std::vector<bool> has_kink(problem.responses.size(), false);
  for (const Kink& kink : find_kinks(analysis, problem.variables)) has_kink[kink.response] = true;
  return has_kink;
}

struct Check {
  const ProblemFile problem;  ///< with the steps of the analysis
  const Eigen::VectorXd& x;
  Analysis& analysis;
  const DerivativeCheckOptions& options;
  /// Of each variable, along any direction.
  Eigen::VectorXd changes = generic_direction(problem, x);
  Eigen::VectorXd magnitudes = values_of(analysis).cwiseAbs();
  Eigen::MatrixXd direct = direct_gradients(analysis);
  Eigen::MatrixXd adjoint =
      sampled_gradients(analysis, response_values(analysis), ExactMethod::adjoint);
  ResponseNoise noise = response_noise(problem, x, options.threads);
  std::vector<bool> has_kink = kinks_at(problem, analysis);
  std::string failure = {};  ///< of the last step that failed
  DerivativeChecks checks = {};

  DerivativeChecks run() {
    begin();
    std::vector<Eigen::Index> all(x.size());
    std::iota(all.begin(), all.end(), Eigen::Index{0});
    divide(all);
    return std::move(checks);
  }

  DerivativeChecks run(const std::vector<CheckedDirection>& directions) {
    begin();
    for (const CheckedDirection& direction : directions) keep(direction, judge(direction));
    return std::move(checks);
  }

 private:
  using Judged = std::vector<JudgedDerivative>;  ///< one a response

  void begin() {
    for (Eigen::Index i = 0; i < direct.rows(); ++i) {
      DerivativeCheck& check = checks.responses.emplace_back();
      check.adjoint_error = gradient_error(adjoint.row(i), direct.row(i), x, magnitudes(i));
      check.noise = noise.floor()(i);
      const double relative = check.noise == 0.0     ? 0.0
                              : magnitudes(i) == 0.0 ? 1.0
                                                     : check.noise / magnitudes(i);
      check.relative_noise = std::max(relative, std::numeric_limits<double>::epsilon());
      check.derivatives = direct.row(i);
    }
  }

  void divide(const std::vector<Eigen::Index>& variables) {
    const CheckedDirection direction = direction_along(variables);
    Judged judged = judge(direction);
    if (variables.size() == 1 ||
        std::ranges::count(judged, DerivativeVerdict::differs, &JudgedDerivative::verdict) == 0) {
      return keep(direction, std::move(judged));
    }
    const auto middle = variables.begin() + std::ssize(variables) / 2;
    divide({variables.begin(), middle});
    divide({middle, variables.end()});
  }

  CheckedDirection direction_along(const std::vector<Eigen::Index>& variables) const {
    CheckedDirection direction{variables, Eigen::VectorXd::Zero(x.size())};
    for (const Eigen::Index j : variables) direction.change(j) = changes(j);
    return direction;
  }

  void keep(const CheckedDirection& direction, Judged judged) {
    checks.directions.push_back(direction);
    for (std::size_t i = 0; i < judged.size(); ++i) {
      checks.responses[i].directions.push_back(std::move(judged[i]));
    }
  }

  Judged judge(const CheckedDirection& direction) {
    std::vector<Step> steps;
    add_differences(direction, first_steps, steps);
    if (!steps.empty()) {
      Judged judged = judge(direction, steps);
      const auto agreed =
          std::ranges::count(judged, DerivativeVerdict::agrees, &JudgedDerivative::verdict);
      if (agreed == std::ssize(judged)) return judged;
    }
    add_differences(direction, further_steps, steps);
    if (steps.empty()) throw SimulationError(failure);
    return judge(direction, steps);
  }

  struct Step {
    double step;
    Eigen::VectorXd differences;  ///< one a response
  };

  /// Of steps at which nothing fails.
  void add_differences(const CheckedDirection& direction, std::span<const double> steps,
                       std::vector<Step>& found) {
    const int simulations = 2 * static_cast<int>(steps.size());
    options.see_differences(simulations);
    std::vector<Eigen::VectorXd> values(simulations);
    std::vector<std::string> failures(simulations);
    for_each_in_parallel(simulations, options.threads, [&](int i) {
      const double step = i % 2 == 0 ? steps[i / 2] : -steps[i / 2];
      try {
        values[i] = values_of(*analyze(problem, x + step * direction.change, values_only));
      } catch (const SimulationError& error) {
        failures[i] = error.what();
      }
    });
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const std::string& reason = failures[2 * k].empty() ? failures[2 * k + 1] : failures[2 * k];
      if (!reason.empty()) {
        failure = reason;
      } else {
        found.push_back({steps[k], (values[2 * k] - values[2 * k + 1]) / (2.0 * steps[k])});
      }
    }
  }

  Judged judge(const CheckedDirection& direction, const std::vector<Step>& steps) const {
    const Eigen::VectorXd derivatives = direct * direction.change;
    Judged judged;
    for (Eigen::Index i = 0; i < direct.rows(); ++i) {
      std::vector<CentralDifference> curve;
      for (const Step& step : steps) curve.push_back({step.step, step.differences(i)});
      judged.push_back(judge_derivative(
          {derivatives(i), 1.0, magnitudes(i), noise.scatter(i), noise.remainder(i), has_kink[i]},
          std::move(curve)));
    }
    return judged;
  }
};

/// The same checks with Newton's method carried further; none where it does not come so far.
DerivativeChecks tight_checks(ProblemFile problem, const Eigen::VectorXd& x,
                              const std::vector<CheckedDirection>& directions,
                              const DerivativeCheckOptions& options) {
  for (const double tolerance : tight_tolerances) {
    if (problem.simulation.newton_tolerance <= tolerance) continue;
    ProblemFile tight = problem;
    tight.simulation.newton_tolerance = tolerance;
    try {
      const auto analysis = analyze(tight, x);
      const ProblemFile same_steps = with_steps_of(analysis->trajectory, tight);
      return Check{same_steps, x, *analysis, options}.run(directions);
    } catch (const SimulationError&) {
      continue;
    }
  }
  return {};
}

/// See check_derivatives().
void excuse_loose_newton(DerivativeChecks& checks, const ProblemFile& problem,
                         const Eigen::VectorXd& x, const DerivativeCheckOptions& options) {
  const auto here = analyze(problem, x);
  const Eigen::MatrixXd again = direct_gradients(*here);
  const DerivativeChecks tight = tight_checks(problem, x, checks.directions, options);
  for (std::size_t i = 0; i < tight.responses.size(); ++i) {
    for (std::size_t k = 0; k < checks.directions.size(); ++k) {
      JudgedDerivative& loose = checks.responses[i].directions[k];
      const JudgedDerivative& judged = tight.responses[i].directions[k];
      if (loose.verdict != DerivativeVerdict::differs) continue;
      if (judged.verdict == DerivativeVerdict::differs) continue;
      const double repeated = again.row(i).dot(checks.directions[k].change);
      const double change = std::abs(repeated - loose.derivative);
      if (change > same_derivative * std::abs(loose.derivative)) continue;
      loose.verdict = DerivativeVerdict::noise;
      loose.tight_error = judged.error;
    }
  }
}

}  // namespace

std::string to_string(DerivativeVerdict verdict) {
  constexpr std::array<const char*, 4> names = {"agrees", "noise", "kink", "differs"};
  return names[static_cast<std::size_t>(verdict)];
}

JudgedDerivative judge_derivative(const DerivativeEvidence& evidence,
                                  std::vector<CentralDifference> curve) {
  std::ranges::sort(curve, {}, &CentralDifference::step);
  for (CentralDifference& difference : curve) {
    const double distance = std::abs(evidence.derivative - difference.value);
    difference.error =
        distance == 0.0 ? 0.0 : distance / least_derivative(evidence, difference.value);
  }
  const CentralDifference& nearest =
      *std::ranges::min_element(curve, {}, &CentralDifference::error);
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

const JudgedDerivative& DerivativeCheck::worst() const {
  return *std::ranges::max_element(directions, {}, [](const JudgedDerivative& one) {
    return std::pair(one.verdict, one.error);
  });
}

DerivativeChecks check_derivatives(const ProblemFile& problem, const Eigen::VectorXd& x,
                                   Analysis& analysis, const DerivativeCheckOptions& options) {
  const ProblemFile same_steps = with_steps_of(analysis.trajectory, problem);
  DerivativeChecks checks = Check{same_steps, x, analysis, options}.run();
  const bool any_differs = std::ranges::any_of(checks.responses, [](const DerivativeCheck& check) {
    return check.worst().verdict == DerivativeVerdict::differs;
  });
  if (any_differs) {
    excuse_loose_newton(checks, same_steps, x, options);
  }
  return checks;
}

}  // namespace pleuel
