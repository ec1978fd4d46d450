#pragma once

#include <optional>

#include "core/response/analysis.hpp"

namespace pleuel {

/// By what factor the loads of an instant buckle a mechanism, by linear buckling
/// (elastic_stability.hpp): its stiffness against that of the same position without deformation,
/// motion, weight and loads. In the coordinates of the motion: in a plane, of buckling in it. Drives
/// hold.
class LoadFactor {
 public:
  /// @param analysis  of the problem at the design x; has to outlive this
  LoadFactor(const ProblemFile& problem, const Eigen::VectorXd& x, const Analysis& analysis);

  /// Whether it can be told: not of many coordinates, nor of mechanisms with springs, which loads
  /// turn at once.
  bool is_known() const { return free_.has_value(); }
  /// Infinite where nothing buckles, as without geometric stiffening; not a number where motions
  /// of bodies are held by what is no joint.
  double at(int instant) const;

 private:
  const Analysis& analysis_;
  std::optional<Model> free_;  ///< without weight and loads
};

}  // namespace pleuel
