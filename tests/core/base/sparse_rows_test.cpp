#include "core/base/sparse_rows.hpp"

#include <limits>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::sparse_rows_test {
namespace {

/// A chain of rows that each share two columns with the next: 3 k … 3 k + 4 of row k and its twin.
/// @param links  two rows each
SparseRows chain(int links) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < links; ++k) {
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 5; ++j) {
        entries.emplace_back(2 * k + i, 3 * k + j, std::sin(1.0 + 1.7 * k + 2.9 * i + 0.8 * j * j));
      }
    }
  }
  SparseRows rows(2 * links, 3 * links + 2);
  rows.setFromTriplets(entries.begin(), entries.end());
  return rows;
}

/// The same with some rows that are sums of the two before them, at the end.
SparseRows with_dependent_rows(const SparseRows& rows, int count) {
  SparseRows all(rows.rows() + count, rows.cols());
  std::vector<Eigen::Triplet<double>> entries;
  for (int row = 0; row < rows.rows(); ++row) {
    for (SparseRows::InnerIterator entry(rows, row); entry; ++entry) {
      entries.emplace_back(row, entry.col(), entry.value());
    }
  }
  for (int i = 0; i < count; ++i) {
    for (int row = 7 * i; row < 7 * i + 2; ++row) {
      for (SparseRows::InnerIterator entry(rows, row); entry; ++entry) {
        entries.emplace_back(rows.rows() + i, entry.col(), entry.value());
      }
    }
  }
  all.setFromTriplets(entries.begin(), entries.end());
  return all;
}

Eigen::VectorXd some_vector(Eigen::Index size) {
  Eigen::VectorXd vector(size);
  for (Eigen::Index i = 0; i < size; ++i) vector(i) = std::cos(0.3 + 1.1 * double(i));
  return vector;
}

TEST(ConnectedBlocks, ShareNoColumn) {
  SparseRows matrix(5, 7);
  matrix.insert(0, 1) = 1.0;
  matrix.insert(3, 1) = 1.0;
  matrix.insert(3, 4) = 1.0;
  matrix.insert(1, 2) = 1.0;
  matrix.insert(4, 4) = 0.0;  // a zero that may become a number
  const std::vector<RowBlock> blocks = connected_blocks(matrix);
  ASSERT_EQ(blocks.size(), 3u);
  EXPECT_THAT(blocks[0].rows, ElementsAre(0, 3, 4));
  EXPECT_THAT(blocks[0].columns, ElementsAre(1, 4));
  EXPECT_THAT(blocks[1].rows, ElementsAre(1));
  EXPECT_THAT(blocks[2].rows, ElementsAre(2));
  EXPECT_THAT(blocks[2].columns, IsEmpty());
}

/// 20 links are decomposed densely, 120 sparsely.
class RowsOfAChain : public testing::TestWithParam<int> {};

TEST_P(RowsOfAChain, HaveTheRankOfTheIndependentOnes) {
  const SparseRows rows = chain(GetParam());
  EXPECT_EQ(rank_of_rows(rows, 1e-8), rows.rows());
  EXPECT_EQ(rank_of_rows(with_dependent_rows(rows, 4), 1e-8), rows.rows());
}

TEST_P(RowsOfAChain, AreRankedWithTheDependentOnesLast) {
  const SparseRows rows = chain(GetParam()), all = with_dependent_rows(rows, 4);
  const RankedRows ranked = rank_rows(all, 1e-6);
  ASSERT_EQ(ranked.pivots.size(), all.rows());
  EXPECT_EQ(ranked.pivots(0), 1.0);
  EXPECT_GT(ranked.pivots(rows.rows() - 1), 1e-3);
  EXPECT_LT(ranked.pivots(rows.rows()), 1e-12);
  // Those before are independent indeed.
  const std::vector<int> kept(ranked.order.begin(), ranked.order.begin() + rows.rows());
  EXPECT_EQ(PivotedQr(Eigen::MatrixXd(select_rows(all, kept)).transpose(), 1e-8).rank(),
            rows.rows());
}

TEST_P(RowsOfAChain, HaveTheLeastNormSolutionOfTheDenseDecomposition) {
  const SparseRows rows = chain(GetParam());
  const Eigen::VectorXd b = some_vector(rows.rows());
  const Eigen::VectorXd expected = least_norm_solution(Eigen::MatrixXd(rows), b);
  // Conditioned by some hundreds.
  EXPECT_LE((least_norm_solution(rows, b) - expected).norm(), 1e-11 * expected.norm());
}

TEST_P(RowsOfAChain, HaveAnOrthonormalNullSpaceOfFullSize) {
  const SparseRows rows = with_dependent_rows(chain(GetParam()), 3);
  const Eigen::MatrixXd space = null_space_of_rows(rows, 1e-8);
  EXPECT_EQ(space.cols(), rows.cols() - (rows.rows() - 3));
  EXPECT_LE((rows * space).lpNorm<Eigen::Infinity>(), 1e-12);
  EXPECT_LE((space.transpose() * space - Eigen::MatrixXd::Identity(space.cols(), space.cols()))
                .lpNorm<Eigen::Infinity>(),
            1e-12);
}

TEST_P(RowsOfAChain, GiveBackTheFactorsOfASum) {
  const SparseRows rows = chain(GetParam());
  const Eigen::VectorXd factors = some_vector(rows.rows());
  EXPECT_LE((factors_of_rows(rows, rows.transpose() * factors) - factors).norm(),
            1e-11 * factors.norm());
}

INSTANTIATE_TEST_SUITE_P(FewAndMany, RowsOfAChain, testing::Values(20, 120), named_by_value());

TEST(NullSpaceOfRows, HasTheColumnsThatNoRowHas) {
  SparseRows rows(1, 3);
  rows.insert(0, 1) = 2.0;
  const Eigen::MatrixXd space = null_space_of_rows(rows, 1e-8);
  EXPECT_EQ(space.cols(), 2);
  EXPECT_EQ((rows * space).lpNorm<Eigen::Infinity>(), 0.0);
}

TEST(RankRows, OfNumbersThatAreNotFiniteIsRefused) {
  SparseRows rows = chain(3);
  rows.coeffs()(4) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(rank_rows(rows, 1e-6), SimulationError);
}

}  // namespace
}  // namespace pleuel::test::sparse_rows_test
