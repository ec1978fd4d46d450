#pragma once

#include "core/base/error_bar.hpp"
#include "core/trust/finding.hpp"
#include "optimization/evaluation_store.hpp"

namespace pleuel {

/// What Monte Carlo says of a number.
struct Sampled {
  double mean = 0.0, deviation = 0.0, lowest = 0.0, highest = 0.0;
};

/// How uncertain parameters make a response, to first order:
///     σ² = Σ (g_i σ_i)²,   bounds = value ∓ Σ |g_i| r_i,   g_i = ∂(response)/∂(parameter)
/// for independent parameters with deviations σ_i and half widths r_i.
struct UncertainResponse {
  double value = 0.0;        ///< at the design; to first order the mean [SI]
  double deviation = 0.0;    ///< σ
  double bound = 0.0;        ///< Σ |g_i| r_i: the response lies within value ± bound
  Eigen::VectorXd gradient;  ///< g
  Eigen::VectorXd shares;    ///< (g_i σ_i)²/σ² of each parameter; zero if σ is
  std::optional<Sampled> sampled;
};

/// @param gradient  by all variables of the problem
UncertainResponse first_order(const UncertaintySettings& settings, double value,
                              const Eigen::VectorXd& gradient);

/// The history of a signal at the place where its response is taken, with its deviation at every
/// instant.
struct UncertainHistory {
  std::size_t response;
  Eigen::VectorXd values, deviations;  ///< one an instant [SI]
  Eigen::VectorXd sampled_deviations;  ///< by Monte Carlo; empty where they are not asked for
};

/// One side of a limit on a response that scatters.
struct LimitScatter {
  std::size_t constraint = 0, response = 0;
  bool is_upper = true;
  double limit = 0.0;     ///< [SI]
  double worst = 0.0;     ///< the response with all parameters at their worst, to first order [SI]
  double distance = 0.0;  ///< of the value to the limit in deviations; negative beyond it
  int broken = 0;         ///< samples that break it
};

struct UncertaintyStudy {
  Eigen::VectorXd time;                      ///< of the histories [s]
  std::vector<UncertainResponse> responses;  ///< as in the problem
  std::vector<UncertainHistory> histories;   ///< of those that have one
  std::vector<LimitScatter> limits;          ///< in the order of the file
  int samples = 0;                           ///< that could be simulated
  int failures = 0;                          ///< that could not
  bool is_interrupted = false;               ///< before all samples were simulated
  std::vector<Finding> findings;             ///< about the values at the design
  /// Of the values, by steps and elements; one a response, empty where they are not checked.
  std::vector<std::optional<ErrorBar>> errors;
  double gradient_seconds = 0.0, sampling_seconds = 0.0;
};

/// Called before the first sample and after each batch, with the number done and about how long the
/// others take [s].
using SampleObserver = std::function<void(int done, double seconds_left)>;

/// What is taken of each sample. Histories are thousands of numbers each.
enum class SampledNumbers { values, histories };

/// First-order second-moment analysis about the start design, and Monte Carlo with so many samples
/// as the settings ask for as the check. Samples are tasks (core/jobs/tasks.hpp): those of a process
/// that crashes count as ones that could not be simulated.
/// @param execution  of the samples; the numbers do not depend on it
/// @param numbers    of samples: with histories, these have sampled deviations, too
/// @throws InputError if the problem has no uncertainty settings
/// @throws SimulationError if the design itself cannot be simulated
/// @throws Stopped if a stop was asked for before the first-order results were there
UncertaintyStudy uncertainty_study(const ProblemFile& problem, const Execution& execution,
                                   const SampleObserver& observer = {},
                                   SampledNumbers numbers = SampledNumbers::values);

/// The samples, made again on another rank (PackedWork).
inline constexpr const char* sample_work_name = "samples";
std::unique_ptr<TaskWork> make_sample_work(const std::string& content);

}  // namespace pleuel
