#pragma once

#include <Eigen/Core>

#include "core/scene/problem_numbers.hpp"
#include "core/scene/shown_unit.hpp"

/// What every number of a problem is worth: how much better or worse the optimum would be with more
/// of it.
namespace pleuel {

/// The price of a number: the change of the optimal objective with it, everything else as it is and
/// the design optimal again.
struct NumberPrice {
  enum class Kind {
    number,    ///< of the scene, fixed by the file
    variable,  ///< fixed by bounds that are equal
    bound,     ///< that the optimum lies at
    limit      ///< that a constraint has
  };
  Kind kind = Kind::number;
  std::string name;                   ///< JSON pointer; of a variable its name
  std::vector<std::string> pointers;  ///< of all numbers that move together; one of most
  double value = 0.0;                 ///< [SI]
  ShownUnit unit;
  double per_unit = 0.0;  ///< [unit of the objective / SI unit]; exactly 0 below round-off
  /// What would decide the optimum with one percent more of the number and does not decide it now,
  /// to first order: a limit or a bound, by name. Then the price holds for smaller changes only.
  std::string next_limit;

  /// Change of the optimum with one percent more of the value.
  double per_percent() const { return 0.01 * value * per_unit; }
};

struct PriceList {
  double objective = 0.0;           ///< at the design [SI]
  double residual = 0.0;            ///< KKT residual, relative: how well multipliers explain it
  std::vector<NumberPrice> prices;  ///< the dearest percent first
  /// Numbers whose prices nobody knows: places on elastic beams, what sets the period of a motion
  /// that repeats itself.
  std::vector<std::string> unknown;
};

/// Prices at an optimum x* by the envelope theorem,
///
///     d f*/dp = ∂f/∂p + Σ μ_j ∂c_j/∂p,
///
/// from one gradient at x* with all numbers p as further variables. Peaks over time count window by
/// window, so that peaks which tie share the multiplier; μ are those of the audit (kkt_audit.hpp).
/// Of a limit the price is −μ, of a bound −β.
/// @param text     that the problem was read from
/// @param problem  with what the command changed of it
/// @param threads  simulations at a time, of gradients by differences
/// @throws InputError if the problem has no variables or no objective
/// @throws SimulationError
PriceList number_prices(const ProblemText& text, const ProblemFile& problem,
                        const Eigen::VectorXd& x, int threads = 1);

struct PricedNumbers {
  std::vector<NumberGroup> groups;
  /// Names of groups that would have a price, but no variable can stand for them: a place on an
  /// elastic beam.
  std::vector<std::string> left_out;
};

/// The fixed numbers of a scene that a price can be given for, grouped: a point that bodies, joints
/// and loads share moves as one. Left out are coordinates across the plane of a planar mechanism
/// and those of places where a variable or a formula moves another point, numbers other than
/// coordinates that are zero (nothing says that they belong to the mechanism), and what no variable
/// can stand for.
PricedNumbers priced_numbers(const ProblemText& text, const ProblemFile& problem);

}  // namespace pleuel
