#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/beam/invariants.hpp"
#include "core/system/term.hpp"

/// Sparse things of the code under test as dense matrices.

template <class Vector>
auto dense(const pleuel::ElasticPattern& pattern, const Vector& nonzeros) {
  using Scalar = typename Vector::Scalar;
  Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> matrix;
  matrix.setConstant(pattern.size, pattern.size, Scalar(0));
  for (int row = 0; row < pattern.size; ++row) {
    for (int i = pattern.row_start[row]; i < pattern.row_start[static_cast<std::size_t>(row) + 1];
         ++i) {
      matrix(row, pattern.column[i]) = nonzeros(i);
    }
  }
  return matrix;
}

inline Eigen::VectorXd residual_of(pleuel::Term& term, const pleuel::State& state,
                                   pleuel::ConstraintLevel level) {
  Eigen::VectorXd residual = Eigen::VectorXd::Zero(state.q.size() + state.lambda.size());
  term.add_residual(state, level, residual);
  return residual;
}

inline Eigen::MatrixXd tangent_of(pleuel::Term& term, const pleuel::State& state,
                                  const pleuel::Weights& weights, pleuel::ConstraintLevel level) {
  pleuel::EntryList entries;
  term.declare_entries(entries);
  std::vector<double> values(entries.size());
  term.write_tangent(state, weights, level, values.data());
  const auto size = state.q.size() + state.lambda.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    matrix(entries[i].first, entries[i].second) += values[i];
  }
  return matrix;
}
