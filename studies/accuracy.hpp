#pragma once

#include "core/base/stopwatch.hpp"
#include "core/jobs/part_store.hpp"
#include "studies/accuracy_knobs.hpp"
#include "studies/accuracy_run.hpp"
#include "studies/row_prices.hpp"

namespace pleuel {

/// Of some runs the fastest simulation whose errors of the responses that count are small enough.
struct Recommendation {
  double target = 0.0;                   ///< relative error
  std::optional<std::size_t> values;     ///< index of a run
  std::optional<std::size_t> gradients;  ///< the same if errors of gradients count as well
};

/// A setting with one thing changed.
struct VariedRun {
  Variation variation;
  AccuracyRun run;
  /// Of a simulation, beside the setting without the change; of the same work 0 ± 0.
  ComparedTime time = {};
  /// Of an effect: changes of the values with it [SI], and of the optimum in `run`, with the steps
  /// and elements of the file.
  Eigen::VectorXd influence = {};
};

/// How the reference is known to be one.
struct ReferenceCheck {
  std::string formulation;  ///< with which it was repeated
  std::string failure;      ///< why that says nothing; empty if it does
  /// Relative differences of the responses between both; 0 of those that are errors of the
  /// integration themselves.
  Eigen::VectorXd differences;
};

struct AccuracyStudy {
  /// Half the finest step, twice the most elements; its errors are estimates.
  AccuracyRun reference;
  ReferenceCheck check;
  std::vector<AccuracyRun> runs;
  std::vector<std::size_t> counted;  ///< responses that are minimized or limited; else all
  /// For the target of the file, and for smaller ones by tens.
  std::vector<Recommendation> recommendations;
  /// The run that knobs are turned at: the first that is recommended, or the most accurate one.
  std::optional<std::size_t> base;
  std::vector<VariedRun> knobs, effects;
  /// Why some of these are missing: the setting that they vary cannot be simulated.
  std::string failure;
  bool is_interrupted = false;  ///< some runs are missing

  /// Largest of the errors that count; 0 of none.
  double counted_error(const Eigen::VectorXd& errors) const;
};

/// Sees the reference first, then each run as it is done.
struct AccuracyObserver {
  std::function<void(const AccuracyRun&)> run = {};
  std::function<void(const VariedRun&)> variation = {};
};

/// Work–precision study at a design: every step with every number of elements against a
/// finer reference, values and gradients; see relative_error.hpp. The error of the reference itself
/// is estimated from another run with 4/3 of its step and 3/4 of its elements (Richardson, order 2:
/// difference / ((4/3)² − 1)), and from one with another formulation of the constraints; the larger
/// counts. What is sampled in space converges unevenly: a run may be closer to the reference than
/// that by luck, and is not called better.
/// Where the design is an optimum (and not the start), Δf + Σ μ_j Δc_j says what each setting makes
/// of it.
/// @param parts  runs that are known; may be null
/// @throws InputError if the problem has no responses
/// @throws SimulationError if the reference fails; a failing run is only marked
/// @throws Stopped if a stop was asked for before the reference was done
AccuracyStudy accuracy_study(const ProblemFile& problem, const PricedDesign& design,
                             const AccuracyObserver& observer = {}, PartStore* parts = nullptr);

/// At the setting that is recommended, knobs are turned and effects are left out, one by one: adds
/// them to the study.
/// @param design  of the study
void vary_settings(const ProblemFile& problem, const PricedDesign& design, AccuracyStudy& study,
                   const AccuracyObserver& observer = {}, PartStore* parts = nullptr);

/// p of errors ~ stepᵖ by least squares, of the most elements of the grid and where the error is
/// above three times that of the reference; none from less than two runs.
/// @param errors  of the values, or of the gradients
std::optional<double> fitted_order(const AccuracyStudy& study,
                                   Eigen::VectorXd AccuracyRun::*errors);

}  // namespace pleuel
