#include "core/scene/acting_laws.hpp"

namespace pleuel {

std::string ActingLaw::pointer() const {
  switch (kind) {
    case Kind::drive:
      return "/scene/joints/" + name + "/drive";
    case Kind::load:
      return "/scene/loads/" + name + "/value";
    case Kind::motor:
      return "/scene/loads/" + name + "/motor";
    default:
      return "/scene/loads/" + name + "/motor/target";
  }
}

std::vector<ActingLaw> acting_laws(const Scene& scene) {
  using Kind = ActingLaw::Kind;
  std::vector<ActingLaw> laws;
  for (const Joint& joint : scene.joints) {
    if (!joint.drive) continue;
    laws.push_back({Kind::drive, joint.name, joint.drive->motion,
                    joint.drive->coordinate == DrivenCoordinate::displacement});
  }
  for (const Load& load : scene.loads) {
    if (const auto* point = std::get_if<PointLoad>(&load.element)) {
      laws.push_back({Kind::load, load.name, point->value, false});
    } else if (const auto* joint = std::get_if<JointForce>(&load.element)) {
      const bool slides = joint->coordinate == DrivenCoordinate::displacement;
      if (joint->motor) laws.push_back({Kind::motor, load.name, *joint->motor, slides});
      if (joint->control) laws.push_back({Kind::target, load.name, joint->control->target, slides});
    }
  }
  return laws;
}

}  // namespace pleuel
