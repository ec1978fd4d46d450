#include "core/forces/point_load.hpp"

#include "core/forces/force_term.hpp"

namespace pleuel {

namespace {

/// On the first marker a force F = f d, δW = F · δP; or a torque M = f Aᵀ d (fixed in space) or f R s,
/// axes of the frame, δW = M · (δπ + T δψ).
struct LoadAction {
  LoadKind kind;
  LoadDirection load_direction;

  bool turns() const { return load_direction == LoadDirection::body; }

  template <class Scalar, class Data, class Markers>
  void add(const Data& data, const Scalar& value, Markers& markers) const {
    if (kind == LoadKind::force) {
      const Vector3<Scalar> d = turns() ? markers.direction(0, data.direction) : data.direction;
      markers.add_force(0, value * d, data.point);
      return;
    }
    const Vector3<Scalar> local =
        turns() ? markers.local_direction(0, data.direction)
                : Vector3<Scalar>(markers.frame(0).A.transpose() * data.direction);
    markers.add_torque(0, value * local);
  }
};

/// f(t)
struct PointLoadLaw {
  static constexpr std::size_t marker_count = 1;
  template <class Scalar>
  using Data = PointLoadData<Scalar>;

  std::string name;
  LoadAction action;

  template <class Scalar>
  void add_forces(const Data<Scalar>& data, double time,
                  MarkerKinematics<Scalar, 1>& marker) const {
    action.add(data, data.value.at(time).value, marker);
  }

  bool couples(const LocalCoordinate& row, const LocalCoordinate& col) const {
    using enum CoordinatePart;
    if (action.kind == LoadKind::torque) {
      if (row.part != rotation && row.part != turn) return false;
      // M depends on one of the two, T on ψ.
      if (action.turns()) return col.part == turn;
      return col.part == rotation || (col.part == turn && row.part == turn);
    }
    if (action.turns()) {
      // In body axes the force turns with ψ only, and only the frame's rotation has a lever.
      return (row.part == translation && (col.part == rotation || col.part == turn)) ||
             (row.part == rotation && (col.part == displacement || col.part == turn)) ||
             (row.part == displacement && col.part == turn);
    }
    return (row.part == rotation && (col.part == rotation || col.part == displacement)) ||
           (row.part == displacement && col.part == rotation);
  }
};

/// f(t, s, ṡ)
struct LoadOverJointLaw {
  static constexpr std::size_t marker_count = 3;
  template <class Scalar>
  using Data = LoadOverJointData<Scalar>;

  std::string name;
  LoadAction action;
  RelativeKinematics along;

  template <class Scalar>
  void add_forces(const Data<Scalar>& data, double time,
                  MarkerKinematics<Scalar, 3>& markers) const {
    const Relative<Scalar> now = along.at<Scalar>(data, time, markers);
    action.add(data, data.value.value_at(time, now.s, now.rate), markers);
  }

  bool couples(const LocalCoordinate& row, const LocalCoordinate& col) const {
    if (row.marker != 0) return false;
    return col.marker == 0 ? col.part != CoordinatePart::translation : along.depends_on(col);
  }
};

}  // namespace

std::unique_ptr<Term> make_point_load_term(
    PointLoadTopology topology, PointLoadData<double> data,
    std::vector<DesignDerivative<PointLoadData<double>>> derivatives) {
  const char* kind = topology.kind == LoadKind::force ? "point force " : "point torque ";
  return std::make_unique<ForceTerm<PointLoadLaw>>(
      PointLoadLaw{kind + topology.name, {topology.kind, topology.direction}},
      std::array{std::move(topology.marker)}, std::move(data), derivatives);
}

std::unique_ptr<Term> make_load_over_joint_term(
    LoadOverJointTopology topology, LoadOverJointData<double> data,
    std::vector<DesignDerivative<LoadOverJointData<double>>> derivatives) {
  const std::string name = "load " + topology.name;
  return std::make_unique<ForceTerm<LoadOverJointLaw>>(
      LoadOverJointLaw{name,
                       {topology.kind, topology.direction},
                       RelativeKinematics{name, topology.coordinate, topology.sense, 1, 2}},
      std::move(topology.markers), std::move(data), derivatives);
}

}  // namespace pleuel
