#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/beam/beam_invariants.hpp"
#include "core/frame/body_frame.hpp"
#include "core/integration/mechanism.hpp"
#include "core/model/motion_plane.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel {

/// A body of the model: what responses need to know of it.
struct BodyModel {
  std::string name;
  BodyFrame frame;         ///< its coordinates begin at frame.offset, the elastic ones follow
  double mass = 0.0;       ///< [kg]
  Eigen::VectorXd mass_x;  ///< derivatives with respect to all design variables

  // Beams only:
  std::optional<ElasticCoordinates> coordinates;
  Beam<double> beam;
  std::vector<std::pair<int, Beam<Dual>>> beam_x;  ///< for each variable the beam depends on
  std::vector<int> segment_of_element;
  bool has_stiffening = false;

  bool is_beam() const { return coordinates.has_value(); }
  int elastic_offset() const { return frame.offset + frame.size(); }
  /// Index in q of a nodal displacement, or −1.
  int coordinate(int node, int displacement) const {
    const int index = coordinates->index(node, displacement);
    return index < 0 ? -1 : elastic_offset() + index;
  }
};

struct JointModel {
  std::string name;
  int drive_row = -1;  ///< index in λ of the drive's equation; the drive's torque is −λ
};

/// One line of the table of effects.
struct EffectRecord {
  std::string name;
  bool is_built = false;
  std::string reason;
};

/// The mechanism that a scene calls for, at one design.
struct Model {
  Mechanism mechanism;
  std::vector<BodyModel> bodies;
  std::vector<JointModel> joints;
  std::vector<EffectRecord> effects;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();

  const BodyModel& body(const std::string& name) const;
  const JointModel& joint(const std::string& name) const;
};

/// Builds the equations of motion with the exact derivatives of all their constants. This is the
/// only place that knows the scene and all effects; finite elements are not used after it.
/// @param start   values of the variables that decide the topology (plane, nodes of joints)
/// @param design  values of the variables at which the model is built
Model build_model(const Scene& scene, const EffectSettings& effects, const Design<double>& start,
                  const Design<double>& design);

}  // namespace pleuel
