#include "core/linear/elastic_stability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <vector>

#include "core/base/dense_solvers.hpp"
#include "core/base/disjoint_sets.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/base/rotation_vector.hpp"
#include "core/linear/axial_strains.hpp"
#include "core/linear/free_deformations.hpp"
#include "core/linear/linearization.hpp"

namespace pleuel {

namespace {

/// Whether small motions grow:  det(s² M + s C + K) = 0 with an s of positive real part. Round-off is
/// relative to the fastest vibration: what damping holds back may be faster by far.
bool grows(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& rates,
           const Eigen::MatrixXd& stiffness) {
  constexpr double round_off = 1e-7;
  const Eigen::Index size = mass.cols();
  const DenseLu factors(mass);
  const Eigen::MatrixXd squares = factors.solve(stiffness);
  const double unit = std::sqrt(squares.cwiseAbs().maxCoeff());  // of rates, as all entries are
  if (!(unit > 0.0)) return false;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(2 * size, 2 * size);
  companion.topRightCorner(size, size).diagonal().setConstant(unit);
  companion.bottomLeftCorner(size, size) = -squares / unit;
  companion.bottomRightCorner(size, size) = -factors.solve(rates);
  const Eigen::VectorXcd roots = eigenvalues_of(companion);
  const double vibration = roots.imag().cwiseAbs().maxCoeff();
  const double scale = vibration > 0.0 ? vibration : roots.cwiseAbs().maxCoeff();
  return roots.real().maxCoeff() > round_off * scale;
}

Eigen::MatrixXd skew_part(const Eigen::MatrixXd& matrix) {
  return 0.5 * (matrix - matrix.transpose());
}

/// Of the given deformations, with the gyroscopic part of the forces of velocity. Forces that damp
/// are left out: they only delay.
bool grows(const Mechanism& mechanism, const State& state, const Eigen::MatrixXd& deformations,
           const Eigen::MatrixXd& stiffness) {
  const int n = mechanism.system->coordinates();
  const auto reduced = [&](const Weights& weights) -> Eigen::MatrixXd {
    return deformations.transpose() * scaled_tangent(mechanism, state, weights).topRows(n) *
           deformations;
  };
  return grows(symmetric_part(reduced({.a = 1.0})), skew_part(reduced({.v = 1.0})), stiffness);
}

int count_negative(const Eigen::VectorXcd& eigenvalues) {
  const double limit = eigenvalue_round_off * eigenvalues.cwiseAbs().maxCoeff();
  return static_cast<int>(std::ranges::count_if(eigenvalues, [limit](const auto& value) {
    return value.real() < -limit && std::abs(value.imag()) <= limit;
  }));
}

bool is_at_rest(const Mechanism& mechanism, const State& state) {
  constexpr double nothing = 1e-6;  // [1/s], [1/s²]
  const auto size = [&](const Eigen::VectorXd& rates) {
    return rates.cwiseQuotient(mechanism.scale).lpNorm<Eigen::Infinity>();
  };
  return size(state.v) <= nothing && size(state.a) <= nothing;
}

/// Whether a mechanism turns at a constant speed in elastic equilibrium.
bool is_steady(const Mechanism& mechanism, const State& state, const BodyTurn& turn) {
  constexpr double round_off = 1e-6;
  const double limit = round_off * turn.omega.squaredNorm();
  return turn.alpha.norm() <= limit && std::ranges::all_of(mechanism.elastic, [&](int i) {
           return std::abs(state.a(i)) <= limit * mechanism.scale(i);
         });
}

/// Of a mechanism that turns: deformations that constraints allow, normal to its motions as rigid bodies;
/// of a steady turn, which is an equilibrium, to those that no spring holds.
/// @param own    Φ_q in the coordinates of the answer
/// @param T      changes of the coordinates relative to the scale from those of the answer
/// @param fixed  coordinates that are not looked at
Eigen::MatrixXd turning_shapes(const Mechanism& mechanism, const State& state, Eigen::MatrixXd own,
                               const Eigen::MatrixXd& T, bool is_steady,
                               const std::vector<int>& fixed) {
  normalize_rows(mechanism, own);
  const Eigen::MatrixXd phi = with_fixed(own, fixed);
  const Eigen::MatrixXd motions = rigid_motions(mechanism, phi);
  if (!is_steady || mechanism.springs.empty() || motions.cols() == 0) {
    return deformations_beside(phi, motions);
  }
  const Eigen::MatrixXd resistance = T.transpose() * resistance_of_springs(mechanism, state) * T;
  return deformations_beside(phi, parted_by_springs(resistance, motions).second);
}

/// The matrices of small motions of the deformations of a mechanism that turns, in axes that turn
/// with its bodies, where a steady motion has constant coefficients.
struct TurningDeformations {
  Eigen::MatrixXd shapes, mass, rates, stiffness;  ///< rates: gyroscopic forces and damping
};

/// T of some axes, for coordinates relative to the scale.
Eigen::MatrixXd scaled_axes(const Mechanism& mechanism, const Turning& axes) {
  return mechanism.scale.cwiseInverse().asDiagonal() * Eigen::MatrixXd(axes.T) *
         mechanism.scale.asDiagonal();
}

/// @param shapes  the deformations, if they are known
/// @param fixed   else: coordinates that are not looked at
TurningDeformations turning_deformations(const Mechanism& mechanism, const State& state,
                                         const Eigen::MatrixXd* shapes,
                                         const std::vector<int>& fixed = {}) {
  const Turning axes =
      is_rotor(mechanism, state) ? rotor_turning(mechanism, state) : turning_of(mechanism, state);
  const Linearization all = linearize(mechanism, state, axes, true);
  const auto scale = mechanism.scale.asDiagonal();
  TurningDeformations result;
  result.shapes =
      shapes != nullptr
          ? *shapes
          : turning_shapes(mechanism, state, all.phi * scale, scaled_axes(mechanism, axes),
                           is_steady(mechanism, state, fastest_turn(mechanism, state)), fixed);
  const Eigen::MatrixXd z = scale * result.shapes;
  result.mass = symmetric_part(z.transpose() * all.M * z);
  result.rates = z.transpose() * all.G * z;
  result.stiffness = z.transpose() * all.K * z;
  return result;
}

/// Whether all that turns does so alike and at a constant speed, but for small vibrations.
bool turns_alike(const Mechanism& mechanism, const State& state, const BodyTurn& turn) {
  constexpr double small = 0.01;
  const Eigen::Vector3d omega = turn.axes * turn.omega;
  const double limit = small * omega.norm();
  const std::vector<TurningBody> bodies = turning_bodies(mechanism, state);
  return turn.alpha.norm() <= limit * omega.norm() &&
         std::ranges::all_of(bodies, [&](const TurningBody& body) {
           const Eigen::Vector3d own = body.turn.axes * body.turn.omega;
           return own.norm() <= limit || (own - omega).norm() <= limit;
         });
}

}  // namespace

State advanced(const Mechanism& mechanism, const State& state, double time) {
  const BodyTurn rotor = fastest_turn(mechanism, state);
  const Eigen::Vector3d omega = rotor.axes * rotor.omega;
  State next = state;
  next.q += time * state.v;
  const auto turn = [&](int first, int size) {
    for (Eigen::VectorXd* rates : {&next.v, &next.a}) {
      Eigen::Vector3d rate = Eigen::Vector3d::Zero();
      rate.head(size) = rates->segment(first, size);
      rates->segment(first, size) += time * omega.cross(rate).head(size);
    }
  };
  for (const TurningBody& body : turning_bodies(mechanism, state)) {
    turn(body.first, body.rotation - body.first);
  }
  for (const int rotation : mechanism.rotations) {
    const Eigen::Vector3d step = time * state.v.segment<3>(rotation);
    next.q.segment<3>(rotation) = compose(state.q.segment<3>(rotation), step);
  }
  for (const int point : mechanism.points) turn(point, translations_of_points(mechanism));
  return next;
}

namespace {

/// Whether the stiffness of a rotor changes as it turns, as in bearings that are softer one way: by
/// more than what is negative in it, so that one instant does not tell whether it grows. What couples
/// the lowest mode with another one counts by how far it lowers the first,  κ₀ⱼ²/(κⱼ − κ₀), or by
/// itself where they are close.
/// @param low  modes with φᵀ M φ = 1, the lowest first, and their φᵀ K φ
bool changes_with_angle(const Mechanism& mechanism, const State& state,
                        const Eigen::MatrixXd& shapes, const SymmetricModes& low) {
  constexpr double angle = 1e-4, share = 0.25;
  const double lowest = low.values(0), speed = fastest_turn(mechanism, state).omega.norm();
  if (lowest < -(1.0 + share) * speed * speed) return false;  // it would buckle standing still, too
  const auto row = [&](double time) -> Eigen::RowVectorXd {
    const State moved = advanced(mechanism, state, time);
    return low.vectors.col(0).transpose() *
           turning_deformations(mechanism, moved, &shapes).stiffness * low.vectors;
  };
  const Eigen::RowVectorXd change = (row(angle / speed) - row(-angle / speed)) / (2.0 * angle);
  double effect = std::abs(change(0));
  for (Eigen::Index i = 1; i < change.size(); ++i) {
    const double coupling = std::abs(change(i)), gap = low.values(i) - lowest;
    effect += coupling < gap ? coupling * coupling / gap : coupling;
  }
  return effect > share * std::abs(lowest);
}

/// Of a mechanism that turns. Deformations without stiffness may be held by gyroscopic
/// forces, which is asked of the lowest modes; damping by what turns takes that away (Kelvin, Tait &
/// Chetaev), and what stands still may give it back.
/// @param shapes  the deformations, if they are known
/// @param fixed   else: coordinates that are not looked at
ElasticStability turning_stability(const Mechanism& mechanism, const State& state,
                                   const Eigen::MatrixXd* shapes,
                                   const std::vector<int>& fixed = {}) {
  constexpr Eigen::Index more_modes = 20;
  const TurningDeformations all = turning_deformations(mechanism, state, shapes, fixed);
  if (all.shapes.cols() == 0) return {};
  const Eigen::MatrixXd symmetric = symmetric_part(all.stiffness);
  if (Cholesky(symmetric).is_positive_definite()) return {};
  ElasticStability result;
  // Not from those below: light bodies vibrate so fast that their round-off hides slow growth.
  result.negative = count_negative(symmetric_eigenvalues(symmetric).cast<std::complex<double>>());
  if (result.negative == 0) return result;
  const Eigen::MatrixXd mass = regular_mass(all.mass);
  const SymmetricModes modes = symmetric_modes(symmetric, mass);
  const Eigen::Index size = modes.vectors.cols();
  const Eigen::Index count = std::min<Eigen::Index>(size, 2 * result.negative + more_modes);
  const SymmetricModes low{modes.values.head(count), modes.vectors.leftCols(count)};
  const auto reduced = [&](const Eigen::MatrixXd& matrix) -> Eigen::MatrixXd {
    return low.vectors.transpose() * matrix * low.vectors;
  };
  const Eigen::MatrixXd m = reduced(mass), c = reduced(all.rates), k = reduced(all.stiffness);
  result.is_stable = !grows(m, c, k) || (is_rotor(mechanism, state) &&
                                         changes_with_angle(mechanism, state, all.shapes, low));
  if (result.is_stable) return result;
  result.where = owner_of(mechanism, all.shapes * modes.vectors.col(0));
  if (!grows(m, skew_part(c), symmetric_part(k))) {
    result.how = "whirls, as its own damping turns with it";
  }
  return result;
}

/// In the axes in which the coordinates are counted.
/// @param z  the deformations that are looked at
ElasticStability standing_stability(const Mechanism& mechanism, const State& state,
                                    const Eigen::MatrixXd& z) {
  if (z.cols() == 0) return {};
  const Eigen::MatrixXd stiffness = deformation_stiffness(mechanism, state, z);
  const Eigen::MatrixXd symmetric = symmetric_part(stiffness);
  if (Cholesky(symmetric).is_positive_definite()) return {};
  const SymmetricModes modes = symmetric_modes(symmetric);
  ElasticStability result;
  const bool is_conservative = is_symmetric(stiffness, 1e-7);
  result.negative = is_conservative ? count_negative(modes.values.cast<std::complex<double>>())
                                    : count_negative(eigenvalues_of(stiffness));
  const double round_off = eigenvalue_round_off * modes.values.cwiseAbs().maxCoeff();
  const Eigen::Index lowest = (modes.values.array() < -round_off).count();
  const Eigen::MatrixXd shapes = modes.vectors.leftCols(lowest);
  const bool may_be_held = result.negative % 2 == 0 && (!is_conservative || !state.v.isZero(0.0));
  result.is_stable =
      result.negative == 0 || (may_be_held && !grows(mechanism, state, z * shapes,
                                                     shapes.transpose() * stiffness * shapes));
  if (!result.is_stable) result.where = owner_of(mechanism, z * modes.vectors.col(0));
  return result;
}

/// Coordinates of a mechanism, by whether what they belong to turns.
struct Parts {
  std::vector<int> standing, turning;
};

/// By parts of the mechanism which nothing connects with each other.
Parts parts_of(const Mechanism& mechanism, const State& state, const BodyTurn& turn) {
  constexpr double standing = 0.01;
  System& system = *mechanism.system;
  const System::Matrix matrix = system.make_matrix();
  DisjointSets parts(static_cast<std::size_t>(matrix.cols()));
  for (int col = 0; col < matrix.outerSize(); ++col) {
    for (System::Matrix::InnerIterator entry(matrix, col); entry; ++entry) {
      parts.join(static_cast<int>(entry.row()), col);
    }
  }
  std::set<int> turning;
  for (const TurningBody& body : turning_bodies(mechanism, state)) {
    const bool turns = body.turn.omega.norm() > standing * turn.omega.norm();
    if (turns) turning.insert(parts.find(body.rotation));
  }
  Parts result;
  for (int i = 0; i < system.coordinates(); ++i) {
    (turning.contains(parts.find(i)) ? result.turning : result.standing).push_back(i);
  }
  return result;
}

/// Deformations counted in axes that turn with each body.
Eigen::MatrixXd in_turning_axes(const Mechanism& mechanism, const State& state,
                                const Eigen::MatrixXd& deformations) {
  return DenseLu(scaled_axes(mechanism, turning_of(mechanism, state))).solve(deformations);
}

/// The elastic coordinates of bodies that stand still, and of those that turn, beside those that
/// are not looked at.
Parts deforming_parts(const Mechanism& mechanism, const State& state, const BodyTurn& turn,
                      const std::vector<int>& fixed) {
  constexpr double standing = 0.01;
  const std::set<int> elastic(mechanism.elastic.begin(), mechanism.elastic.end()),
      left(fixed.begin(), fixed.end());
  Parts result;
  for (const TurningBody& body : turning_bodies(mechanism, state)) {
    const bool turns = body.turn.omega.norm() > standing * turn.omega.norm();
    for (int i = body.elastic; elastic.contains(i); ++i) {
      if (!left.contains(i)) (turns ? result.turning : result.standing).push_back(i);
    }
  }
  return result;
}

std::vector<int> joined(std::vector<int> some, const std::vector<int>& others) {
  some.insert(some.end(), others.begin(), others.end());
  return some;
}

/// Of the parts in which something turns. Where what turns and what it turns on both deform, as a
/// fan on a mast, no axes make the coefficients constant: each is judged with the other one rigid.
ElasticStability stability_of_turning(const Mechanism& mechanism, const State& state,
                                      const BodyTurn& turn, const std::vector<int>& fixed) {
  const Parts deforming = deforming_parts(mechanism, state, turn, fixed);
  if (!mechanism.elastic.empty() && deforming.turning.empty()) {
    return standing_stability(mechanism, state, free_deformations(mechanism, state, fixed));
  }
  if (is_steady(mechanism, state, turn) || turns_alike(mechanism, state, turn)) {
    if (deforming.standing.empty()) return turning_stability(mechanism, state, nullptr, fixed);
    const ElasticStability standing = standing_stability(
        mechanism, state, free_deformations(mechanism, state, joined(fixed, deforming.turning)));
    if (!standing.is_stable) return standing;
    return turning_stability(mechanism, state, nullptr, joined(fixed, deforming.standing));
  }
  const Eigen::MatrixXd deformations = free_deformations(mechanism, state, fixed);
  const ElasticStability standing = standing_stability(mechanism, state, deformations);
  if (standing.is_stable) return standing;
  const Eigen::MatrixXd shapes = in_turning_axes(mechanism, state, deformations);
  return turning_stability(mechanism, state, &shapes);
}

}  // namespace

bool is_rotor(const Mechanism& mechanism, const State& state) {
  const BodyTurn turn = fastest_turn(mechanism, state);
  return !turn.omega.isZero(0.0) && turns_alike(mechanism, state, turn);
}

ElasticStability elastic_stability(const Mechanism& mechanism, const State& state) {
  const BodyTurn turn = fastest_turn(mechanism, state);
  if (turn.omega.isZero(0.0) || is_at_rest(mechanism, state)) {
    return standing_stability(mechanism, state, free_deformations(mechanism, state));
  }
  const Parts parts = parts_of(mechanism, state, turn);
  if (!parts.standing.empty()) {
    const ElasticStability standing =
        standing_stability(mechanism, state, free_deformations(mechanism, state, parts.turning));
    if (!standing.is_stable) return standing;
  }
  return stability_of_turning(mechanism, state, turn, parts.standing);
}

bool may_grow(const Mechanism& mechanism, const State& state, double harmless) {
  const Eigen::MatrixXd z = free_deformations(mechanism, state);
  if (z.cols() == 0) return false;
  const Eigen::MatrixXd least =
      (1.0 - harmless) * (z.transpose() * elastic_stiffness(mechanism, state) * z);
  const auto is_firm = [&](const Eigen::MatrixXd& stiffness) {
    return Cholesky(symmetric_part(stiffness) - least).is_positive_definite();
  };
  if (!is_firm(deformation_stiffness(mechanism, state, z))) return true;
  if (fastest_turn(mechanism, state).omega.isZero(0.0)) return false;
  const Eigen::MatrixXd shapes = in_turning_axes(mechanism, state, z);
  return !is_firm(turning_deformations(mechanism, state, &shapes).stiffness);
}

Eigen::MatrixXd elastic_stiffness(const Mechanism& mechanism, const State& state) {
  const State unloaded = without_forces(mechanism, state);
  const int n = mechanism.system->coordinates();
  return symmetric_part(scaled_tangent(mechanism, unloaded, {.q = 1.0}).topRows(n)) -
         symmetric_part(stiffness_of_loads(mechanism, unloaded));
}

State without_forces(const Mechanism& mechanism, const State& loaded) {
  State state = loaded;
  state.q(mechanism.elastic).setZero();
  state.v.setZero();
  state.a = mechanism.free_fall;
  state.lambda.setZero();
  return state;
}

namespace {

/// The axes in which the deformations of a mechanism are counted: those that turn with it, if all
/// that deforms turns alike; else none, as they are those of the file.
std::optional<Turning> axes_of_motion(const Mechanism& mechanism, const State& state) {
  const BodyTurn turn = fastest_turn(mechanism, state);
  if (turn.omega.isZero(0.0) || !turns_alike(mechanism, state, turn)) return std::nullopt;
  if (!deforming_parts(mechanism, state, turn, {}).standing.empty()) return std::nullopt;
  return rotor_turning(mechanism, state);
}

/// What deflection couples of bending with stretching.
Eigen::MatrixXd coupling_of_strains(const MechanismState& at, const Eigen::MatrixXd& z) {
  const Eigen::MatrixXd scaled = at.mechanism.scale.asDiagonal() * z;
  return scaled.transpose() * (AxialStrains(*at.mechanism.system).coupling(at.state.q) * scaled);
}

}  // namespace

double buckling_load_factor(const MechanismState& unloaded, const MechanismState& loaded,
                            double share) {
  constexpr double none = std::numeric_limits<double>::infinity();
  const Eigen::MatrixXd z = free_deformations(unloaded.mechanism, unloaded.state);
  if (z.cols() == 0) return none;
  const Eigen::MatrixXd phi = constraint_rows(unloaded.mechanism, unloaded.state);
  const bool are_held =
      z.cols() > deformations_beside(phi, rigid_motions(unloaded.mechanism, phi)).cols();
  if (are_held) return std::nan("");  // dead loads turn with them, which is not of first order
  const State &begin = unloaded.state, &end = loaded.state;
  const Eigen::MatrixXd elastic = z.transpose() * elastic_stiffness(unloaded.mechanism, begin) * z;
  if (!Cholesky(elastic).is_positive_definite()) return none;
  const std::optional<Turning> axes = axes_of_motion(loaded.mechanism, end);
  // The symmetric part, with the inertia forces of axes that turn.
  const auto stiffness = [&](const Eigen::VectorXd& q, const Eigen::VectorXd& a,
                             const Eigen::VectorXd& lambda) -> Eigen::MatrixXd {
    State at = end;
    at.q = q;
    at.a = a;
    at.lambda = lambda;
    if (!axes) return symmetric_part(deformation_stiffness(loaded.mechanism, at, z));
    const Eigen::MatrixXd y = loaded.mechanism.scale.asDiagonal() *
                              DenseLu(scaled_axes(loaded.mechanism, *axes)).solve(z);
    return symmetric_part(y.transpose() * linearize(loaded.mechanism, at, *axes, true).K * y);
  };
  // Accelerations and multipliers bear all loads at the begin, and change to those of equilibrium;
  // deformation grows with the share.
  const Eigen::VectorXd a = begin.a + (end.a - begin.a) / share,
                        lambda = begin.lambda + (end.lambda - begin.lambda) / share;
  const Eigen::MatrixXd of_strains = stiffness(end.q, end.a, end.lambda) -
                                     stiffness(begin.q, end.a, end.lambda) -
                                     coupling_of_strains(loaded, z);
  // −ΔK φ = μ K₀ φ, s = 1/μ
  const Eigen::MatrixXd change = elastic - stiffness(begin.q, a, lambda) - of_strains / share;
  const double largest = symmetric_eigenvalues(change, elastic).maxCoeff();
  return largest > 0.0 ? 1.0 / largest : none;
}

}  // namespace pleuel
