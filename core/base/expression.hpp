#pragma once

#include <string>
#include <vector>

namespace pleuel {

/// What a step of an expression computes from its operands a and b.
enum class Operation {
  constant,
  argument,
  plus,
  minus,
  times,
  over,
  power,
  negated,
  square_root,
  exponential,
  logarithm,
  hyperbolic_tangent,
  sine,
  cosine,
  tangent,
  arc_sine,
  arc_cosine,
  arc_tangent,
  arc_tangent_2,  ///< atan2(a, b): the angle of the point (b, a)
  smaller,
  larger,
  magnitude,
  path  ///< through the values of Expression::path: the first at 0, the next at 1, …
};

/// One operation on the results of earlier steps.
struct ExpressionStep {
  Operation operation = Operation::constant;
  double constant = 0.0;        ///< of a constant [SI]
  int first = -1, second = -1;  ///< operands: earlier steps; of an argument `first` is its index
};

/// What an expression depends on.
struct ExpressionArgument {
  enum class Kind {
    variable,    ///< of the design
    response,    ///< of the file
    time,        ///< t, of laws (core/base/time_law.hpp)
    coordinate,  ///< what a law acts along: an angle, a displacement, an elongation
    rate         ///< of that
  };
  Kind kind = Kind::variable;
  std::size_t index = 0;  ///< of the design variable, or of the response in the file
};

/// A formula of the problem file, taken apart: its value is the result of the last step. In SI
/// units; that they fit was checked when it was read.
struct Expression {
  std::string text;      ///< as the user wrote it
  std::string quantity;  ///< what its value measures: "a length"
  std::string unit;      ///< SI unit of it
  std::vector<ExpressionArgument> arguments;
  std::vector<ExpressionStep> steps;
  std::vector<double> path = {};  ///< what Operation::path goes through (value_path.hpp) [SI]
};

struct ExpressionValue {
  double value = 0.0;
  std::vector<double> derivatives;  ///< by each argument
};

/// Value and exact derivatives (reverse accumulation). min, max and abs have kinks: there the
/// derivatives are those of the side that counts; where both sides are equal, their mean.
/// @param arguments  values in the order of Expression::arguments [SI]
/// @returns numbers that are not finite where the formula has none there, as 1/0 or sqrt(-1)
ExpressionValue evaluate(const Expression& expression, const std::vector<double>& arguments);

}  // namespace pleuel
