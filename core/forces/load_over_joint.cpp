#include "core/forces/load_over_joint.hpp"

#include "core/forces/force_term.hpp"

namespace pleuel {

namespace {

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
