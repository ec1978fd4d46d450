#include "core/model/initial_deflections.hpp"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/model/attachment.hpp"

namespace pleuel {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Eigen::SparseMatrix<double> stiffness_of(const Invariants<double>& invariants) {
  const ElasticPattern& pattern = invariants.pattern;
  std::vector<Eigen::Triplet<double>> entries;
  for (int row = 0; row < pattern.size; ++row) {
    for (int k = pattern.row_start[row]; k < pattern.row_start[row + 1]; ++k) {
      entries.emplace_back(row, pattern.column[k], invariants.stiffness(k));
    }
  }
  Eigen::SparseMatrix<double> matrix(pattern.size, pattern.size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// What the file gives: a row each, and the displacements and rates along them.
struct Given {
  MatrixXd rows;      ///< S, places × elastic coordinates
  MatrixXd measures;  ///< d, ḋ: places × 2
};

class InitialShape {
 public:
  InitialShape(std::size_t body, const std::vector<BodyModel>& bodies, const BuildContext& context)
      : context_(context), body_(context.scene.bodies[body]), model_(bodies[body]) {
    for (const InitialDeflection& one : body_.initial_deflections) {
      places_.emplace_back(body_.name, one.at, bodies, context);
    }
    given_ = given();
    stiffness_.compute(stiffness_of(model_.invariants));
    const MatrixXd shapes = stiffness_.solve(MatrixXd(given_.rows.transpose()));
    require_independence(given_.rows * shapes);
    compliance_.compute(given_.rows * shapes);
    shapes_ = shapes;
    pulls_ = compliance_.solve(given_.measures);
  }

  /// Elastic coordinates and their rates, n × 2.
  MatrixXd shape() const { return shapes_ * pulls_; }

  /// K q' = S'ᵀ μ + Sᵀ μ' − K' q,   S q' = d' − S' q.
  MatrixXd derivative(int variable) const {
    const Given change = given_change(variable);
    const MatrixXd q = shape();
    MatrixXd rhs = change.rows.transpose() * pulls_;
    for (const auto& [of, invariants] : model_.invariants_x) {
      if (of == variable) rhs -= stiffness_of(invariants) * q;
    }
    const MatrixXd free = stiffness_.solve(rhs);
    const MatrixXd gap = change.measures - change.rows * q - given_.rows * free;
    return free + shapes_ * compliance_.solve(gap);
  }

 private:
  static Eigen::Vector3d direction_of(const InitialDeflection& one) {
    return {one.direction[0], one.direction[1], one.direction[2]};
  }

  /// A displacement u v w of a place, local axes, from the elastic coordinates of the body.
  MatrixXd widened(const Attachment::Rows& rows, const MatrixXd& values) const {
    MatrixXd wide = MatrixXd::Zero(3, model_.elastic_size());
    for (std::size_t k = 0; k < rows.coordinates.size(); ++k) {
      wide.col(rows.coordinates[k] - model_.elastic_offset()) =
          values.col(static_cast<Eigen::Index>(k)).head<3>();
    }
    return wide;
  }

  Given none() const {
    const auto count = static_cast<Eigen::Index>(places_.size());
    return {MatrixXd::Zero(count, model_.elastic_size()), MatrixXd::Zero(count, 2)};
  }

  Given given() const {
    Given result = none();
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const InitialDeflection& one = body_.initial_deflections[i];
      const auto row = static_cast<Eigen::Index>(i);
      const Attachment::Rows& rows = places_[i].displacement_rows();
      const Eigen::Vector3d local = places_[i].local_direction(direction_of(one), context_.design);
      result.rows.row(row) = local.transpose() * widened(rows, rows.values);
      result.measures(row, 0) = resolve(one.displacement, context_.design);
      result.measures(row, 1) = resolve(one.rate, context_.design);
    }
    return result;
  }

  Given given_change(int variable) const {
    Given result = none();
    const Design<Dual> seeded = context_.seeded(variable);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const InitialDeflection& one = body_.initial_deflections[i];
      const auto row = static_cast<Eigen::Index>(i);
      const Attachment::Rows& rows = places_[i].displacement_rows();
      const Vector3<Dual> turning = places_[i].local_direction(direction_of(one), seeded);
      const Eigen::Vector3d local = places_[i].local_direction(direction_of(one), context_.design);
      result.rows.row(row) = derivative_matrix(turning).transpose() * widened(rows, rows.values);
      for (const auto& [of, change] : rows.derivatives) {
        if (of == variable) result.rows.row(row) += local.transpose() * widened(rows, change);
      }
      result.measures(row, 0) = derivative_of(resolve(one.displacement, seeded));
      result.measures(row, 1) = derivative_of(resolve(one.rate, seeded));
    }
    return result;
  }

  /// Of compliances C between the places: none is zero, and their correlations are not singular.
  void require_independence(const MatrixXd& compliance) const {
    const VectorXd own = compliance.diagonal();
    for (Eigen::Index i = 0; i < own.size(); ++i) {
      if (own(i) > 1e-12 * own.maxCoeff() && own(i) > 0.0) continue;
      fail(static_cast<std::size_t>(i),
           "cannot be: the frame of the body holds the place in this direction, or effects left "
           "out keep it from moving");
    }
    const VectorXd scale = own.cwiseSqrt().cwiseInverse();
    MatrixXd correlation = scale.asDiagonal() * compliance * scale.asDiagonal();
    for (Eigen::Index i = 1; i < own.size(); ++i) {
      const Eigen::LDLT<MatrixXd> factors(correlation.topLeftCorner(i + 1, i + 1));
      if (factors.vectorD().minCoeff() > 1e-10) continue;
      fail(static_cast<std::size_t>(i), "says the same as those before it, or contradicts them");
    }
  }

  [[noreturn]] void fail(std::size_t i, const char* why) const {
    throw InputError(fmt::format("body \"{}\": the initial deflection {} {}", body_.name, i, why));
  }

  const BuildContext& context_;
  const Body& body_;
  const BodyModel& model_;
  std::vector<Attachment> places_;
  Given given_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> stiffness_;
  MatrixXd shapes_;  ///< K⁻¹ Sᵀ
  Eigen::LDLT<MatrixXd> compliance_;
  MatrixXd pulls_;  ///< μ, ν
};

}  // namespace

void set_initial_deflections(std::size_t body, const std::vector<BodyModel>& bodies,
                             const BuildContext& context, Mechanism& mechanism) {
  const Body& of = context.scene.bodies[body];
  const BodyModel& model = bodies[body];
  if (of.initial_deflections.empty() || model.elastic_size() == 0) return;
  const InitialShape initial(body, bodies, context);
  const int offset = model.elastic_offset(), size = model.elastic_size();
  const MatrixXd shape = initial.shape();
  mechanism.guess.q.segment(offset, size) = shape.col(0);
  mechanism.guess.v.segment(offset, size) = shape.col(1);
  for (const int variable : variables_of(of, context.scene)) {
    const MatrixXd change = initial.derivative(variable);
    mechanism.guess_q_x.col(variable).segment(offset, size) = change.col(0);
    mechanism.guess_v_x.col(variable).segment(offset, size) = change.col(1);
  }
}

}  // namespace pleuel
