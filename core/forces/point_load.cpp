#include "core/forces/point_load.hpp"

#include "core/forces/force_term.hpp"

namespace pleuel {

namespace {

/// F = f(t) d,   δW = F · δP
struct PointForceLaw {
  static constexpr std::size_t marker_count = 1;
  template <class Scalar>
  using Data = PointForceData<Scalar>;

  std::string name;
  LoadDirection load_direction;

  template <class Scalar>
  void add_forces(const Data<Scalar>& data, double time,
                  MarkerKinematics<Scalar, 1>& marker) const {
    const Vector3<Scalar> d = load_direction == LoadDirection::body
                                  ? marker.direction(0, data.direction)
                                  : data.direction;
    const Scalar value = data.value.at(time).value;
    marker.add_force(0, value * d, data.point);
  }

  bool couples(const LocalCoordinate& row, const LocalCoordinate& col) const {
    using enum CoordinatePart;
    if (load_direction == LoadDirection::body) {
      // In body axes the force turns with ψ only, and only the frame's rotation has a lever.
      return (row.part == translation && (col.part == rotation || col.part == turn)) ||
             (row.part == rotation && (col.part == displacement || col.part == turn)) ||
             (row.part == displacement && col.part == turn);
    }
    return (row.part == rotation && (col.part == rotation || col.part == displacement)) ||
           (row.part == displacement && col.part == rotation);
  }
};

/// δW = f d · δP, or f d · δπ.
struct LoadOverJointLaw {
  static constexpr std::size_t marker_count = 3;
  template <class Scalar>
  using Data = LoadOverJointData<Scalar>;

  std::string name;
  LoadKind kind;
  LoadDirection load_direction;
  RelativeKinematics along;

  template <class Scalar>
  void add_forces(const Data<Scalar>& data, double time,
                  MarkerKinematics<Scalar, 3>& markers) const {
    const Relative<Scalar> now = along.at<Scalar>(data, time, markers);
    const Scalar value = data.value.value_at(time, now.s, now.rate);
    const bool turns = load_direction == LoadDirection::body;
    if (kind == LoadKind::force) {
      const Vector3<Scalar> d = turns ? markers.direction(0, data.direction) : data.direction;
      markers.add_force(0, value * d, data.point);
      return;
    }
    const Vector3<Scalar> local =
        turns ? markers.local_direction(0, data.direction)
              : Vector3<Scalar>(markers.frame(0).A.transpose() * data.direction);
    markers.add_torque(0, value * local);
  }

  bool couples(const LocalCoordinate& row, const LocalCoordinate& col) const {
    if (row.marker != 0) return false;
    return col.marker == 0 ? col.part != CoordinatePart::translation : along.depends_on(col);
  }
};

}  // namespace

std::unique_ptr<Term> make_point_force_term(
    PointForceTopology topology, PointForceData<double> data,
    std::vector<DesignDerivative<PointForceData<double>>> derivatives) {
  return std::make_unique<ForceTerm<PointForceLaw>>(
      PointForceLaw{"point force " + topology.name, topology.direction},
      std::array{std::move(topology.marker)}, std::move(data), derivatives);
}

namespace {

/// M = m(t) Aᵀ d (fixed in space) or m(t) R s, axes of the frame;   δW = M · (δπ + T δψ)
struct PointTorqueLaw {
  static constexpr std::size_t marker_count = 1;
  template <class Scalar>
  using Data = PointTorqueData<Scalar>;

  std::string name;
  LoadDirection load_direction;

  template <class Scalar>
  void add_forces(const Data<Scalar>& data, double time,
                  MarkerKinematics<Scalar, 1>& marker) const {
    const Vector3<Scalar> local =
        load_direction == LoadDirection::body
            ? marker.local_direction(0, data.direction)
            : Vector3<Scalar>(marker.frame(0).A.transpose() * data.direction);
    const Scalar value = data.value.at(time).value;
    marker.add_torque(0, value * local);
  }

  bool couples(const LocalCoordinate& row, const LocalCoordinate& col) const {
    using enum CoordinatePart;
    if (row.part != rotation && row.part != turn) return false;
    // M depends on one of the two, T on ψ.
    if (load_direction == LoadDirection::body) return col.part == turn;
    return col.part == rotation || (col.part == turn && row.part == turn);
  }
};

}  // namespace

std::unique_ptr<Term> make_point_torque_term(
    PointTorqueTopology topology, PointTorqueData<double> data,
    std::vector<DesignDerivative<PointTorqueData<double>>> derivatives) {
  return std::make_unique<ForceTerm<PointTorqueLaw>>(
      PointTorqueLaw{"point torque " + topology.name, topology.direction},
      std::array{std::move(topology.marker)}, std::move(data), derivatives);
}

std::unique_ptr<Term> make_load_over_joint_term(
    LoadOverJointTopology topology, LoadOverJointData<double> data,
    std::vector<DesignDerivative<LoadOverJointData<double>>> derivatives) {
  const std::string name = "load " + topology.name;
  return std::make_unique<ForceTerm<LoadOverJointLaw>>(
      LoadOverJointLaw{name, topology.kind, topology.direction,
                       RelativeKinematics{name, topology.coordinate, topology.sense, 1, 2}},
      std::move(topology.markers), std::move(data), derivatives);
}

}  // namespace pleuel
