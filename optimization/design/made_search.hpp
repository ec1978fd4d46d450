#pragma once

#include <memory>
#include <vector>

#include "core/scene/body_source.hpp"
#include "core/scene/problem_file.hpp"
#include "optimization/design/design_solve.hpp"
#include "optimization/evaluation_store.hpp"

namespace pleuel {

/// Whether a body is made anew for each design.
bool has_made_bodies(const ProblemFile& file);

/// The bodies that were made for some designs of an optimization, and the problem in which they are
/// continued between these designs (core/scene/continued_body.hpp).
class MadeBodies {
 public:
  /// @pre has_made_bodies(file)
  explicit MadeBodies(ProblemFile file);

  /// Has all bodies made for a design.
  /// @returns how far what was continued to this design was off: the largest relative stiffness, as
  ///          a logarithm; 0 at the first design
  /// @throws SimulationError if one cannot be made
  double make_at(const Eigen::VectorXd& x);

  /// Whether they were made for this very design.
  bool are_made_at(const Eigen::VectorXd& x) const;

  /// Designs they were made for.
  int designs() const { return designs_; }

  const ProblemFile& original() const { return file_; }

  /// The problem, or one that differs from it in its setting only, with continued bodies.
  ProblemFile continued(ProblemFile file) const;
  ProblemFile continued() const { return continued(file_); }

  /// The same with the bounds of variables that bodies depend on narrowed to x e^±radius, or to
  /// x ± radius (upper − lower) of those that are not positive.
  ProblemFile continued_around(const Eigen::VectorXd& x, double radius) const;

 private:
  /// A body of one of the problems that are simulated.
  struct Made {
    std::size_t problem, body;
    std::vector<int> variables;  ///< of the problem, that it depends on
    std::shared_ptr<const BodySource> source;
    std::vector<std::shared_ptr<const InvariantsFile>> made;
  };

  static Eigen::VectorXd values_of(const Made& made, const Eigen::VectorXd& x);
  static std::shared_ptr<const BodySource> continued(const Made& made);

  ProblemFile file_;
  std::vector<Made> bodies_;
  int designs_ = 0;
};

/// Moves a design towards the optimum with few calls of what makes the bodies: searches with
/// continued bodies within a region in which they are trusted, has the bodies made at the design
/// that is found, and goes on from there, until the design stays (to 1e-3). The region grows or
/// shrinks by how well the next bodies were foretold, and is no wider than four steps such as the last.
/// @param x       that the bodies were made for
/// @param before  effort and history of what was done before; goes on with that of the searches
/// @returns       a design that the bodies were made for
Eigen::VectorXd search_between_calls(MadeBodies& bodies, const Eigen::VectorXd& x,
                                     const SolveOptions& options, const Execution& execution,
                                     Result& before, const Observer& observer,
                                     const Notice& notice);

}  // namespace pleuel
