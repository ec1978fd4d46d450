#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/base/int_size.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// Local coordinates as linear combinations of the generalized ones,
///     q_local = rows · q(coordinates)
/// such as nodal displacements of a body that is described by modes, or the displacement of a place
/// between nodes. Terms and signals written in local coordinates serve through it unchanged. Rows
/// of a rotation vector must be copies: it does not combine.
struct CoordinateMap {
  std::vector<int> coordinates;                                ///< indices in q of the columns
  Eigen::MatrixXd rows;                                        ///< local × coordinates
  std::vector<DesignDerivative<Eigen::MatrixXd>> derivatives;  ///< ∂rows/∂x, where not zero
  std::vector<int> multipliers;  ///< indices in λ of the local multipliers

  int size() const { return static_cast<int>(rows.rows()); }
  int columns() const { return int_size(coordinates); }

  /// Local part of a vector of generalized coordinates or of their rates.
  template <class Vector>
  void gather(const Vector& all, Eigen::VectorXd& columns, Eigen::VectorXd& local) const {
    for (int i = 0; i < this->columns(); ++i) {
      columns(i) = all(coordinates[i]);
    }
    local.noalias() = rows * columns;
  }
};

/// A state in local coordinates with the generalized ones that it was made from.
struct LocalState {
  explicit LocalState(const CoordinateMap& map);
  void set(const CoordinateMap& map, const State& state);

  State local;
  Eigen::VectorXd q, v, a;  ///< of the columns
};

}  // namespace pleuel
