#include "core/response/section_force_signal.hpp"

#include "core/response/section_stations.hpp"

namespace pleuel {

namespace {

class SectionForceQuantity {
 public:
  explicit SectionForceQuantity(SectionForcePart part) : part_(part) {}

  std::vector<int> points(const BodyModel&, const SectionProperties<double>&) const {
    constexpr int whole_section = -1;
    return {whole_section};
  }

  std::string name(int) const { return ""; }

  template <class Scalar>
  Scalar evaluate(const Beam<Scalar>&, const SectionProperties<Scalar>&,
                  const SectionForces<Scalar>& forces, int) const {
    switch (part_) {
      case SectionForcePart::axial:
        return forces.axial;
      case SectionForcePart::moment_y:
        return forces.moment_y;
      case SectionForcePart::moment_z:
        return forces.moment_z;
      case SectionForcePart::torque:
        break;
    }
    return forces.torque;
  }

 private:
  SectionForcePart part_;
};

}  // namespace

std::unique_ptr<Signal> make_section_force_signal(const BodyModel& body,
                                                  const Eigen::Vector3d& gravity,
                                                  SectionForcePart part,
                                                  const StationChoice& stations) {
  return make_section_signal(body, gravity, stations, SectionForceQuantity(part));
}

}  // namespace pleuel
