#include "core/linear/modes.hpp"

#include <algorithm>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/sparse_rows.hpp"
#include "core/linear/elastic_stability.hpp"
#include "core/linear/free_deformations.hpp"

namespace pleuel {

namespace {

/// The shift σ as a share of the largest frequency without damping.
constexpr double shift_share = 1e-4;
/// Below this share of σ a motion counts as free: its double eigenvalue 0 comes out of the solver
/// as σ √(machine precision), some 1e-8 σ.
constexpr double free_motion = 1e-4;
/// Constraints of which less is left across others are dependent.
constexpr double independent = 1e-10;

/// Matrices on the free motions, with unit inertia.
class ReducedMotions {
 public:
  explicit ReducedMotions(const Linearization& linearized)
      : linearized_(linearized), n_(linearized.M.rows()) {
    Eigen::MatrixXd phi = linearized.phi;
    for (const int row : linearized.left_out) phi.row(row).setZero();
    null_space_ = null_space_of_rows(phi.sparseView(), independent);
    mass_ = Cholesky(null_space_.transpose() * linearized.M * null_space_);
    if (!mass_.is_positive_definite()) {
      throw SimulationError("the natural frequencies do not exist: a free motion has no inertia");
    }
  }

  Eigen::Index count() const { return null_space_.cols(); }

  /// By how much constraints Φ do not allow these motions.
  double apart(const Eigen::MatrixXd& phi) const { return (phi * null_space_).norm(); }

  /// L⁻¹ Zᵀ (matrix) Z L⁻ᵀ
  Eigen::MatrixXd project(const Eigen::MatrixXd& matrix) const {
    const Eigen::MatrixXd half = mass_.solve_lower(null_space_.transpose() * matrix);
    return mass_.solve_lower((half * null_space_).transpose()).transpose();
  }

  /// (σ² + σG + K)⁻¹ = Lᵀ Zᵀ P⁻¹ Z L, with P⁻¹ from the pencil.
  Eigen::MatrixXd flexibility(double sigma) const {
    const Eigen::MatrixXd pencil = pencil_at(linearized_, sigma).matrix.real();
    Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(pencil.rows(), count());
    rhs.topRows(n_) = null_space_ * mass_.lower();
    const Eigen::MatrixXd solution = DenseLu(pencil).solve(rhs);
    return mass_.lower().transpose() * (null_space_.transpose() * solution.topRows(n_));
  }

 private:
  const Linearization& linearized_;
  Eigen::Index n_;
  Eigen::MatrixXd null_space_;
  Cholesky mass_;
};

}  // namespace

MotionAxes::MotionAxes(const Mechanism& mechanism, const State& state, Kind kind)
    : mechanism_(mechanism), kind_(kind) {
  if (kind != Kind::rotor) return;
  kind_ = Kind::standing;
  if (!is_rotor(mechanism, state)) return;
  const std::vector<TurningBody> bodies = turning_bodies(mechanism, state);
  const double fastest = fastest_turn(mechanism, state).omega.norm();
  const auto rotor = std::ranges::find_if(bodies, [&](const TurningBody& body) {
    return std::ranges::find(mechanism.elastic, body.elastic) != mechanism.elastic.end() &&
           body.turn.omega.norm() > 0.5 * fastest;
  });
  if (rotor == bodies.end()) return;
  kind_ = Kind::rotor;
  rotor_ = static_cast<std::size_t>(rotor - bodies.begin());
  if (!is_constant(state)) kind_ = Kind::standing;
}

Turning MotionAxes::at(const State& state) const {
  if (kind_ == Kind::standing) return standing_axes(mechanism_, state);
  return rotor_turning(mechanism_, state, turning_bodies(mechanism_, state)[rotor_].turn);
}

/// Whether a small turn changes hardly anything, relative to the stiffness of the motions, which stay
/// allowed.
bool MotionAxes::is_constant(const State& state) const {
  constexpr double angle = 1e-4, share = 1e-2;
  const double speed = fastest_turn(mechanism_, state).omega.norm();
  const State moved = advanced(mechanism_, state, angle / speed);
  const Linearization here = linearize(mechanism_, state, at(state), true),
                      there = linearize(mechanism_, moved, at(moved), true);
  const ReducedMotions motions(here);
  const Eigen::MatrixXd flexibility = motions.flexibility(speed);
  const Eigen::MatrixXd change = motions.project(there.K - here.K) +
                                 speed * motions.project(there.G - here.G) +
                                 speed * speed * motions.project(there.M - here.M);
  return (flexibility * change).norm() <= angle * share &&
         motions.apart(there.phi) <= angle * share * there.phi.norm();
}

Pencil pencil_at(const Linearization& linearized, std::complex<double> s) {
  const Eigen::Index n = linearized.M.rows(), m = linearized.phi.rows();
  Pencil pencil;
  const double constraints = linearized.phi.norm(),
               stiffness = linearized.K.norm() + linearized.M.norm();
  if (constraints > 0.0 && stiffness > 0.0) pencil.kappa = stiffness / constraints;
  pencil.matrix = Eigen::MatrixXcd::Zero(n + m, n + m);
  pencil.matrix.topLeftCorner(n, n) = s * s * linearized.M + s * linearized.G + linearized.K;
  pencil.matrix.topRightCorner(n, m) = pencil.kappa * linearized.phi.transpose();
  pencil.matrix.bottomLeftCorner(m, n) = pencil.kappa * linearized.phi;
  for (int i : linearized.left_out) pencil.matrix(n + i, n + i) = pencil.kappa;
  return pencil;
}

namespace {

/// Of vibrations without damping, which may be faster by far than what is slow beside them; of motions without
/// stiffness that of gyroscopic forces.
double largest_frequency(double stiffness, double gyroscopic) {
  const double vibrations = std::sqrt(stiffness);
  return vibrations > free_motion * shift_share * gyroscopic ? vibrations : gyroscopic;
}

/// s of ω² = 1/θ − σ² for the eigenvalues θ of a symmetric F.
Eigen::VectorXcd conservative_eigenvalues(const Eigen::MatrixXd& flexibility, double sigma) {
  const Eigen::VectorXd theta =
      symmetric_eigenvalues(0.5 * (flexibility + flexibility.transpose()));
  Eigen::VectorXcd values(theta.size());
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    values(i) = std::sqrt(std::complex<double>(sigma * sigma - 1.0 / theta(i), 0.0));
  }
  return values;
}

Eigen::VectorXcd gyroscopic_eigenvalues(const Eigen::MatrixXd& flexibility,
                                        const Eigen::MatrixXd& gyroscopic, double sigma) {
  const Eigen::Index n = flexibility.rows();
  Eigen::MatrixXd inverse(2 * n, 2 * n);
  inverse.topLeftCorner(n, n) =
      -flexibility * (gyroscopic + sigma * Eigen::MatrixXd::Identity(n, n));
  inverse.bottomLeftCorner(n, n) = inverse.topLeftCorner(n, n);
  inverse.bottomLeftCorner(n, n).diagonal().array() += 1.0 / sigma;
  inverse.topRightCorner(n, n) = -sigma * flexibility;
  inverse.bottomRightCorner(n, n) = -sigma * flexibility;
  const Eigen::VectorXcd theta = eigenvalues_of(inverse);
  return sigma + theta.array().inverse();
}

}  // namespace

Eigen::VectorXcd modes_of(const Linearization& linearized) {
  const ReducedMotions motions(linearized);
  if (motions.count() == 0) return {};
  const Eigen::MatrixXd gyroscopic = motions.project(linearized.G),
                        stiffness = motions.project(linearized.K);
  const double largest = largest_frequency(stiffness.norm(), gyroscopic.norm());
  if (largest == 0.0) return {};
  const double sigma = shift_share * largest;
  const Eigen::MatrixXd flexibility = motions.flexibility(sigma);
  const bool is_conservative = gyroscopic.isZero(0.0) && is_symmetric(stiffness, 1e-10);
  const Eigen::VectorXcd values = is_conservative
                                      ? conservative_eigenvalues(flexibility, sigma)
                                      : gyroscopic_eigenvalues(flexibility, gyroscopic, sigma);
  if (!values.array().isFinite().all()) {
    throw SimulationError("the natural frequencies do not exist: the equations are singular");
  }
  std::vector<std::complex<double>> modes;
  for (const std::complex<double>& s : values) {
    const bool is_vibration = s.imag() > free_motion * sigma;
    const bool is_real = std::abs(s.imag()) <= free_motion * sigma;
    const bool counts = linearized.is_damped ? std::abs(s.real()) > free_motion * sigma
                                             : s.real() > free_motion * sigma;
    if (is_vibration || (is_real && counts)) modes.push_back(s);
  }
  std::ranges::sort(modes,
                    [](const auto& a, const auto& b) { return frequency_of(a) < frequency_of(b); });
  return Eigen::Map<Eigen::VectorXcd>(modes.data(), modes.size());
}

bool vibrates(std::complex<double> s) {
  return s.imag() > 1e-8 * std::abs(s);
}

double frequency_of(std::complex<double> s) {
  return vibrates(s) ? s.imag() : -s.real();
}

std::optional<std::complex<double>> growing_mode(const Mechanism& mechanism, const State& state) {
  constexpr double noise = 1e-4;
  const Eigen::VectorXcd modes = modes_of(linearize(mechanism, state, true));
  std::optional<std::complex<double>> fastest;
  for (const std::complex<double>& mode : modes) {
    const bool grows = mode.real() > noise * std::abs(mode);
    if (grows && (!fastest || mode.real() > fastest->real())) fastest = mode;
  }
  return fastest;
}

Eigen::VectorXd frequencies_of(const Linearization& linearized) {
  return modes_of(linearized).unaryExpr(&frequency_of).real();
}

}  // namespace pleuel
