#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

/// Rank, null space and solutions of least norm of sparse rows A, such as constraints. Rows that share
/// no column with others are decomposed by themselves; blocks of few rows by dense decompositions
/// (core/base/dense_solvers.hpp), larger ones by a sparse factorisation A Aᵀ = L D Lᵀ of rows of
/// length one (Davis 2005, Algorithm 849, with minimum-degree ordering), whose cost follows the
/// fill-in: D_kk is the square of what is left of a row across those before it. Rows of which less
/// than 3e-7 is left cannot be told from dependent ones this way; solutions are refined.
namespace pleuel {

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Rows that are connected by the columns that they share, directly or by way of other rows; both
/// ascending.
struct RowBlock {
  std::vector<int> rows, columns;
};

/// All rows in blocks, from the pattern (a stored zero connects); columns without entries are in
/// none.
std::vector<RowBlock> connected_blocks(const SparseRows& matrix);

/// Whether it is decomposed sparsely.
bool is_large(const RowBlock& block);

/// Some of the rows.
SparseRows select_rows(const SparseRows& matrix, const std::vector<int>& rows);
/// The rows and columns of a block.
SparseRows select_block(const SparseRows& matrix, const RowBlock& block);

/// Rows in the order of their pivots.
struct RankedRows {
  std::vector<int> order;
  Eigen::VectorXd pivots;  ///< relative to the largest, descending
};

/// The pivot of a row is what is left of it across those before it in the order; rows count by their
/// direction. In a small block every pivot is as large as it can be. In a large one rows keep an
/// order of little fill-in, and those of which no more than `negligible` is left come last, with
/// pivots of zero.
/// @throws SimulationError  if a number is not finite
RankedRows rank_rows(SparseRows rows, double negligible);

/// The number of independent rows, by direction: pivots above a threshold. In large blocks all
/// columns count alike.
/// @throws SimulationError  if a number is not finite
Eigen::Index rank_of_rows(SparseRows rows, double threshold);

/// By how much some of the rows raise the rank of the others.
Eigen::Index rank_added_by(const std::vector<int>& added, SparseRows rows, double threshold);

/// Columns: an orthonormal basis of { x : rows x = 0 }.
/// @param most  of a large block, whose basis takes their number squared, so many generic ones
/// @throws SimulationError  if a number is not finite
Eigen::MatrixXd null_space_of_rows(SparseRows rows, double threshold,
                                   Eigen::Index most = std::numeric_limits<Eigen::Index>::max());

/// Of all x with rows x = b the shortest one. The rows have to be independent where they are many.
Eigen::VectorXd least_norm_solution(const SparseRows& rows, const Eigen::VectorXd& b);

/// The z that makes ‖rowsᵀ z − b‖ least: what a vector is made of. Independent rows as above.
Eigen::VectorXd factors_of_rows(const SparseRows& rows, const Eigen::VectorXd& b);

}  // namespace pleuel
