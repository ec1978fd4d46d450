#include "reduction/symmetric_solver.hpp"

#include <string>
#include <vector>

#include <dmumps_c.h>
#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"

namespace pleuel {

namespace {

constexpr int use_own_world = -987654;  // of the library without MPI
enum Job { begin = -1, end = -2, analyze_and_factorize = 4, solve_system = 3 };

}  // namespace

/// The structure of MUMPS, its arrays as they are numbered in its manual, and the matrix that it refers to.
struct SymmetricSolver::Mumps {
  mutable DMUMPS_STRUC_C data{};
  std::vector<int> rows, columns;
  std::vector<double> values;

  int& control(int number) const { return data.icntl[number - 1]; }
  int info(int number) const { return data.infog[number - 1]; }

  void call(Job job, const char* what) const {
    data.job = job;
    dmumps_c(&data);
    if (info(1) >= 0) return;
    const std::string cause =
        info(1) == -9 || info(1) == -13 ? "not enough memory" : "see its manual";
    throw SimulationError(
        fmt::format("MUMPS cannot {} a matrix of {} rows: its INFOG(1) is {}, INFOG(2) is {} ({})",
                    what, data.n, info(1), info(2), cause));
  }
};

SymmetricSolver::SymmetricSolver(const Eigen::SparseMatrix<double>& matrix)
    : mumps_(std::make_unique<Mumps>()) {
  DMUMPS_STRUC_C& data = mumps_->data;
  data.par = 1;
  data.sym = 2;
  data.comm_fortran = use_own_world;
  mumps_->call(begin, "begin with");
  for (int column = 0; column < matrix.outerSize(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, column); entry; ++entry) {
      if (entry.row() < column) continue;
      mumps_->rows.push_back(static_cast<int>(entry.row()) + 1);
      mumps_->columns.push_back(column + 1);
      mumps_->values.push_back(entry.value());
    }
  }
  data.n = static_cast<int>(matrix.rows());
  data.nnz = static_cast<MUMPS_INT8>(mumps_->values.size());
  data.irn = mumps_->rows.data();
  data.jcn = mumps_->columns.data();
  data.a = mumps_->values.data();
  for (int output = 1; output <= 3; ++output) mumps_->control(output) = -1;
  mumps_->control(4) = 0;
  mumps_->control(14) = 50;  // more memory than estimated [%]: pivots of the constraints
  mumps_->control(24) = 1;   // find null pivots
  mumps_->call(analyze_and_factorize, "factorize");
}

SymmetricSolver::~SymmetricSolver() {
  mumps_->data.job = end;
  dmumps_c(&mumps_->data);
}

Eigen::MatrixXd SymmetricSolver::solve(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd x = b;
  if (x.size() == 0) return x;
  mumps_->data.nrhs = static_cast<int>(x.cols());
  mumps_->data.lrhs = static_cast<int>(x.rows());
  mumps_->data.rhs = x.data();
  mumps_->call(solve_system, "solve with");
  return x;
}

int SymmetricSolver::null_pivots() const {
  return mumps_->info(28);
}

int SymmetricSolver::negative_pivots() const {
  return mumps_->info(12);
}

}  // namespace pleuel
