#include "core/response/buckling_signal.hpp"

#include <limits>
#include <numbers>

#include "core/response/section_signal.hpp"

namespace pleuel {

namespace {

class BucklingQuantity {
 public:
  explicit BucklingQuantity(const BodyModel& body) {
    if (body.frame.rotation != RotationCoordinates::angle) return;
    const Eigen::Vector3d normal = body.frame.reference.transpose() * body.frame.axis;
    bends_in_y_ = std::abs(normal.z()) > 0.5;
    bends_in_z_ = !bends_in_y_;
  }

  std::vector<int> points(const BodyModel&, const SectionProperties<double>&) const {
    constexpr int whole = -1;
    return {whole};
  }

  template <class Scalar>
  Scalar evaluate(const Beam<Scalar>& beam, const SectionProperties<Scalar>&,
                  const SectionForces<Scalar>& forces, int) const {
    constexpr double pi = std::numbers::pi;
    const Scalar length = beam.node_position(beam.node_count() - 1);
    const Scalar euler = pi * pi * least_stiffness(beam) / (length * length);
    return -forces.axial / euler;
  }

 private:
  template <class Scalar>
  Scalar least_stiffness(const Beam<Scalar>& beam) const {
    Scalar least(std::numeric_limits<double>::infinity());
    const auto take = [&](const Scalar& stiffness) {
      if (value_of(stiffness) < value_of(least)) least = stiffness;
    };
    for (const BeamElement<Scalar>& element : beam.elements) {
      if (bends_in_y_) take(Scalar(element.young * element.section.inertia_z));
      if (bends_in_z_) take(Scalar(element.young * element.section.inertia_y));
    }
    return least;
  }

  bool bends_in_y_ = true, bends_in_z_ = true;
};

}  // namespace

std::unique_ptr<Signal> make_buckling_signal(const BodyModel& body,
                                             const Eigen::Vector3d& gravity) {
  return std::make_unique<SectionSignal<BucklingQuantity>>(body, gravity, StationChoice{},
                                                           BucklingQuantity(body));
}

}  // namespace pleuel
