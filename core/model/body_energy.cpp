#include "core/model/body_energy.hpp"

#include <array>

#include "core/base/eager_matrices.hpp"
#include "core/model/body_frames.hpp"

namespace pleuel {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Integrals over the body in one configuration, body axes.
struct MassDistribution {
  Vector3d first;        ///< c = ∫ρ p
  Vector3d first_rate;   ///< S̄ q̇_f = ∫ρ ṗ
  Matrix3d second;       ///< M_kl = ∫ρ p_k p_l
  Matrix3d second_rate;  ///< B_kl = ∫ρ p_k ṗ_l
};

/// Quadratic forms of the elastic coordinates and their rates, one pass through the non-zeros.
class ElasticForms {
 public:
  template <class Vector>
  ElasticForms(const Invariants<double>& body, const Vector& q, const Vector& v) {
    switch (body.pairs.size()) {
      case 4:
        add<4>(body, q, v);  // planar motion
        break;
      case 9:
        add<9>(body, q, v);  // spatial motion
        break;
      default:
        add<Eigen::Dynamic>(body, q, v);
    }
  }

  Matrix3d second = Matrix3d::Zero();       ///< q_fᵀ S_kl q_f
  Matrix3d second_rate = Matrix3d::Zero();  ///< q_fᵀ S_kl q̇_f
  double stiffness = 0.0, mass = 0.0, damping = 0.0;

 private:
  /// `Pairs` is the number of pairs (k, l) where the compiler may know it.
  template <int Pairs, class Vector>
  void add(const Invariants<double>& body, const Vector& q, const Vector& v) {
    using Column = Eigen::Matrix<double, Pairs, 1, 0, Pairs == Eigen::Dynamic ? 9 : Pairs, 1>;
    const Eigen::Index pairs = body.pairs.size();
    Column qq = Column::Zero(pairs), qv = qq;
    for (int row = 0; row < body.size(); ++row) {
      for (int i = body.pattern.row_start[row];
           i < body.pattern.row_start[static_cast<std::size_t>(row) + 1]; ++i) {
        const int col = body.pattern.column[i];
        const double q_q = q(row) * q(col), q_v = q(row) * v(col), v_v = v(row) * v(col);
        const Eigen::Map<const Column> moments(body.moments.data() + i * pairs, pairs);
        qq += q_q * moments;
        qv += q_v * moments;
        stiffness += body.stiffness(i) * q_q;
        mass += body.mass_matrix(i) * v_v;
        damping += body.damping(i) * v_v;
      }
    }
    for (std::size_t p = 0; p < body.pairs.size(); ++p) {
      const auto [k, l] = body.pairs[p];
      second(k, l) = qq(p);
      second_rate(k, l) = qv(p);
    }
  }
};

template <class Vector>
MassDistribution mass_distribution(const Invariants<double>& body, const ElasticForms& forms,
                                   const Vector& q, const Vector& v) {
  const Eigen::Matrix<double, 9, 1> mixed = body.mixed * q, mixed_rate = body.mixed * v;
  MassDistribution mass;
  mass.first = body.first_moment + body.shape * q;
  mass.first_rate = body.shape * v;
  mass.second = body.second_moment + forms.second;
  mass.second_rate = forms.second_rate;
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < 3; ++l) {
      mass.second(k, l) += mixed(3 * k + l) + mixed(3 * l + k);
      mass.second_rate(k, l) += mixed_rate(3 * k + l);
    }
  }
  return mass;
}

double kinetic_energy(const FrameMotion<double>& frame, double mass,
                      const MassDistribution& distribution, double elastic) {
  const auto& [first, first_rate, second, B] = distribution;
  const Vector3d& omega = frame.omega;
  const Vector3d velocity = frame.A.transpose() * frame.r_dot;
  // ∫ρ p × ṗ
  const Vector3d spin(B(1, 2) - B(2, 1), B(2, 0) - B(0, 2), B(0, 1) - B(1, 0));
  const double turning = second.trace() * omega.squaredNorm() - omega.dot(second * omega);
  return 0.5 * mass * velocity.squaredNorm() + velocity.dot(omega.cross(first) + first_rate) +
         0.5 * turning + omega.dot(spin) + 0.5 * elastic;
}

/// Weighted derivatives of T and of the weight's potential by the integrals over the body.
struct IntegralSlopes {
  Vector3d first, first_rate;
  Matrix3d second, second_rate;

  IntegralSlopes(const FrameMotion<double>& frame, const Vector3d& gravity,
                 const EnergyWeights& weights) {
    const Vector3d& omega = frame.omega;
    const Vector3d velocity = frame.A.transpose() * frame.r_dot;
    first =
        weights.kinetic * velocity.cross(omega) - weights.weight * (frame.A.transpose() * gravity);
    first_rate = weights.kinetic * velocity;
    second = 0.5 * weights.kinetic *
             (omega.squaredNorm() * Matrix3d::Identity() - omega * omega.transpose());
    second_rate = weights.kinetic * skew<double>(omega).transpose();
  }
};

/// The part of the elastic coordinates.
class ElasticGradient {
 public:
  ElasticGradient(const Invariants<double>& body, const IntegralSlopes& slopes,
                  const EnergyWeights& weights)
      : body_(body), slopes_(slopes), weights_(weights) {}

  template <class Vector, class Gradient>
  void add(const Vector& q, const Vector& v, Gradient by_q, Gradient by_v) const {
    by_q += body_.shape.transpose() * slopes_.first;
    by_v += body_.shape.transpose() * slopes_.first_rate;
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 3; ++l) {
        const auto mixed = body_.mixed.row(3 * k + l).transpose();
        by_q += (slopes_.second(k, l) + slopes_.second(l, k)) * mixed;
        by_v += slopes_.second_rate(k, l) * mixed;
      }
    }
    for (int row = 0; row < body_.size(); ++row) {
      const auto begin = body_.pattern.row_start[row];
      const auto end = body_.pattern.row_start[static_cast<std::size_t>(row) + 1];
      for (int i = begin; i < end; ++i) {
        const int col = body_.pattern.column[i];
        const auto [qq, qv, vv] = forms(i);
        by_q(row) += qq * q(col) + qv * v(col);
        by_q(col) += qq * q(row);
        by_v(row) += vv * v(col);
        by_v(col) += vv * v(row) + qv * q(row);
      }
    }
  }

 private:
  /// Weighted coefficients of q_row q_col, q_row v_col and v_row v_col.
  std::array<double, 3> forms(int entry) const {
    double qq = 0.5 * weights_.elastic * body_.stiffness(entry), qv = 0.0;
    for (std::size_t p = 0; p < body_.pairs.size(); ++p) {
      const auto [k, l] = body_.pairs[p];
      const double moment = body_.moments(entry, p);
      qq += slopes_.second(k, l) * moment;
      qv += slopes_.second_rate(k, l) * moment;
    }
    return {qq, qv,
            0.5 * weights_.kinetic * body_.mass_matrix(entry) +
                weights_.dissipation * body_.damping(entry)};
  }

  const Invariants<double>& body_;
  const IntegralSlopes& slopes_;
  const EnergyWeights& weights_;
};

/// That of the frame's coordinates.
template <class Gradient>
void add_frame_gradient(const BodyModel& body, const FrameMotion<double>& frame,
                        const MassDistribution& distribution, const Vector3d& gravity,
                        const EnergyWeights& weights, Gradient by_q, Gradient by_v) {
  const auto& [first, first_rate, second, B] = distribution;
  const double mass = body.invariants.mass;
  const Vector3d& omega = frame.omega;
  const Vector3d relative = omega.cross(first) + first_rate;
  const Vector3d velocity = frame.A.transpose() * frame.r_dot;
  const Vector3d spin(B(1, 2) - B(2, 1), B(2, 0) - B(0, 2), B(0, 1) - B(1, 0));
  const int k = body.frame.translations();
  by_v.head(k) +=
      weights.kinetic * body.frame.basis.transpose() * (mass * frame.r_dot + frame.A * relative);
  by_q.head(k) -= weights.weight * mass * body.frame.basis.transpose() * gravity;
  by_v.tail(body.frame.rotations()) +=
      weights.kinetic * frame.G.transpose() *
      (first.cross(velocity) + second.trace() * omega - second * omega + spin);
  for (int i = 0; i < body.frame.rotations(); ++i) {
    const Matrix3d& turn = frame.A_p[i];
    by_q(k + i) += weights.kinetic * frame.r_dot.dot(turn * relative) -
                   weights.weight * gravity.dot(turn * first);
  }
}

}  // namespace

BodyEnergy body_energy(const BodyModel& body, const Invariants<double>& invariants,
                       const Vector3d& gravity, const State& state) {
  const auto frame = frame_motion(body.frame, state);
  const auto q = state.q.segment(body.elastic_offset(), invariants.size());
  const auto v = state.v.segment(body.elastic_offset(), invariants.size());
  const ElasticForms forms(invariants, q, v);
  const MassDistribution distribution = mass_distribution(invariants, forms, q, v);
  BodyEnergy energy;
  energy.kinetic = kinetic_energy(frame, invariants.mass, distribution, forms.mass);
  energy.elastic = 0.5 * forms.stiffness;
  energy.weight = -gravity.dot(invariants.mass * frame.r + frame.A * distribution.first);
  energy.dissipation = forms.damping;
  return energy;
}

void add_energy_gradient(const BodyModel& body, const Vector3d& gravity, const State& state,
                         const EnergyWeights& weights, Eigen::VectorXd& q, Eigen::VectorXd& v) {
  const Invariants<double>& invariants = body.invariants;
  const auto frame = frame_motion(body.frame, state);
  const int offset = body.elastic_offset(), size = invariants.size();
  const auto q_f = state.q.segment(offset, size), v_f = state.v.segment(offset, size);
  const MassDistribution distribution =
      mass_distribution(invariants, ElasticForms(invariants, q_f, v_f), q_f, v_f);
  add_frame_gradient(body, frame, distribution, gravity, weights,
                     q.segment(body.frame.offset, body.frame.size()),
                     v.segment(body.frame.offset, body.frame.size()));
  const IntegralSlopes slopes(frame, gravity, weights);
  ElasticGradient(invariants, slopes, weights)
      .add(q_f, v_f, q.segment(offset, size), v.segment(offset, size));
}

BodyEnergy energy_of_bodies(const Model& model, const State& state) {
  BodyEnergy sum;
  for (const BodyModel& body : model.bodies) {
    const BodyEnergy energy = body_energy(body, body.invariants, model.gravity, state);
    sum.kinetic += energy.kinetic;
    sum.elastic += energy.elastic;
    sum.weight += energy.weight;
    sum.dissipation += energy.dissipation;
  }
  return sum;
}

TermsBesidesBodies terms_besides_bodies(const Model& model) {
  TermsBesidesBodies besides;
  for (const auto& [body, term] : model.terms.stiffening) besides.stiffening.push_back(term);
  besides.acting = model.terms.joints;
  besides.acting.insert(besides.acting.end(), model.terms.loads.begin(), model.terms.loads.end());
  return besides;
}

}  // namespace pleuel
