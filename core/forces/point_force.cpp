#include "core/forces/point_force.hpp"

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

}  // namespace

std::unique_ptr<Term> make_point_force_term(
    PointForceTopology topology, PointForceData<double> data,
    std::vector<DesignDerivative<PointForceData<double>>> derivatives) {
  return std::make_unique<ForceTerm<PointForceLaw>>(
      PointForceLaw{"point force " + topology.name, topology.direction},
      std::array{std::move(topology.marker)}, std::move(data), derivatives);
}

}  // namespace pleuel
