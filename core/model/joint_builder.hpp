#pragma once

#include "core/joints/joint.hpp"
#include "core/model/body_builder.hpp"

namespace pleuel {

/// A joint of the scene as equations between two markers.
/// @param multiplier  row of its first equation (counted from the number of coordinates)
struct JointParts {
  JointTopology topology;
  JointData<double> data;
  std::vector<DesignDerivative<JointData<double>>> derivatives;
  JointModel model;
};

JointParts make_joint(const Joint& joint, const std::vector<BodyModel>& bodies,
                      const BuildContext& context, int coordinates, int first_multiplier);

}  // namespace pleuel
