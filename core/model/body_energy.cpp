#include "core/model/body_energy.hpp"

#include <cassert>

#include "core/effects/floating_frame_body.hpp"

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
    const auto pairs = static_cast<Eigen::Index>(body.pairs.size());
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 9, 1> qq(pairs), qv(pairs);
    qq.setZero();
    qv.setZero();
    for (int row = 0; row < body.size(); ++row) {
      for (int i = body.pattern.row_start[static_cast<std::size_t>(row)];
           i < body.pattern.row_start[static_cast<std::size_t>(row) + 1]; ++i) {
        const int col = body.pattern.column[static_cast<std::size_t>(i)];
        const double q_q = q(row) * q(col), q_v = q(row) * v(col), v_v = v(row) * v(col);
        const double* moments = body.moments.data() + i * pairs;
        for (Eigen::Index p = 0; p < pairs; ++p) {
          qq(p) += moments[p] * q_q;
          qv(p) += moments[p] * q_v;
        }
        stiffness += body.stiffness(i) * q_q;
        mass += body.mass_matrix(i) * v_v;
        damping += body.damping(i) * v_v;
      }
    }
    for (std::size_t p = 0; p < body.pairs.size(); ++p) {
      const auto [k, l] = body.pairs[p];
      second(k, l) = qq(static_cast<Eigen::Index>(p));
      second_rate(k, l) = qv(static_cast<Eigen::Index>(p));
    }
  }

  Matrix3d second = Matrix3d::Zero();       ///< q_fᵀ S_kl q_f
  Matrix3d second_rate = Matrix3d::Zero();  ///< q_fᵀ S_kl q̇_f
  double stiffness = 0.0, mass = 0.0, damping = 0.0;
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

}  // namespace

BodyEnergy body_energy(const BodyModel& body, const Vector3d& gravity, const State& state) {
  const Invariants<double>& invariants = body.invariants;
  const int offset = body.frame.offset, size = body.frame.size();
  const auto frame =
      frame_motion<double>(body.frame, state.q.segment(offset, size), state.v.segment(offset, size),
                           state.a.segment(offset, size));
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

BodyEnergy energy_of_bodies(const Model& model, const State& state) {
  BodyEnergy sum;
  for (const BodyModel& body : model.bodies) {
    const BodyEnergy energy = body_energy(body, model.gravity, state);
    sum.kinetic += energy.kinetic;
    sum.elastic += energy.elastic;
    sum.weight += energy.weight;
    sum.dissipation += energy.dissipation;
  }
  return sum;
}

TermsBesidesBodies terms_besides_bodies(const Model& model) {
  TermsBesidesBodies besides;
  // build_model() begins with the terms of the bodies, see make_body_terms().
  auto next = model.mechanism.system->terms().begin();
  for (const BodyModel& body : model.bodies) {
    assert(dynamic_cast<const FloatingFrameBody*>(next->get()));
    ++next;
    if (body.has_stiffening) besides.stiffening.push_back((next++)->get());
  }
  for (; next != model.mechanism.system->terms().end(); ++next) {
    besides.acting.push_back(next->get());
  }
  return besides;
}

}  // namespace pleuel
