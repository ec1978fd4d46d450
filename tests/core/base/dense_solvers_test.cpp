#include "core/base/dense_solvers.hpp"

#include <limits>
#include <random>

#include "core/base/band_modes.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/sparse_rows.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::dense_solvers_test {
namespace {

// Each decomposition against what defines it. Matrices have entries below one and some ten rows.

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr double round_off = 1e-12;  // measured 1e-15 to 6e-14

/// Its third column is the sum of the first two.
MatrixXd dependent_columns() {
  MatrixXd a = MatrixXd::Random(8, 4);
  a.col(2) = a.col(0) + a.col(1);
  return a;
}

MatrixXd positive_definite(int size) {
  const MatrixXd a = MatrixXd::Random(size, size);
  return a * a.transpose() + MatrixXd::Identity(size, size);
}

TEST(PivotedQr, FindsColumnsThatDependOnOthers) {
  const MatrixXd a = dependent_columns();
  const PivotedQr qr(a);
  EXPECT_EQ(qr.rank(), 3);
  EXPECT_EQ(PivotedQr(MatrixXd::Random(5, 5)).rank(), 5);
  EXPECT_EQ(PivotedQr(MatrixXd::Zero(3, 2)).rank(), 0);
  const MatrixXd normal = qr.normal_space();
  ASSERT_EQ(normal.cols(), 5);
  EXPECT_LE((a.transpose() * normal).norm(), round_off);
  EXPECT_LE((normal.transpose() * normal - MatrixXd::Identity(5, 5)).norm(), round_off);
}

/// |R_ii| of Q R = A P is the distance of a column from those before it.
TEST(PivotedQr, HasColumnsInTheOrderOfTheirPivots) {
  MatrixXd a(3, 3);
  a << 1.0, 0.0, 4.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0;
  const PivotedQr qr(a);
  EXPECT_EQ(qr.order(), (std::vector<int>{2, 1, 0}));
  const VectorXd expected = Eigen::Vector3d(5.0, 2.0, 0.6);  // e₁ off (4, 0, 3)/5: 3/5
  EXPECT_LE((qr.pivots() - expected).norm(), round_off);
}

TEST(PivotedQr, SolvesLeastSquaresWithIndependentColumnsOnly) {
  const MatrixXd a = dependent_columns();
  const VectorXd b = VectorXd::Random(8), z = PivotedQr(a).solve(b);
  EXPECT_LE((a.transpose() * (a * z - b)).norm(), round_off);
  EXPECT_EQ((z.array() == 0.0).count(), 1);
}

/// Normal to the null space and a solution of the normal equations: nothing else is shortest.
TEST(LeastNorm, IsTheShortestOfAllSolutions) {
  const MatrixXd a = dependent_columns();
  const VectorXd b = VectorXd::Random(8), z = least_norm_solution(a, b);
  EXPECT_LE((a.transpose() * (a * z - b)).norm(), round_off);
  EXPECT_NEAR(z(0) + z(1) - z(2), 0.0, round_off);
  const VectorXd wide = least_norm_solution(a.transpose(), VectorXd(a.transpose() * b));
  EXPECT_EQ(wide.size(), 8);
  EXPECT_LE((a.transpose() * (wide - b)).norm(), round_off);
}

TEST(DenseLu, SolvesWithTheMatrixAndItsTranspose) {
  const MatrixXd a = MatrixXd::Random(9, 9), b = MatrixXd::Random(9, 2);
  const DenseLu lu(a);
  EXPECT_LE((a * lu.solve(b) - b).norm(), round_off);
  EXPECT_LE((a.transpose() * lu.solve_transposed(b) - b).norm(), round_off);
  const MatrixXcd c = MatrixXcd::Random(9, 9), d = MatrixXcd::Random(9, 2);
  EXPECT_LE((c * ComplexLu(c).solve(d) - d).norm(), round_off);
}

/// A diagonal has 1/condition = smallest over largest.
TEST(DenseLu, EstimatesTheCondition) {
  const VectorXd diagonal = Eigen::Vector3d(4.0, 1e-3, 2.0);
  EXPECT_NEAR(DenseLu(diagonal.asDiagonal()).reciprocal_condition(), 2.5e-4, 1e-16);
  EXPECT_EQ(DenseLu(MatrixXd::Zero(2, 2)).reciprocal_condition(), 0.0);
}

TEST(Cholesky, IsTheRootOfPositiveDefiniteMatricesOnly) {
  const MatrixXd a = positive_definite(6), b = MatrixXd::Random(6, 2);
  const Cholesky factor(a);
  EXPECT_TRUE(factor.is_positive_definite());
  EXPECT_LE((factor.lower() * factor.lower().transpose() - a).norm(), round_off);
  EXPECT_LE((a * factor.solve(b) - b).norm(), round_off);
  EXPECT_LE((factor.lower() * factor.solve_lower(b) - b).norm(), round_off);
  EXPECT_FALSE(Cholesky(-a).is_positive_definite());
}

TEST(SymmetricModes, SolveTheEigenvalueProblem) {
  const MatrixXd r = MatrixXd::Random(7, 7), a = r + r.transpose(), b = positive_definite(7);
  const SymmetricModes plain = symmetric_modes(a), general = symmetric_modes(a, b);
  EXPECT_LE((a * plain.vectors - plain.vectors * plain.values.asDiagonal()).norm(), round_off);
  EXPECT_LE((a * general.vectors - b * general.vectors * general.values.asDiagonal()).norm(),
            round_off);
  EXPECT_LE((general.vectors.transpose() * b * general.vectors - MatrixXd::Identity(7, 7)).norm(),
            round_off);
  EXPECT_TRUE(std::is_sorted(plain.values.begin(), plain.values.end()));
  EXPECT_LE((symmetric_eigenvalues(a) - plain.values).norm(), round_off);
  EXPECT_LE((symmetric_eigenvalues(a, b) - general.values).norm(), round_off);
}

TEST(HermitianModes, SolveTheEigenvalueProblem) {
  const MatrixXcd r = MatrixXcd::Random(5, 5), a = r + r.adjoint();
  const MatrixXcd b = r * r.adjoint() + MatrixXcd::Identity(5, 5);
  const HermitianModes modes = hermitian_modes(a, b);
  const MatrixXcd values = modes.values.cast<std::complex<double>>().asDiagonal();
  EXPECT_LE((a * modes.vectors - b * modes.vectors * values).norm(), round_off);
}

/// s² + 2 s + 5 = 0 at −1 ± 2i, by its companion matrix.
TEST(Eigenvalues, OfACompanionMatrixAreTheRoots) {
  MatrixXd companion(2, 2);
  companion << 0.0, 1.0, -5.0, -2.0;
  const VectorXcd roots = eigenvalues_of(companion);
  EXPECT_NEAR(std::abs(roots(0) - std::complex<double>(-1.0, 2.0)), 0.0, round_off);
  EXPECT_NEAR(std::abs(roots(1) - std::complex<double>(-1.0, -2.0)), 0.0, round_off);
}

TEST(DenseSolvers, MakeNoNumbersOfWhatIsNone) {
  MatrixXd a = positive_definite(3);
  a(1, 1) = std::numeric_limits<double>::quiet_NaN();
  const VectorXd b = VectorXd::Ones(3);
  EXPECT_TRUE(DenseLu(a).solve(b).hasNaN());
  EXPECT_TRUE(least_norm_solution(a, b).hasNaN());
  EXPECT_TRUE(symmetric_modes(a).values.hasNaN());
  EXPECT_TRUE(eigenvalues_of(a).hasNaN());
  EXPECT_FALSE(Cholesky(a).is_positive_definite());
  EXPECT_EQ(PivotedQr(a).rank(), 0);
}

Eigen::MatrixXd dense(const Band& band) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(band.cols(), band.cols());
  for (Eigen::Index j = 0; j < band.cols(); ++j) {
    for (Eigen::Index i = j; i < std::min(band.cols(), j + 6); ++i) {
      matrix(i, j) = matrix(j, i) = band(i - j, j);
    }
  }
  return matrix;
}

class AnyBands : public testing::TestWithParam<int> {
 protected:
  AnyBands() : a(6, GetParam()), b(6, GetParam()) {
    std::mt19937 random(static_cast<unsigned>(GetParam()));
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (double& entry : a.reshaped()) entry = number(random);
    for (double& entry : b.reshaped()) entry = number(random);
    b.row(0).setConstant(11.0);  // more than all beside it
  }
  Band a, b;
};

// 1e-12: round-off of both methods.

TEST_P(AnyBands, HaveTheLargestModeOfADenseSolver) {
  for (const double shift : {-3.0, 0.0, 3.0}) {  // few, half, most eigenvalues are positive
    a.row(0).array() += shift;
    const double expected = symmetric_eigenvalues(dense(a), dense(b)).maxCoeff();
    for (const double guess : {1e-6, 0.1, 1e4}) {
      LargestBandMode mode(b);
      const double value = mode.value(a, guess, 1e-9);
      EXPECT_NEAR(value, std::max(expected, 0.0), 1e-12) << shift << ", " << guess;
      if (value == 0.0) continue;
      const Eigen::VectorXd vector = mode.vectors().col(0);
      EXPECT_LT((dense(a) * vector - value * dense(b) * vector).norm(), 1e-12);
      EXPECT_NEAR(vector.dot(dense(b) * vector), 1.0, 1e-12);
    }
  }
}

TEST_P(AnyBands, HaveNoModeWhereAllEigenvaluesAreNegative) {
  a.row(0).array() -= 12.0;
  EXPECT_EQ(LargestBandMode(b).value(a, 1.0, 1e-9), 0.0);
}

/// Two equal blocks beside each other; their diagonal makes all eigenvalues positive.
TEST_P(AnyBands, HaveTwoVectorsOfATwofoldEigenvalue) {
  a.row(0).array() += 12.0;
  const Eigen::Index n = a.cols();
  Band twice_a = Band::Zero(6, 2 * n), twice_b = twice_a;
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index d = 0; d < std::min<Eigen::Index>(6, n - j); ++d) {
      twice_a(d, j) = twice_a(d, n + j) = a(d, j);
      twice_b(d, j) = twice_b(d, n + j) = b(d, j);
    }
  }
  LargestBandMode mode(twice_b);
  const double value = mode.value(twice_a, 0.1, 1e-9);
  EXPECT_NEAR(value, symmetric_eigenvalues(dense(a), dense(b)).maxCoeff(), 1e-12);
  const Eigen::MatrixXd vectors = mode.vectors();
  ASSERT_EQ(vectors.cols(), 2);
  const Eigen::MatrixXd products = vectors.transpose() * dense(twice_b) * vectors;
  EXPECT_LT((products - Eigen::Matrix2d::Identity()).norm(), 1e-10);
  EXPECT_LT((dense(twice_a) * vectors - value * dense(twice_b) * vectors).norm(), 1e-9);
}

TEST_P(AnyBands, AreNotANumberWhereAnEntryIsNone) {
  a(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(LargestBandMode(b).value(a, 1.0, 1e-9)));
}

INSTANTIATE_TEST_SUITE_P(Sizes, AnyBands, testing::Values(1, 2, 5, 6, 7, 20, 61), named_by_value());

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
}  // namespace pleuel::test::dense_solvers_test
