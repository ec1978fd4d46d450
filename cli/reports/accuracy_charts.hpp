#pragma once

#include "cli/text/log_log_chart.hpp"
#include "studies/accuracy_optimum.hpp"

/// Work–precision diagrams: time of each setting against its error.
namespace pleuel {

/// Time of a simulation against the largest error of the values that count.
LogLogChart value_chart(const ProblemFile& problem, const AccuracyStudy& study);

/// Time of a simulation with all gradients against the largest error of those that count.
/// @pre the problem has variables
LogLogChart gradient_chart(const ProblemFile& problem, const AccuracyStudy& study);

/// Time of a whole optimization against the error of its optimum.
LogLogChart optimum_chart(const ProblemFile& problem, const OptimumStudy& optima);

}  // namespace pleuel
