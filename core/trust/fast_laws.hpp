#pragma once

#include <complex>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Loads and drives that change faster than the steps can follow: what acts between two instants is
/// not seen, however well energy is balanced. And drives whose speed jumps.
std::vector<Finding> check_fast_laws(const TrustedRun& run);

/// The same of the start design before a simulation, whose equal steps the file says; nothing where
/// steps follow an error.
std::vector<Finding> check_fast_laws_before(const ProblemFile& problem);

// What happens between the instants of a simulation, which sees the instants only.

/// A number, or a direction in a plane.
using ObservedFunction = std::function<std::complex<double>(double time)>;

/// How far a function of time is from the straight lines between the instants, and where most.
struct MissedValues {
  double largest = 0.0, time = 0.0, step = 0.0;
  /// Medians of the largest of each step, and of that from the lines between its ends and its middle:
  /// a quarter of it where steps resolve the function, no less where it swings within each.
  double median = 0.0, median_of_halves = 0.0;
  double scale = 0.0;  ///< largest distance from a value
};

/// @param time   the instants [s]
/// @param knots  ascending: times that are looked at besides some in each step
MissedValues missed_by(const Eigen::VectorXd& time, const ObservedFunction& value,
                       const std::vector<double>& knots);

/// What is said of a law: who, and what of it.
struct MissedSubject {
  std::string who;   ///< `the load "push"`
  std::string what;  ///< "value"
  double most;       ///< share of the scale that may be missed
};

/// A serious finding where more than may be is missed.
void add_missed(const MissedSubject& subject, const MissedValues& missed, double scale,
                std::vector<Finding>& findings);

/// Bodies that nothing drives and that turn by more than a quarter of a turn within a step: at whole
/// turns a step they seem to stand still.
std::vector<Finding> check_fast_turning(const TrustedRun& run);

}  // namespace pleuel
