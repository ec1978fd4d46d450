#pragma once

#include <optional>

#include "core/frame/marker_kinematics.hpp"
#include "core/joints/joint.hpp"

namespace pleuel {

/// Value, gradient and Hessian of the equations of a joint at one state, by hand: the step matrix
/// needs them in every Newton iteration, where dual numbers took a third of the time of a
/// simulation. Tests tie it to joint_residual.hpp. Made for each state, so that the joints of a
/// large mechanism share the memory. It serves all levels: with g = Φ_q, H_ij = ∂g_i/∂q_j and
/// g_t = ∂g/∂t,
///     dΦ/dt = gᵀv + Φ_t:         ∂/∂v = g,              ∂/∂q = Hᵀ v + g_t
///     d²Φ/dt²:       ∂/∂a = g,   ∂/∂v = (H + Hᵀ) v + 2 g_t
///
/// With points y = r + A s and directions y = A s attached to a marker, J = ∂y/∂q and
/// H(g) = ∂²(gᵀy)/∂q²,
///     Φ = a · b  ⇒  Φ_q = Jₐᵀ b + J_bᵀ a,   Φ_qq = Hₐ(b) + H_b(a) + Jₐᵀ J_b + J_bᵀ Jₐ
class JointLinearization {
 public:
  static constexpr int max_size = 24;  ///< local coordinates: twice frame (6) and marker (6)
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_size, 1>;
  using Hessian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_size, max_size>;

  /// @param topology, data  must outlive this
  /// @param q               local coordinates: first marker's, then second marker's
  /// @param size            number of them
  JointLinearization(const JointTopology& topology, const JointData<double>& data, double time,
                     const double* q, int size);

  /// Sets value(), rate(), gradient() and gradient_rate() to those of one equation, and adds weight
  /// times its H to hessian().
  void evaluate(const JointEquation& equation, double weight);

  double value() const { return value_; }
  /// Φ_t: zero unless a drive moves the equation.
  double rate() const { return rate_; }
  const Vector& gradient() const { return gradient_; }
  /// Σ weight · H since it was zero: rows belong to g, columns to its derivatives; not symmetric for
  /// rotations in space.
  const Hessian& hessian();
  void clear_hessian();
  /// g_t: zero unless a drive moves the equation.
  const Vector& gradient_rate() const { return gradient_rate_; }

 private:
  using Jacobian = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, max_size>;

  struct MarkerState {
    int start = 0;  ///< of its local coordinates
    int size = 0;
    int frame = 0;                                     ///< number of frame coordinates
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of planar motion, local axes

    Eigen::Vector3d r;
    Eigen::Matrix3d A;
    std::array<Eigen::Matrix3d, 3> A_p;
    Eigen::Vector3d u, psi;
    double angle = 0.0;
    bool has_turn = false;         ///< whether these are those of the state:
    ElasticRotation<double> turn;  ///< by ψ
    Eigen::Matrix3d turn_tangent;  ///< T of it
  };

  enum class AttachedKind { point, direction };

  /// An attached vector: value and J; `elastic` are the columns ∂s/∂(elastic coordinate), local
  /// axes.
  struct Attached {
    AttachedKind kind;
    std::size_t marker;
    Eigen::Vector3d s;
    Eigen::Vector3d y;
    Jacobian jacobian;  ///< columns of the marker's own coordinates
    Jacobian elastic;
  };

  void set_marker(std::size_t m, int start, const double* q);
  static void set_planar_rotation(const BodyFrame& frame, MarkerState& state);
  void set_turn(std::size_t m);
  /// The point of a marker; evaluated once a state.
  const Attached& point(std::size_t m);
  Attached make_point(std::size_t m) const;
  Attached direction(std::size_t m, const Eigen::Vector3d& local);
  void add_rotations(Attached& attached) const;
  Eigen::Vector3d driven_direction(const JointEquation& equation, double quarter_turns) const;
  void evaluate_drive(const JointEquation& equation);

  void add_gradient(const Attached& a, const Eigen::Vector3d& g) { add_to(gradient_, a, g); }
  void add_to(Vector& gradient, const Attached& a, const Eigen::Vector3d& g) const;
  // To the Hessian, times weight_.
  void add_curvature(const Attached& a, const Eigen::Vector3d& g);
  void add_product(const Attached& a, const Attached& b, double sign);
  // Without it.
  void add_weighted_curvature(const Attached& a, const Eigen::Vector3d& g);
  void add_elastic_curvature(const Attached& a, const Eigen::Vector3d& local);
  void evaluate_coincident(const Eigen::Vector3d& e);
  void evaluate_on_plane(const JointEquation& equation);
  void evaluate_distance();
  void evaluate_directions(const Attached& first, const Attached& second);
  void evaluate_planar_angle(const JointEquation& equation);

  const JointTopology& topology_;
  const JointData<double>& data_;
  TimeValue<double> drive_{0.0, 0.0, 0.0};
  std::array<MarkerState, 2> markers_;
  std::array<std::optional<Attached>, 2> points_;  ///< where they were asked for
  double value_ = 0.0, rate_ = 0.0, weight_ = 0.0;
  /// Σ weight · e of coincident points, whose H(e) is still to be added.
  Eigen::Vector3d pull_ = Eigen::Vector3d::Zero();
  Vector gradient_, gradient_rate_;
  Hessian hessian_;
};

}  // namespace pleuel
