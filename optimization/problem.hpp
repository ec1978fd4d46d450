#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/base/error.hpp"

/// The one interface between what is optimized and what optimizes it:
///
///     minimize f(x)   subject to   lower ≤ c(x) ≤ upper,   lower ≤ x ≤ upper
///
/// Everything is in SI units. Scaling, one-sided rows, and caching are the business of the
/// optimizer (backends.hpp, evaluation_cache.hpp).
namespace pleuel {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
/// Bounds and limits beyond this are a habit of writing "none".
inline constexpr double practically_infinite = 1e19;

/// A number of the design that the optimizer may choose; lower == upper fixes it.
struct Variable {
  std::string name;
  double start = 0.0;
  double lower = -infinity;
  double upper = infinity;
  /// A change of it that is of order one; 0: follows from its value and its bounds (scaling.hpp).
  double magnitude = 0.0;

  bool is_fixed() const { return lower == upper; }
  bool has_lower() const { return lower > -practically_infinite; }
  bool has_upper() const { return upper < practically_infinite; }
};

/// lower ≤ c(x) ≤ upper on the raw value of a response; lower == upper asks for equality.
struct Constraint {
  std::string name;
  double lower = -infinity;
  double upper = infinity;

  bool is_equality() const { return lower == upper; }
  bool has_lower() const { return lower > -practically_infinite; }
  bool has_upper() const { return upper < practically_infinite; }
  /// How far a value is beyond the limits; below 0 it keeps them, by that much.
  double excess(double value) const { return std::max(value - upper, lower - value); }
};

/// What is known of one design. Gradients are empty unless they were requested.
struct Evaluation {
  double objective = 0.0;
  Eigen::VectorXd constraints;          ///< raw values c, size = number of constraints
  Eigen::VectorXd objective_gradient;   ///< size = number of variables
  Eigen::MatrixXd constraint_jacobian;  ///< constraints × variables

  bool has_gradients() const { return objective_gradient.size() > 0; }
};

enum class Request { values, values_and_gradients };

/// This design cannot be evaluated: the optimizer must look elsewhere. Every SimulationError counts
/// as such, and so does a value or gradient that is not finite.
class EvaluationFailure : public SimulationError {
 public:
  using SimulationError::SimulationError;
};

/// Makes variables start at a design.
void set_start(std::vector<Variable>& variables, const Eigen::VectorXd& x);

/// Something to optimize.
class Problem {
 public:
  virtual ~Problem() = default;

  virtual const std::vector<Variable>& variables() const = 0;
  virtual const std::vector<Constraint>& constraints() const = 0;
  virtual std::string objective_name() const = 0;

  /// Values with their units, for messages: "1.18 mm". By default the bare number.
  virtual std::string variable_text(std::size_t variable, double value) const;
  virtual std::string constraint_text(std::size_t constraint, double value) const;

  /// Values, and gradients if requested, of the design x (within its bounds). Backends often ask
  /// for the gradients of the very design whose values they saw last: keep its simulation.
  /// @throws EvaluationFailure or any other SimulationError if the design cannot be evaluated.
  virtual Evaluation evaluate(const Eigen::VectorXd& x, Request request) = 0;
};

/// A problem whose evaluation is a function object: one by itself, or made of another one.
class FunctionProblem : public Problem {
 public:
  using Function = std::function<Evaluation(const Eigen::VectorXd& x, Request request)>;

  FunctionProblem(std::vector<Variable> variables, std::vector<Constraint> constraints,
                  Function function)
      : variables_(std::move(variables)),
        constraints_(std::move(constraints)),
        function_(std::move(function)) {}

  /// With the variables, the limits and the words of another problem, which must outlive this.
  FunctionProblem(const Problem& of, Function function)
      : of_(&of), constraints_(of.constraints()), function_(std::move(function)) {}

  /// Begins at another design.
  void start_from(const Eigen::VectorXd& x) {
    variables_ = variables();
    set_start(*variables_, x);
  }

  const std::vector<Variable>& variables() const override {
    return variables_ ? *variables_ : of_->variables();
  }
  const std::vector<Constraint>& constraints() const override { return constraints_; }
  std::string objective_name() const override { return of_ ? of_->objective_name() : "objective"; }
  std::string variable_text(std::size_t variable, double value) const override {
    return of_ ? of_->variable_text(variable, value) : Problem::variable_text(variable, value);
  }
  std::string constraint_text(std::size_t constraint, double value) const override {
    return of_ ? of_->constraint_text(constraint, value)
               : Problem::constraint_text(constraint, value);
  }
  Evaluation evaluate(const Eigen::VectorXd& x, Request request) override {
    return function_(x, request);
  }

 private:
  const Problem* of_ = nullptr;
  std::optional<std::vector<Variable>> variables_;
  std::vector<Constraint> constraints_;
  Function function_;
};

/// The outcome of an evaluation that may fail: the evaluation, or why there is none.
struct Attempt {
  std::optional<Evaluation> evaluation;
  std::string failure;
};

/// Evaluates and turns a SimulationError, or a number that is not finite, into a failure.
/// Anything else that is thrown is a fault of the program and passes through.
Attempt attempt_evaluation(Problem& problem, const Eigen::VectorXd& x, Request request);

/// The start values of all variables as they are.
Eigen::VectorXd start_of(const Problem& problem);

/// The start values of all variables, moved onto a bound that they miss by rounding only.
/// @throws InputError if there is no variable, if bounds or limits contradict each other or are not
///         numbers, or if a start lies outside its bounds; the message names the variable.
Eigen::VectorXd checked_start(const Problem& problem);

/// The nearest design within the bounds.
Eigen::VectorXd within_bounds(const Problem& problem, Eigen::VectorXd x);

/// "width = 20 mm, height = 30 mm": a design for messages.
std::string describe_design(const Problem& problem, const Eigen::VectorXd& x);

/// Designs that fill the space between the bounds evenly: a Latin hypercube (McKay, Beckman &
/// Conover 1979), each variable once in each of `count` equal parts of its range. Where a bound is
/// missing (or beyond 1e19), the range reaches ten times the larger of |start| and the magnitude of
/// the variable away from the start. The same on every machine.
/// @param seed  other designs for other seeds
/// @throws InputError names a variable without bounds, start and magnitude
std::vector<Eigen::VectorXd> latin_hypercube(const std::vector<Variable>& variables, int count,
                                             unsigned seed);

/// Numbers of generic size, the same in every run. The engine's raw numbers are prescribed by the
/// standard, unlike those of its distributions.
class GenericNumbers {
 public:
  /// In [0, 1].
  double part() { return static_cast<double>(engine_()) / std::mt19937::max(); }
  /// In [1/2, 1].
  double size() { return 0.5 + 0.5 * part(); }
  /// In [1/2, 1] or [−1, −1/2].
  double signed_size() {
    const double magnitude = size();
    return engine_() % 2 == 0 ? magnitude : -magnitude;
  }

 private:
  std::mt19937 engine_;
};

}  // namespace pleuel
