#pragma once

#include "core/scene/choices.hpp"
#include "core/scene/problem_file.hpp"

/// The words of problem files for what responses make of a history.
namespace pleuel {

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

}  // namespace pleuel
