#pragma once

#include "cli/input/problem_input.hpp"

namespace pleuel {

/// read_input() with steps, elements and effects for the accuracy, where the file or the command line
/// names one; says so in a line. @throws InputError
ProblemInput read_input_with_accuracy(const Arguments& arguments);

}  // namespace pleuel
