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

class Check {
 public:
  Check(const ProblemFile& problem, const Eigen::VectorXd& x, Analysis& analysis,
        const DerivativeCheckOptions& options)
      : problem_(with_steps_of(analysis.trajectory, problem)),
        x_(x),
        options_(options),
        changes_(generic_direction(problem, x)),
        magnitudes_(values_of(analysis).cwiseAbs()),
        direct_(gradients_by(analysis, ExactMethod::direct)),
        adjoint_(gradients_by(analysis, ExactMethod::adjoint)),
        noise_(response_noise(problem_, x, options.threads)),
        has_kink_(problem.responses.size(), false) {
    for (const Kink& kink : find_kinks(analysis, problem.variables))
      has_kink_[kink.response] = true;
  }

  DerivativeChecks run() {
    begin();
    std::vector<Eigen::Index> all(x_.size());
    std::iota(all.begin(), all.end(), Eigen::Index{0});
    divide(all);
    return std::move(checks_);
  }

  DerivativeChecks run(const std::vector<CheckedDirection>& directions) {
    begin();
    for (const CheckedDirection& direction : directions) keep(direction, judge(direction));
    return std::move(checks_);
  }

 private:
  using Judged = std::vector<JudgedDerivative>;  ///< one a response

  static Eigen::MatrixXd gradients_by(Analysis& analysis, ExactMethod method) {
    return sampled_gradients(analysis, response_values(analysis), method);
  }

  void begin() {
    for (Eigen::Index i = 0; i < direct_.rows(); ++i) {
      DerivativeCheck& check = checks_.responses.emplace_back();
      check.adjoint_error = gradient_error(adjoint_.row(i), direct_.row(i), x_, magnitudes_(i));
      check.noise = noise_.floor()(i);
      const double relative = check.noise == 0.0      ? 0.0
                              : magnitudes_(i) == 0.0 ? 1.0
                                                      : check.noise / magnitudes_(i);
      check.relative_noise = std::max(relative, std::numeric_limits<double>::epsilon());
      check.derivatives = direct_.row(i);
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
    CheckedDirection direction{variables, Eigen::VectorXd::Zero(x_.size())};
    for (const Eigen::Index j : variables) direction.change(j) = changes_(j);
    return direction;
  }

  void keep(const CheckedDirection& direction, Judged judged) {
    checks_.directions.push_back(direction);
    for (std::size_t i = 0; i < judged.size(); ++i) {
      checks_.responses[i].directions.push_back(std::move(judged[i]));
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
    if (steps.empty()) throw SimulationError(failure_);
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
    options_.see_differences(simulations);
    std::vector<Eigen::VectorXd> values(simulations);
    std::vector<std::string> failures(simulations);
    for_each_in_parallel(simulations, options_.threads, [&](int i) {
      const double step = i % 2 == 0 ? steps[i / 2] : -steps[i / 2];
      try {
        values[i] = values_of(*analyze(problem_, x_ + step * direction.change, values_only));
      } catch (const SimulationError& error) {
        failures[i] = error.what();
      }
    });
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const std::string& failure = failures[2 * k].empty() ? failures[2 * k + 1] : failures[2 * k];
      if (!failure.empty()) {
        failure_ = failure;
      } else {
        found.push_back({steps[k], (values[2 * k] - values[2 * k + 1]) / (2.0 * steps[k])});
      }
    }
  }

  Judged judge(const CheckedDirection& direction, const std::vector<Step>& steps) const {
    const Eigen::VectorXd derivatives = direct_ * direction.change;
    Judged judged;
    for (Eigen::Index i = 0; i < direct_.rows(); ++i) {
      std::vector<CentralDifference> curve;
      for (const Step& step : steps) curve.push_back({step.step, step.differences(i)});
      judged.push_back(judge_derivative({derivatives(i), 1.0, magnitudes_(i), noise_.scatter(i),
                                         noise_.remainder(i), has_kink_[i]},
                                        std::move(curve)));
    }
    return judged;
  }

  ProblemFile problem_;  ///< with the steps of the analysis
  const Eigen::VectorXd& x_;
  const DerivativeCheckOptions& options_;
  Eigen::VectorXd changes_;  ///< of each variable, along any direction
  Eigen::VectorXd magnitudes_;
  Eigen::MatrixXd direct_, adjoint_;
  ResponseNoise noise_;
  std::vector<bool> has_kink_;
  std::string failure_;  ///< of the last step that failed
  DerivativeChecks checks_;
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
      return Check(tight, x, *analysis, options).run(directions);
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
  const Eigen::MatrixXd again =
      sampled_gradients(*here, response_values(*here), ExactMethod::direct);
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
  DerivativeChecks checks = Check(problem, x, analysis, options).run();
  const bool any_differs = std::ranges::any_of(checks.responses, [](const DerivativeCheck& check) {
    return check.worst().verdict == DerivativeVerdict::differs;
  });
  if (any_differs) {
    excuse_loose_newton(checks, with_steps_of(analysis.trajectory, problem), x, options);
  }
  return checks;
}

}  // namespace pleuel
