#pragma once

#include <functional>
#include <string>

#include "core/response/analysis.hpp"

/// Whether the derivative of one response with respect to one variable is right, as far as
/// differences of simulations can tell.
namespace pleuel {

enum class DerivativeVerdict {
  agrees,  ///< with differences, to 1e-6
  noise,   ///< differences cannot tell: their own errors hide the rest
  kink,    ///< two unlike peaks tie: differences mix them, the gradient is that of the higher one
  differs  ///< something is wrong
};

/// "agrees", "noise", "kink", "differs".
std::string to_string(DerivativeVerdict verdict);

/// A central difference (f(x + Δ) − f(x − Δ)) / 2Δ, Δ = step · size.
struct CentralDifference {
  double step = 0.0;   ///< relative
  double value = 0.0;  ///< unit of the response / unit of the variable
  double error = 0.0;  ///< of the derivative against it, relative; set by judge_derivative()
};

/// What is known of a response f and a variable x before the verdict.
struct DerivativeEvidence {
  double derivative = 0.0;
  double size = 1.0;       ///< |x|, or 1 where x = 0
  double response = 0.0;   ///< |f|
  double scatter = 0.0;    ///< standard deviation of f: see ResponseNoise
  double remainder = 0.0;  ///< what Newton's method leaves of f
  bool has_kink = false;   ///< f has one near x
};

struct JudgedDerivative {
  DerivativeVerdict verdict = DerivativeVerdict::differs;
  double derivative = 0.0;
  double error = 0.0;  ///< the smallest over the steps
  double step = 0.0;   ///< where that was
  /// The same error where Newton's method is carried further, of a derivative that differs only
  /// because it is not: see check_derivatives(). Its verdict is noise.
  std::optional<double> tight_error;
  double resolution = 0.0;               ///< u + t of the difference at its best step, relative
  std::vector<CentralDifference> curve;  ///< ascending steps
};

/// Judges a derivative g by central differences d(h) of several relative steps h:
///     error(h) = |g − d(h)| / max(|d(h)|, 1e-2 · |f| / size)
///     noise of d(h):       u(h) = (scatter / (√2 h) + remainder) / size
///     truncation of d(h):  t(h) = largest |d(h) − d(next h)|, larger and smaller
/// A derivative agrees if the smallest error is at most 1e-6. Else, without a kink, the difference
/// with the least u + t decides: within 10 u + t of it, differences cannot tell. (A tenth
/// of the step leaves a hundredth of t where f is smooth; where peaks lie between steps of time it
/// may be all of it.) Truncation excuses no error above 1e-3. Steps where noise swamps everything
/// excuse nothing.
/// @param curve  at least one difference
JudgedDerivative judge_derivative(const DerivativeEvidence& evidence,
                                  std::vector<CentralDifference> curve);

/// Some variables that change together, each by a generic part of its scale.
struct CheckedDirection {
  std::vector<Eigen::Index> variables;
  /// Change of each variable of the problem for a relative step of 1 [its SI unit]; 0 of the others.
  Eigen::VectorXd change;
};

/// How well values and derivatives of one response can be trusted.
struct DerivativeCheck {
  double adjoint_error = 0.0;   ///< of the adjoint method against direct differentiation, relative
  double noise = 0.0;           ///< of the value [SI]: see ResponseNoise::floor()
  double relative_noise = 0.0;  ///< of it; at least the round-off of one number
  Eigen::VectorXd derivatives;  ///< by each variable [SI]
  /// One a direction: derivatives by the relative step along it [SI unit of the response].
  std::vector<JudgedDerivative> directions;

  /// The direction whose derivative is worst: by verdict, then by error.
  const JudgedDerivative& worst() const;
};

struct DerivativeChecks {
  std::vector<CheckedDirection> directions;  ///< each variable is in one of them
  std::vector<DerivativeCheck> responses;
};

struct DerivativeCheckOptions {
  int threads = 1;  ///< simulations at a time
  /// Called before so many simulations of differences.
  std::function<void(int simulations)> see_differences = [](int) {};
};

/// Compares direct differentiation with central differences of relative steps from 1e-3 to 1e-6,
/// and where some derivative differs or drowns in noise, of 1e-7, 1e-2 and 1e-8; with the adjoint
/// method; and the values with their neighbours for noise. A step at which a simulation fails is
/// left out.
///
/// All variables change together, by generic numbers: one wrong derivative shows in the derivative
/// along them. Where that differs, both halves of the variables are tried by themselves, and so on
/// down to single variables: the work grows with the logarithm of their number for each one that is
/// wrong (group testing: Dorfman 1943).
///
/// Newton's method that stops early leaves an error that varies smoothly with the design: no
/// scatter shows it, and differences see its derivative where the gradient does not. Where some
/// derivative differs, all is repeated with a `newton_tolerance` of 1e-12 (or 1e-10, if that is
/// not reached): a derivative that is right then is `noise`, if it is that of this design at all.
/// @param analysis  of the problem at x, which has at least one variable
/// @throws SimulationError if the differences of all steps fail
DerivativeChecks check_derivatives(const ProblemFile& problem, const Eigen::VectorXd& x,
                                   Analysis& analysis, const DerivativeCheckOptions& options = {});

}  // namespace pleuel
