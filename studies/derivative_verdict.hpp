#pragma once

#include <optional>
#include <string>
#include <vector>

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

}  // namespace pleuel
