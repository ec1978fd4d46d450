#pragma once

#include "core/integration/scheme.hpp"
#include "core/integration/state_columns.hpp"
#include "core/mechanism/mechanism.hpp"

namespace pleuel {

/// States of a scheme as columns y = (q, h v, h² a, h² w), each coordinate over its scale: 4n rows
/// without units.
class StackedStates {
 public:
  /// @param step  h [s]
  StackedStates(const Mechanism& mechanism, double step);

  /// The change that leads from one state to another, whole turns of frames in a plane left out.
  Eigen::VectorXd change(const SchemeState& from, const SchemeState& to) const;
  /// The state that a change leads to. Multipliers stay.
  SchemeState moved(const SchemeState& from, const Eigen::VectorXd& change) const;

  /// Derivatives of states as columns, and back (without multipliers).
  Eigen::MatrixXd stack(const StateSensitivity& s) const;
  StateSensitivity unstack(const Eigen::MatrixXd& columns) const;

  /// Derivatives with respect to states as those with respect to columns: they multiply with units.
  const Eigen::VectorXd& units() const { return units_; }

 private:
  int n_;
  std::vector<int> rotations_, angles_;
  Eigen::VectorXd units_;
};

/// 2π for each whole turn that a frame in a plane makes from one q to another, else 0 (n).
Eigen::VectorXd whole_turns(const std::vector<int>& angles, const Eigen::VectorXd& from,
                            const Eigen::VectorXd& to);

}  // namespace pleuel
