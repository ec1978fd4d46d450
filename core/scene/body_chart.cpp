#include "core/scene/body_chart.hpp"

#include <cmath>

#include "core/base/dense_solvers.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Eigenvalues of a matrix with the diagonal 1 that are zero.
constexpr double nothing = 1e-9;

SparseMatrix sparse_of_dense(const MatrixXd& matrix) {
  return matrix.sparseView(1.0, 0.0);
}

/// Where φ = (1, p₀, S) has its parts.
constexpr int first_place = 1, first_shape = 4;
int shape_block(const BodyConstants& body, int axis) {
  return first_shape + axis * body.size();
}

/// G = ∫ρ φ φᵀ
MatrixXd inertia_of(const BodyConstants& body) {
  const int n = body.size(), size = first_shape + 3 * n;
  MatrixXd inertia = MatrixXd::Zero(size, size);
  inertia(0, 0) = body.mass;
  inertia.block(first_place, 0, 3, 1) = body.first_moment;
  inertia.block(first_place, first_place, 3, 3) = body.second_moment;
  const MatrixXd shape(body.shape), mixed(body.mixed);
  for (int l = 0; l < 3; ++l) {
    inertia.block(shape_block(body, l), 0, n, 1) = shape.row(l).transpose();
    for (int k = 0; k < 3; ++k) {
      inertia.block(shape_block(body, l), first_place + k, n, 1) = mixed.row(3 * k + l).transpose();
    }
  }
  for (std::size_t p = 0; p < moment_pairs.size(); ++p) {
    const auto [k, l] = moment_pairs[p];
    inertia.block(shape_block(body, l), shape_block(body, k), n, n) =
        MatrixXd(body.moments[p]).transpose();
  }
  return inertia.selfadjointView<Eigen::Lower>();
}

void set_inertia(BodyConstants& body, const MatrixXd& inertia) {
  const int n = body.size();
  body.mass = inertia(0, 0);
  body.first_moment = inertia.block(first_place, 0, 3, 1);
  body.second_moment = inertia.block(first_place, first_place, 3, 3);
  MatrixXd shape(3, n), mixed(9, n), mass = MatrixXd::Zero(n, n);
  for (int l = 0; l < 3; ++l) {
    shape.row(l) = inertia.block(0, shape_block(body, l), 1, n);
    for (int k = 0; k < 3; ++k) {
      mixed.row(3 * k + l) = inertia.block(first_place + k, shape_block(body, l), 1, n);
    }
  }
  body.shape = sparse_of_dense(shape);
  body.mixed = sparse_of_dense(mixed);
  for (std::size_t p = 0; p < moment_pairs.size(); ++p) {
    const auto [k, l] = moment_pairs[p];
    const MatrixXd moment = inertia.block(shape_block(body, k), shape_block(body, l), n, n);
    body.moments[p] = sparse_of_dense(moment);
    if (k == l) mass += moment;
  }
  body.mass_matrix = sparse_of_dense(mass);
}

/// What has to stay positive.
struct PositiveMatrix {
  MatrixXd (*of)(const BodyConstants&);
  void (*set)(BodyConstants&, const MatrixXd&);
};
const std::array<PositiveMatrix, 3> positive_matrices = {
    {{inertia_of, set_inertia},
     {[](const BodyConstants& body) { return MatrixXd(body.stiffness); },
      [](BodyConstants& body, const MatrixXd& matrix) {
        body.stiffness = sparse_of_dense(matrix);
      }},
     {[](const BodyConstants& body) { return MatrixXd(body.damping); },
      [](BodyConstants& body, const MatrixXd& matrix) {
        body.damping = sparse_of_dense(matrix);
      }}}};

double function_of(bool is_logarithm, double x) {
  return is_logarithm ? std::log(x) : std::exp(x);
}
double slope_of(bool is_logarithm, double x) {
  return is_logarithm ? 1.0 / x : std::exp(x);
}

/// log or exp of a symmetric A = V diag(λ) Vᵀ, and its derivative V (f[λᵢ, λⱼ] ∘ VᵀA′V) Vᵀ with the
/// divided differences of f (Daleckii & Krein 1965).
class MatrixFunction {
 public:
  MatrixFunction(bool is_logarithm, const MatrixXd& matrix)
      : is_logarithm_(is_logarithm), modes_(symmetric_modes(matrix)), values_(modes_.values) {
    if (is_logarithm && !(values_.array() > 0.0).all()) {
      throw SimulationError(
          "inertia, stiffness or damping is not positive in directions in which it was at the "
          "first "
          "design");
    }
    for (double& value : values_) value = function_of(is_logarithm, value);
  }

  MatrixXd value() const {
    return modes_.vectors * values_.asDiagonal() * modes_.vectors.transpose();
  }

  MatrixXd derivative(const MatrixXd& change) const {
    MatrixXd inner = modes_.vectors.transpose() * change * modes_.vectors;
    for (int i = 0; i < int_size(values_); ++i) {
      for (int j = 0; j < int_size(values_); ++j) inner(i, j) *= divided_difference(i, j);
    }
    return modes_.vectors * inner * modes_.vectors.transpose();
  }

 private:
  double divided_difference(int i, int j) const {
    const double a = modes_.values(i), b = modes_.values(j);
    if (std::abs(a - b) > 1e-5 * (std::abs(a) + std::abs(b))) {
      return (values_(i) - values_(j)) / (a - b);
    }
    return slope_of(is_logarithm_, 0.5 * (a + b));  // to second order
  }

  bool is_logarithm_;
  SymmetricModes modes_;
  VectorXd values_;
};

void change_axial(bool is_logarithm, BodyConstants& constants,
                  std::vector<BodyConstants>& derivatives) {
  if (!constants.stretching) return;
  for (std::size_t e = 0; e < constants.stretching->elements.size(); ++e) {
    double& value = constants.stretching->elements[e].axial_stiffness;
    for (BodyConstants& one : derivatives) {
      one.stretching->elements[e].axial_stiffness *= slope_of(is_logarithm, value);
    }
    value = function_of(is_logarithm, value);
  }
}

}  // namespace

BodyChart::BodyChart(const BodyConstants& reference) {
  for (const PositiveMatrix& matrix : positive_matrices) {
    bases_.push_back(basis_of(matrix.of(reference)));
  }
}

BodyChart::Basis BodyChart::basis_of(const MatrixXd& matrix) {
  VectorXd scale = matrix.diagonal();
  for (double& one : scale) one = one > 0.0 ? 1.0 / std::sqrt(one) : 1.0;
  const SymmetricModes modes = symmetric_modes(scale.asDiagonal() * matrix * scale.asDiagonal());
  const auto count = (modes.values.array() > nothing).count();  // in rising order
  return {scale, modes.vectors.rightCols(count)};
}

void BodyChart::change(Way way, BodyConstants& constants,
                       std::vector<BodyConstants>& derivatives) const {
  const bool is_logarithm = way == Way::to_chart;
  for (std::size_t m = 0; m < bases_.size(); ++m) {
    const MatrixXd& v = bases_[m].vectors;
    const VectorXd &scale = bases_[m].scale, unscale = scale.cwiseInverse();
    const VectorXd ones = VectorXd::Ones(scale.size());
    const VectorXd &before = is_logarithm ? scale : ones, &after = is_logarithm ? ones : unscale;
    const auto given = [&](const BodyConstants& of) -> MatrixXd {
      return before.asDiagonal() * positive_matrices[m].of(of) * before.asDiagonal();
    };
    const auto set = [&](BodyConstants& of, const MatrixXd& whole, const MatrixXd& inner,
                         const MatrixXd& changed) {
      const MatrixXd matrix = whole + v * (changed - inner) * v.transpose();
      positive_matrices[m].set(of, after.asDiagonal() * matrix * after.asDiagonal());
    };
    const MatrixXd whole = given(constants), inner = v.transpose() * whole * v;
    const MatrixFunction function(is_logarithm, inner);
    for (BodyConstants& one : derivatives) {
      const MatrixXd slope = given(one), inner_slope = v.transpose() * slope * v;
      set(one, slope, inner_slope, function.derivative(inner_slope));
    }
    set(constants, whole, inner, function.value());
  }
  change_axial(is_logarithm, constants, derivatives);
}

void BodyChart::scale(BodyConstants& constants, double factor) {
  for (const PositiveMatrix& matrix : positive_matrices) {
    matrix.set(constants, factor * matrix.of(constants));
  }
  if (!constants.stretching) return;
  for (StretchedElement& element : constants.stretching->elements) {
    element.axial_stiffness *= factor;
  }
}

}  // namespace pleuel
