#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/scene/kind_table.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel {

/// Indices of the responses that a response is made from and that are no expressions themselves, in
/// increasing order; of one that is no expression its own.
std::vector<std::size_t> parts_of(const ProblemFile& problem, std::size_t response);

/// Names of the responses that are made of one which a condition holds for.
std::vector<std::string> names_made_of(
    const ProblemFile& problem, const std::function<bool(const ResponseSettings&)>& is_meant);

/// Names of the bodies that a response is about, those of its joint with it; none of the whole mechanism.
std::vector<std::string> bodies_about(const ResponseSettings& response, const Scene& scene);

/// Of a response of a joined problem: those of single cases (load_cases.hpp).
std::vector<std::size_t> parts_in_cases(const ProblemFile& joined, std::size_t response);

/// Whether it is an error itself, or is made from one: an energy balance, a drift of constraints.
bool is_monitor(const ProblemFile& problem, std::size_t response);

enum class Extreme { largest, smallest };

/// The responses a, b, … of an expression that is their largest, max(a, b, …), or their smallest, and
/// nothing else; empty of any other response. What is minimized, or has an upper limit, can be pressed
/// down by all of them: the expression has a kink where two are equal, they have not.
std::vector<std::size_t> extreme_parts(const ProblemFile& problem, std::size_t response,
                                       Extreme extreme);

/// A response that an expression depends on as on factor · response, with a number as the factor.
struct LinearPart {
  std::size_t response;
  double factor;
};

/// Those that are no expressions themselves: T and F of "2*T - F/(3 m) + mass*height/(1 kg)". Empty of a response that
/// is no expression.
std::vector<LinearPart> linear_parts(const ProblemFile& problem, std::size_t response);

// The words of problem files for what responses make of a history.

inline constexpr Choice<FatigueCriterion> fatigue_criteria[] = {
    {"goodman", FatigueCriterion::goodman},
    {"gerber", FatigueCriterion::gerber},
    {"soderberg", FatigueCriterion::soderberg},
};

inline constexpr Choice<OverTime> over_time_kinds[] = {
    {"max", OverTime::max},     {"min", OverTime::min},   {"max-abs", OverTime::max_abs},
    {"rms", OverTime::rms},     {"mean", OverTime::mean}, {"integral", OverTime::integral},
    {"final", OverTime::final},
};

/// Whether a response is made from masses and variables only.
bool depends_on_masses_only(const ProblemFile& problem, std::size_t response);

}  // namespace pleuel
