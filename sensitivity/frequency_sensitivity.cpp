#include "sensitivity/frequency_sensitivity.hpp"

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/response/modal_vectors.hpp"

namespace pleuel {

namespace {

using Complex = std::complex<double>;

/// Size of the steps of differences, relative to the scales of the coordinates.
constexpr double step_size = 1e-3;

/// Elastic coordinates are scaled to displacements of this share of a body's length.
constexpr double elastic_scale = 1e-3;

/// A direction in the space of states.
struct Direction {
  Eigen::VectorXd q, v, a, lambda;
};

class FrequencySensitivity {
 public:
  FrequencySensitivity(const Model& model, const State& state, const ModeChoice& choice)
      : FrequencySensitivity(
            LinearizedModes(model, state, choice.counts_damping(), axes_of(choice)), state,
            choice) {}

  FrequencySensitivity(const LinearizedModes& modes, const State& state, const ModeChoice& choice)
      : mechanism_(modes.model.mechanism),
        state_(state),
        n_(state.q.size()),
        m_(state.lambda.size()),
        of_(choice.of),
        axes_(modes.axes),
        linearized_(modes.linearized),
        vectors_(modal_vectors(linearized_, modes.modes, find_mode(modes, choice))) {
    const Eigen::Index count = vectors_.right.cols();
    counted_ = choice.axis ? combinations_along(vectors_.right, linearized_.M,
                                                modes.mass_along(*choice.axis))
                           : Eigen::MatrixXcd::Identity(count, count).eval();
    const Eigen::MatrixXcd inertia = vectors_.right.adjoint() * linearized_.M * vectors_.right;
    components_ = choice.axis ? (counted_.adjoint() * inertia).eval() : counted_;
  }

  Eigen::VectorXd run(const StateSensitivity& sensitivity) const {
    const Complex s = vectors_.s;
    const Eigen::MatrixXcd slope =
        vectors_.left.adjoint() * (2.0 * s * linearized_.M + linearized_.G) * vectors_.right;
    const ComplexLu solver(slope);
    std::vector<Eigen::MatrixXcd> changes = changes_by_design();
    Eigen::VectorXd result(changes.size());
    for (std::size_t j = 0; j < changes.size(); ++j) {
      changes[j] += change_along({sensitivity.q.col(j), sensitivity.v.col(j), sensitivity.a.col(j),
                                  sensitivity.lambda.col(j)});
      const Complex sum = (components_ * solver.solve(changes[j]) * counted_).trace();
      const Complex change = -sum / static_cast<double>(counted_.cols());
      result(j) = change_of_number(of_, s, change);
    }
    return result;
  }

 private:
  /// d/dε of a function along a direction. All of them are linear in accelerations and multipliers, so
  /// these take no small steps, which would drown in the round-off of the stiffness of short elements.
  template <class Function>
  auto derivative_along(const Direction& direction, const Function& function) const {
    Direction motion = direction, forces = nowhere();
    std::swap(motion.a, forces.a);
    std::swap(motion.lambda, forces.lambda);
    const auto central = [&](const Direction& along, double h) {
      return ((function(moved(along, h)) - function(moved(along, -h))) / (2.0 * h)).eval();
    };
    const double step = step_size / std::max(size_of(motion), 1e-300);
    const auto wide = central(motion, step), narrow = central(motion, 0.5 * step);
    return ((4.0 * narrow - wide) / 3.0 + central(forces, 1.0)).eval();
  }

  /// Deflections of a thousandth of a body's length are as far from linear as rotations of that size.
  double size_of(const Direction& motion) const {
    const auto largest = [](const auto& vector) {
      return vector.template lpNorm<Eigen::Infinity>();
    };
    Eigen::VectorXd positions = motion.q.cwiseQuotient(mechanism_.scale);
    positions(mechanism_.elastic) *= elastic_scale;
    return std::max(largest(positions), largest(motion.v) / (1.0 + largest(state_.v)));
  }

  State moved(const Direction& direction, double step) const {
    State state = state_;
    advance(mechanism_.rotations, state_.q, step * direction.q, state.q);
    state.v += step * direction.v;
    state.a += step * direction.a;
    state.lambda += step * direction.lambda;
    return state;
  }

  /// ψᴴ P' φ along a change of the state, k × k.
  Eigen::MatrixXcd change_along(const Direction& direction) const {
    const Complex s = vectors_.s;
    return derivative_along(direction, [&](const State& state) {
      const Linearization at = linearize(mechanism_, state, axes_.at(state), linearized_.is_damped);
      const Eigen::MatrixXcd pencil = s * s * at.M + s * at.G + at.K;
      return (vectors_.left.adjoint() * pencil * vectors_.right +
              vectors_.left.adjoint() * at.phi.transpose() * vectors_.right_multipliers +
              vectors_.left_multipliers.adjoint() * at.phi * vectors_.right)
          .eval();
    });
  }

  /// The explicit part of ψᴴ P' φ, k × k for each variable: matrices are derivatives of R along
  /// vectors, so theirs by the design are those of R_x.
  std::vector<Eigen::MatrixXcd> changes_by_design() const {
    const Complex s = vectors_.s;
    const Eigen::Index count = vectors_.right.cols();
    std::vector<Eigen::MatrixXcd> changes(mechanism_.system->variables(),
                                          Eigen::MatrixXcd::Zero(count, count));
    if (changes.empty()) return changes;
    const Turning axes = axes_.at(state_);
    const auto times = [](const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXcd& y) {
      return (matrix.cast<Complex>() * y).eval();
    };
    // G y = Tᵀ (R_v T + R_a P) y, or the skew part of that
    const auto forces_of_rates = [&](const Eigen::VectorXcd& y) {
      return along({{&Direction::v, times(axes.T, y)}, {&Direction::a, times(axes.P, y)}})
          .topRows(n_)
          .eval();
    };
    std::vector<Eigen::MatrixXcd> rates_of_left;
    for (Eigen::Index i = 0; i < count; ++i) {
      rates_of_left.push_back(forces_of_rates(vectors_.left.col(i).conjugate()));
    }
    for (Eigen::Index j = 0; j < count; ++j) {
      const Eigen::VectorXcd y = vectors_.right.col(j), right = times(axes.T, y);
      const Eigen::MatrixXcd rates = forces_of_rates(y),
                             whole =
                                 along({{&Direction::q, right},
                                        {&Direction::v, times(axes.V, y)},
                                        {&Direction::a, s * s * right + times(axes.Q, y)},
                                        {&Direction::lambda, vectors_.right_multipliers.col(j)}});
      for (Eigen::Index i = 0; i < count; ++i) {
        const Eigen::VectorXcd left = times(axes.T, vectors_.left.col(i));
        Eigen::RowVectorXcd of_rates = left.adjoint() * rates;
        if (!linearized_.is_damped) {
          of_rates = 0.5 * (of_rates - right.transpose() * rates_of_left[i]);
        }
        const Eigen::RowVectorXcd row =
            left.adjoint() * whole.topRows(n_) +
            vectors_.left_multipliers.col(i).adjoint() * whole.bottomRows(m_) + s * of_rates;
        for (std::size_t k = 0; k < changes.size(); ++k) {
          changes[k](i, j) += row(k);
        }
      }
    }
    return changes;
  }

  Direction nowhere() const {
    return {Eigen::VectorXd::Zero(n_), Eigen::VectorXd::Zero(n_), Eigen::VectorXd::Zero(n_),
            Eigen::VectorXd::Zero(m_)};
  }

  /// A part of a complex direction.
  struct ComplexPart {
    Eigen::VectorXd Direction::*part;
    Eigen::VectorXcd vector;
  };

  /// Derivatives of R_x along a complex direction, (n + m) × variables.
  Eigen::MatrixXcd along(const std::vector<ComplexPart>& parts) const {
    Direction real = nowhere(), imaginary = nowhere();
    for (const auto& [part, vector] : parts) {
      real.*part = vector.real();
      imaginary.*part = vector.imag();
    }
    const auto design_derivative = [&](const State& state) {
      Eigen::MatrixXd columns;
      mechanism_.system->design_derivative(state, ConstraintLevel::position, columns);
      return columns;
    };
    return derivative_along(real, design_derivative).cast<Complex>() +
           Complex(0.0, 1.0) * derivative_along(imaginary, design_derivative).cast<Complex>();
  }

  const Mechanism& mechanism_;
  const State& state_;
  Eigen::Index n_, m_;
  ModeNumber of_;
  MotionAxes axes_;
  Linearization linearized_;
  ModalVectors vectors_;
  /// Combinations of the vectors that count, k × p, and what of each is in a combination, p × k.
  Eigen::MatrixXcd counted_, components_;
};

}  // namespace

Eigen::VectorXd frequency_sensitivity(const Model& model, const State& state,
                                      const StateSensitivity& sensitivity,
                                      const ModeChoice& choice) {
  return FrequencySensitivity(model, state, choice).run(sensitivity);
}

}  // namespace pleuel
