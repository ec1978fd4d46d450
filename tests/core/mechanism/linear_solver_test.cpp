#include "core/mechanism/linear_solver.hpp"

#include <limits>
#include <numeric>
#include <random>

#include <Eigen/Geometry>

#include "core/base/eager_matrices.hpp"
#include "core/mechanism/pivoted_factors.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::linear_solver_test {
namespace {

using Matrix = LinearSolver::Matrix;

constexpr int size = 30;

/// A third of the entries, all of one size, and a diagonal.
Eigen::MatrixXd random_matrix(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::mt19937 pattern(7);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) {
      if (i == j || pattern() % 3 == 0) matrix(i, j) = uniform(random);
    }
  }
  return matrix;
}

Eigen::VectorXd powers_of_ten(std::mt19937& random, double most) {
  std::uniform_real_distribution<double> uniform(-most, most);
  return Eigen::VectorXd::NullaryExpr(size, [&] { return std::pow(10.0, uniform(random)); });
}

/// Powers of two leave a factor of two for each row, and by them for each column.
TEST(LinearSolver, HasAConditionThatDoesNotKnowTheUnitsOfEquations) {
  std::mt19937 random(3);
  const Eigen::MatrixXd matrix = random_matrix(random);
  const Eigen::MatrixXd scaled = powers_of_ten(random, 9.0).asDiagonal() * matrix;
  LinearSolver plain_solver(matrix.sparseView()), solver(scaled.sparseView());
  ASSERT_TRUE(plain_solver.factorize(matrix.sparseView()));
  ASSERT_TRUE(solver.factorize(scaled.sparseView()));
  EXPECT_LE(std::abs(std::log2(solver.condition() / plain_solver.condition())), 2.0);
}

TEST(LinearSolver, KeepsTheDigitsOfUnknownsInAnyUnits) {
  std::mt19937 random(3);
  const Eigen::MatrixXd matrix = random_matrix(random);
  const Eigen::VectorXd rows = powers_of_ten(random, 9.0), columns = powers_of_ten(random, 9.0);
  const Eigen::MatrixXd scaled = rows.asDiagonal() * matrix * columns.asDiagonal();
  LinearSolver solver(scaled.sparseView());
  ASSERT_TRUE(solver.factorize(scaled.sparseView()));
  Eigen::MatrixXd x = rows.asDiagonal() * matrix * Eigen::MatrixXd::Ones(size, 2);
  solver.solve(x);
  EXPECT_LE((columns.asDiagonal() * x - Eigen::MatrixXd::Ones(size, 2)).cwiseAbs().maxCoeff(),
            1e-11);
}

TEST(LinearSolver, KnowsTheConditionOfAMatrix) {
  const Eigen::MatrixXd diagonal = Eigen::Vector3d(1e-8, 1.0, 1e6).asDiagonal();
  LinearSolver easy(diagonal.sparseView());
  ASSERT_TRUE(easy.factorize(diagonal.sparseView()));
  EXPECT_NEAR(easy.condition(), 1.0, 1e-12 + 1.0) << "powers of two leave less than two";
  Eigen::Matrix2d close;
  close << 1.0, 1.0, 1.0, 1.0 + 1e-8;
  LinearSolver hard(Eigen::MatrixXd(close).sparseView());
  ASSERT_TRUE(hard.factorize(Eigen::MatrixXd(close).sparseView()));
  // ‖A‖₁ ‖A⁻¹‖₁ = (2 + 1e-8)² / 1e-8
  EXPECT_NEAR(hard.condition() / 4e8, 1.0, 1e-6);
}

/// Factors with the pivots of other matrices err by up to 1e-4 here; refinement or new pivots make
/// that round-off, of the transposed equations, too.
TEST(LinearSolver, RefinesWhatOldPivotsLeave) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Eigen::MatrixXd first = random_matrix(random);
  LinearSolver solver(first.sparseView());
  ASSERT_TRUE(solver.factorize(first.sparseView()));
  for (int i = 0; i < 200; ++i) {
    const Eigen::MatrixXd next = random_matrix(random);
    ASSERT_TRUE(solver.factorize(next.sparseView()));
    for (const bool is_transposed : {false, true}) {
      const Eigen::MatrixXd rhs =
          Eigen::MatrixXd::NullaryExpr(size, 3, [&] { return uniform(random); });
      Eigen::MatrixXd x = rhs;
      is_transposed ? solver.solve_transposed(x) : solver.solve(x);
      EXPECT_LE(solver.backward_error(), 1e-14) << i;
      Eigen::MatrixXd applied = next;
      if (is_transposed) applied.transposeInPlace();
      // As it is defined, of the equations without scales.
      const double size = applied.cwiseAbs().maxCoeff() * x.cwiseAbs().colwise().sum().maxCoeff();
      EXPECT_LE((applied * x - rhs).cwiseAbs().maxCoeff(), 1e-13 * (1.0 + size));
    }
  }
}

/// What is lost is said, and does not stay: neither in the factors nor in the scales.
TEST(LinearSolver, RecoversFromMatricesWithoutInverse) {
  std::mt19937 random(13);
  const Eigen::MatrixXd good = random_matrix(random);
  Eigen::MatrixXd infinite = good, not_a_number = good, singular = good;
  infinite(0, 0) = std::numeric_limits<double>::infinity();
  not_a_number(0, 0) = std::numeric_limits<double>::quiet_NaN();
  singular.row(3) = singular.row(3).cwiseProduct(Eigen::RowVectorXd::Zero(size));
  LinearSolver::Matrix pattern = good.sparseView();
  const auto on_pattern = [&](const Eigen::MatrixXd& matrix) {
    LinearSolver::Matrix sparse = pattern;
    for (int col = 0; col < sparse.outerSize(); ++col) {
      for (LinearSolver::Matrix::InnerIterator it(sparse, col); it; ++it) {
        it.valueRef() = matrix(it.row(), it.col());
      }
    }
    return sparse;
  };
  LinearSolver solver(pattern);
  for (const Eigen::MatrixXd& bad : {infinite, not_a_number, singular}) {
    EXPECT_FALSE(solver.factorize(on_pattern(bad)));
    ASSERT_TRUE(solver.factorize(on_pattern(good)));
    const Eigen::MatrixXd expected = Eigen::MatrixXd::Random(size, 2);
    Eigen::MatrixXd x = good * expected;
    solver.solve(x);
    EXPECT_LE((x - expected).cwiseAbs().maxCoeff(), 1e-11);
  }
}

/// With the pivots of a solver that has seen other matrices the same numbers come out, bit by bit;
/// pivots chosen for the last of the matrices give others.
TEST(LinearSolver, RepeatsWhatAnotherDidWithItsPivots) {
  std::mt19937 random(11);
  Eigen::MatrixXd first = random_matrix(random);
  const Eigen::MatrixXd last = random_matrix(random);
  first.diagonal().head(3) *= 1e-4;  // no pivots, while those of the last serve
  LinearSolver solver(first.sparseView()), other(first.sparseView()), fresh(first.sparseView());
  ASSERT_TRUE(solver.factorize(first.sparseView()));
  const LinearSolver::Pivots pivots = solver.pivots();
  EXPECT_EQ(solver.pivot_choices(), 1);
  ASSERT_TRUE(solver.factorize(last.sparseView()));
  ASSERT_EQ(solver.pivot_choices(), 1) << "the old pivots served";
  ASSERT_TRUE(other.factorize(last.sparseView()));
  other.use_pivots(pivots);
  ASSERT_TRUE(other.factorize(last.sparseView()));
  ASSERT_TRUE(fresh.factorize(last.sparseView()));
  const auto solve = [](LinearSolver& with) {
    Eigen::MatrixXd x = Eigen::MatrixXd::Ones(size, 1);
    with.solve(x);
    return x;
  };
  const Eigen::MatrixXd expected = solve(solver);
  EXPECT_EQ(solve(other), expected);
  EXPECT_NE(solve(fresh), expected);
  other.use_pivots({});  // as at the beginning
  ASSERT_TRUE(other.factorize(last.sparseView()));
  EXPECT_EQ(solve(other), solve(fresh));
}

/// Against the rule of Sarrus.
TEST(LinearSolver, KnowsTheSignOfTheDeterminant) {
  int positive = 0;
  for (int seed = 1; seed <= 40; ++seed) {
    Eigen::MatrixXd a(3, 3);
    for (int i = 0; i < 9; ++i) a(i / 3, i % 3) = std::sin(seed * (1.0 + 2.7 * i));
    if (seed % 3 == 0) a(1, 1) = 0.0;
    const Eigen::Matrix3d rows = a;
    const double determinant = rows.row(0).cross(rows.row(1)).dot(rows.row(2));
    const Matrix matrix = a.sparseView(0.0, 0.0);
    LinearSolver solver(matrix);
    ASSERT_TRUE(solver.factorize(matrix));
    EXPECT_EQ(solver.determinant_sign(), determinant > 0.0 ? 1 : -1) << seed;
    positive += determinant > 0.0;
  }
  EXPECT_GT(positive, 5);
  EXPECT_LT(positive, 35);
}

/// An equation in a unit that is 10²¹ times as small: its 10 is no pivot beside the 1 of the other one,
/// which partial pivoting alone takes it for (and finds x₁ = 0).
TEST(LinearSolver, TakesNoPivotForItsUnit) {
  Eigen::MatrixXd dense(2, 2);
  dense << 10.0, 1e21, 1.0, 1.0;
  const Matrix matrix = dense.sparseView(0.0, 0.0);
  const Eigen::Vector2d expected(2.0, 1.0);
  LinearSolver solver(matrix);
  ASSERT_TRUE(solver.factorize(matrix));
  Eigen::MatrixXd x = dense * expected;
  solver.solve(x);
  EXPECT_LT((x - expected).norm(), 1e-14);
}

/// Blocks of many columns take another way than single ones, in groups of which the last is not
/// full; also through a matrix that falls into diagonal blocks with something above them.
TEST(LinearSolver, SolvesForManyColumnsAsForEach) {
  std::mt19937 random(5);
  const Eigen::MatrixXd whole = random_matrix(random);
  Eigen::MatrixXd parts = whole;
  parts.bottomLeftCorner(size - 10, 10).setZero();
  parts.bottomLeftCorner(8, size - 8).setZero();
  for (const Eigen::MatrixXd& matrix : {whole, parts}) {
    LinearSolver solver(matrix.sparseView());
    for (const double factor : {1.0, 2.0}) {  // other factors on the same pivots
      ASSERT_TRUE(solver.factorize((factor * matrix).sparseView()));
      for (const bool is_transposed : {false, true}) {
        for (const int columns : {6, 12, 40}) {
          const Eigen::MatrixXd rhs = Eigen::MatrixXd::Random(size, columns);
          Eigen::MatrixXd x = rhs, expected = rhs;
          is_transposed ? solver.solve_transposed(x) : solver.solve(x);
          for (Eigen::Index j = 0; j < columns; ++j) {
            is_transposed ? solver.solve_transposed(expected.col(j))
                          : solver.solve(expected.col(j));
          }
          EXPECT_LE((x - expected).lpNorm<Eigen::Infinity>(),
                    1e-12 * expected.lpNorm<Eigen::Infinity>())
              << columns << " columns";
        }
      }
    }
  }
}

/// Sensitivities that die out end as numbers with a few digits only.
TEST(LinearSolver, DoesNotDoubtWhatUnderflows) {
  std::mt19937 random(5);
  const Eigen::MatrixXd matrix = random_matrix(random);
  LinearSolver solver(matrix.sparseView());
  ASSERT_TRUE(solver.factorize(matrix.sparseView()));
  for (const double size : {1e-290, 1e-300, 1e-315, 1e-322, 0.0}) {
    Eigen::MatrixXd x = size * Eigen::MatrixXd::Random(matrix.rows(), 6);
    solver.solve(x);
    EXPECT_TRUE(solver.is_accurate()) << size;
  }
}

/// Wilkinson's matrix, −1 below the diagonal and 1 in the last column, with the diagonal d:
/// elimination with pivots on the diagonal multiplies entries by 1 + 1/d in each column.
Eigen::MatrixXd growing_matrix(double diagonal) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < i; ++j) matrix(i, j) = -1.0;
    matrix(i, i) = diagonal;
    matrix(i, size - 1) = 1.0;
  }
  return matrix;
}

/// d = 0.15 is a pivot by the usual threshold, and lets entries grow to 7.7²⁹ = 5e25: no digit of a
/// solution is left. The largest entries of the columns are no worse than 2²⁹.
TEST(LinearSolver, TakesTheLargestPivotsWhereThoseOfTheDiagonalMakeEntriesGrow) {
  const Eigen::MatrixXd matrix = growing_matrix(0.15);
  LinearSolver solver(matrix.sparseView());
  ASSERT_TRUE(solver.factorize(matrix.sparseView()));
  EXPECT_EQ(solver.pivots().threshold, LinearSolver::usual_threshold);
  const Eigen::MatrixXd rhs = matrix * Eigen::MatrixXd::Ones(size, 1);
  Eigen::MatrixXd x = rhs;
  solver.solve(x);
  EXPECT_EQ(solver.pivots().threshold, 1.0) << "the usual pivots served: this test shows nothing";
  EXPECT_GT(solver.pivot_choices(), 1);
  EXPECT_TRUE(solver.is_accurate());
  EXPECT_LE((matrix * x - rhs).lpNorm<Eigen::Infinity>(), 1e-10 * size);
  // A condition of some 1e9 leaves six digits and more.
  const Eigen::MatrixXd dense = solve_dense(matrix, rhs);
  EXPECT_LE((x - dense).lpNorm<Eigen::Infinity>(), 1e-6 * dense.lpNorm<Eigen::Infinity>());
  // Another solver goes on from there with the same pivots.
  LinearSolver again(matrix.sparseView());
  again.use_pivots(solver.pivots());
  ASSERT_TRUE(again.factorize(matrix.sparseView()));
  Eigen::MatrixXd y = rhs;
  again.solve(y);
  EXPECT_EQ(again.pivot_choices(), 1);
  EXPECT_EQ(x, y);
}

/// A chain of coupled unknowns, as the nodes of a beam, and six that are coupled to all of them, as
/// a frame; numbered like a body: the frame first.
Matrix body_matrix(int nodes) {
  constexpr int frame = 6;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < frame + nodes; ++i) {
    entries.emplace_back(i, i, i < frame ? 10.0 * nodes : 4.0);
    if (i > frame) {
      entries.emplace_back(i, i - 1, -1.0);
      entries.emplace_back(i - 1, i, -1.0);
    }
    for (int k = 0; i >= frame && k < frame; ++k) {
      entries.emplace_back(i, k, std::cos(i + k));
      entries.emplace_back(k, i, std::cos(i + k));
    }
  }
  Matrix matrix(frame + nodes, frame + nodes);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

std::vector<int> nodes_of(const Matrix& body) {
  std::vector<int> nodes;
  for (int i = 6; i < body.cols(); ++i) nodes.push_back(i);
  return nodes;
}

/// Each node of the chain adds its two neighbours and six rows and columns of the frame.
TEST(LinearSolver, FillsInProportionToTheNodesOfABody) {
  for (const int nodes : {50, 200, 800}) {
    const Matrix matrix = body_matrix(nodes);
    LinearSolver solver(matrix, nodes_of(matrix));
    ASSERT_TRUE(solver.factorize(matrix));
    EXPECT_LE(solver.factor_entries(), (2 + 2 + 2 * 6) * nodes + 2 * 6 * 6) << nodes;
    const Eigen::MatrixXd expected = Eigen::MatrixXd::Random(matrix.rows(), 2);
    Eigen::MatrixXd x = matrix * expected;
    solver.solve(x);
    EXPECT_LE((x - expected).cwiseAbs().maxCoeff(), 1e-12) << nodes;
    x = matrix.transpose() * expected;
    solver.solve_transposed(x);
    EXPECT_LE((x - expected).cwiseAbs().maxCoeff(), 1e-12) << nodes;
  }
}

std::vector<int> random_order(int size, std::mt19937& random) {
  std::vector<int> order(size);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  return order;
}

/// A quarter of the entries, and large ones where the pivots are.
Eigen::MatrixXd random_matrix(const std::vector<int>& rows, const std::vector<int>& columns,
                              std::mt19937& random) {
  const auto size = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(size, size);
  matrix = matrix.unaryExpr([&](double entry) { return random() % 4 == 0 ? entry : 0.0; });
  for (std::size_t k = 0; k < rows.size(); ++k)
    matrix(rows[k], columns[k]) = 10.0 + 0.5 * static_cast<double>(size);
  return matrix;
}

/// Sizes around those of blocks, long rows with gaps, and numbers of columns around those of groups.
TEST(PivotedFactors, SolveWhatTheMatrixMultiplies) {
  std::mt19937 random(3);
  for (const int size : {1, 2, 3, 4, 5, 7, 8, 9, 31, 64, 150}) {
    const std::vector<int> rows = random_order(size, random), columns = random_order(size, random);
    const Eigen::MatrixXd first = random_matrix(rows, columns, random);
    PivotedFactors factors(first.sparseView(), rows, columns);
    for (const double factor : {1.0, -0.5}) {  // the same places again
      const Eigen::MatrixXd matrix = factor * first;
      factors.factorize(matrix.sparseView());
      EXPECT_GT(factors.pivot_ratio(), 0.1);
      for (const int count : {1, 2, 4, 5, 8, 9, 17}) {
        const Eigen::MatrixXd expected = Eigen::MatrixXd::Random(size, count);
        Eigen::MatrixXd x = matrix * expected, y = matrix.transpose() * expected;
        factors.solve(x);
        factors.solve_transposed(y);
        EXPECT_LE((x - expected).cwiseAbs().maxCoeff(), 1e-13) << size << ' ' << count;
        EXPECT_LE((y - expected).cwiseAbs().maxCoeff(), 1e-13) << size << ' ' << count;
      }
    }
  }
}

/// A diagonal with a full first row and column: eliminated first they fill everything, last
/// nothing.
TEST(PivotedFactors, HaveTheFillOfTheirOrder) {
  constexpr int size = 20;
  Eigen::MatrixXd arrow = 4.0 * Eigen::MatrixXd::Identity(size, size);
  arrow.row(0).setOnes();
  arrow.col(0).setOnes();
  arrow(0, 0) = size;
  std::vector<int> order(size);
  std::iota(order.begin(), order.end(), 0);
  EXPECT_EQ(PivotedFactors(arrow.sparseView(), order, order).entries(), size * size);
  std::reverse(order.begin(), order.end());
  EXPECT_EQ(PivotedFactors(arrow.sparseView(), order, order).entries(), 3 * size - 2);
}

TEST(PivotedFactors, SeeWhatIsSingular) {
  const std::vector<int> order = {0, 1, 2};
  Eigen::Matrix3d matrix;
  matrix << 1.0, 2.0, 3.0, 2.0, 4.0, 5.0, 3.0, 5.0, 6.0;  // regular, but with a pivot of zero
  PivotedFactors factors(matrix.sparseView(), order, order);
  factors.factorize(matrix.sparseView());
  EXPECT_FALSE(factors.pivot_ratio() > 0.0);
  matrix << 1.0, 2.0, 3.0, 2.0, 5.0, 7.0, 3.0, 7.0, 10.0;  // the third row is the sum of the others
  factors.factorize(matrix.sparseView());
  EXPECT_FALSE(factors.pivot_ratio() > 1e-15);
}

}  // namespace
}  // namespace pleuel::test::linear_solver_test
