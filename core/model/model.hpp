#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/base/int_size.hpp"
#include "core/beam/beam_invariants.hpp"
#include "core/frame/body_frame.hpp"
#include "core/joints/joint.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/model/elastic_body.hpp"
#include "core/model/end_fittings.hpp"
#include "core/model/joint_holds.hpp"
#include "core/model/motion_plane.hpp"
#include "core/scene/beam_mesh.hpp"
#include "core/scene/problem_file.hpp"
#include "core/system/projected_term.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// The stretch of a beam that a body of the model is: all of it, or a part of a divided one.
struct BeamStretch {
  double begin = 0.0, end = 1.0;  ///< shares of the length of the beam
  int first_element = 0;          ///< of the beam's elements

  /// A share of the length of the whole beam as one of this stretch, within 0 … 1.
  double within(double share) const {
    return std::clamp((share - begin) / (end - begin), 0.0, 1.0);
  }
  double of_whole(double share) const { return begin + share * (end - begin); }
};

enum class BodyKind { rigid, beam, imported };

/// A body of the model: what joints, loads and responses need to know of it. A beam that is divided
/// into frames is several of them, one a frame, all with the name of the beam.
struct BodyModel : ElasticBody {
  std::string name;
  BodyKind kind = BodyKind::rigid;
  BodyFrame frame;         ///< its coordinates begin at frame.offset, the elastic ones follow
  double mass = 0.0;       ///< [kg]
  Eigen::VectorXd mass_x;  ///< derivatives with respect to all design variables
  bool has_stiffening = false;
  std::shared_ptr<const StretchedMembers> stretched;  ///< with members to stretch; else null
  bool is_elastic = false;

  // What a beam is made of: for section forces, and for judgements on beams.
  BeamStretch stretch;
  ReferenceCondition condition = ReferenceCondition::tangent;
  Beam<double> beam;
  bool bends_alike = false;  ///< in all planes, at all designs: its sections are circles and tubes
  std::vector<std::pair<int, Beam<Dual>>> beam_x;  ///< in the order of the other derivatives
  BeamMesh mesh;
  /// Which nodal displacements it has. They are its elastic coordinates, unless it has a basis of
  /// modes or of the mean axis.
  ElasticCoordinates coordinates = ElasticCoordinates(0, {});
  bool has_basis = false;

  bool is_beam() const { return kind == BodyKind::beam; }
  bool is_imported() const { return kind == BodyKind::imported; }
  int elastic_offset() const { return frame.offset + frame.size(); }
  /// Index in q of a nodal displacement of a beam without basis, or −1.
  int coordinate(int node, int displacement) const {
    const int index = coordinates.index(node, displacement);
    return index < 0 ? -1 : elastic_offset() + index;
  }
};

class Gauge;  // core/system/term.hpp

/// What can be read of a joint or a load. Its coordinates are local where `map` is set.
struct GaugeModel {
  std::shared_ptr<const Gauge> gauge;
  std::optional<CoordinateMap> map;
};

/// A load of the model: what responses need to know of it.
struct LoadModel {
  std::string name;
  std::optional<GaugeModel> gauge;  ///< of springs, and of loads in joints
};

/// A joint of the model: what responses need to know of it. Its numbers are local where `map` is
/// set, and those of the system elsewhere.
struct JointModel {
  std::string name;
  int drive_row = -1;        ///< index in λ of the drive's equation; the drive's torque is −λ
  int first_multiplier = 0;  ///< index in λ of its first equation
  JointTopology topology;
  JointData<double> data;
  std::vector<DesignDerivative<JointData<double>>> derivatives;
  std::optional<CoordinateMap> map;
  bool is_division = false;  ///< welds two frames of one beam: no joint of the scene
  /// Of its relative coordinates, as far as it has them.
  std::optional<GaugeModel> angle, displacement;

  int equations() const { return int_size(topology.equations); }
};

/// One line of the table of effects.
struct EffectRecord {
  enum class Kind {
    exact,      ///< the answer is the same to round-off
    estimated,  ///< compared with the tolerance
    measured,   ///< by a simulation with everything, compared with the tolerance
    forced      ///< by the file
  };
  std::string name;
  std::string body;  ///< empty: of the whole mechanism
  bool is_built = false;
  Kind kind = Kind::exact;
  std::string reason;
  std::optional<double> estimate;  ///< relative change of responses without it
  int coordinates_saved = 0;
};

/// The terms of the system by what they stand for. They belong to the system.
struct ModelTerms {
  std::vector<Term*>
      bodies;  ///< inertia, elasticity, damping and weight of Model::bodies, in order
  std::vector<std::pair<std::size_t, Term*>> stiffening;  ///< which body, its geometric stiffening
  std::vector<Term*> joints;                              ///< with their drives
  std::vector<Term*> loads;                               ///< with springs and dampers
};

/// The mechanism that a scene calls for, at one design.
struct Model {
  Mechanism mechanism;
  ModelTerms terms;
  std::vector<BodyModel> bodies;
  std::unordered_map<std::string, std::vector<std::size_t>> bodies_of_name;  ///< see parts()
  /// Beams that are divided, as if they were not: for their constants. They have no coordinates in
  /// the system.
  std::vector<BodyModel> undivided;
  /// What joints hold of beams: for judgements on beams out of the plane of motion, too.
  JointHolds holds;
  std::unordered_map<std::string, EndFittings> fittings;  ///< of the beams that have some
  std::vector<JointModel> joints;
  std::vector<LoadModel> loads;
  std::vector<EffectRecord> effects;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();
  bool has_derivatives = true;  ///< by the design variables; else its system has none of them

  /// The body with its constants; of a divided beam as if it were not divided.
  const BodyModel& body(const std::string& name) const;
  /// The bodies of the model that a body of the scene is made of: one, or one a frame, in order.
  std::vector<const BodyModel*> parts(const std::string& name) const;
  const JointModel& joint(const std::string& name) const;
};

/// Builds the equations of motion with the derivatives of all their constants. This is the only
/// place that knows the scene and all effects; finite elements are not used after it.
/// @param start   values of the variables that decide the topology (plane, nodes of joints)
/// @param design  values of the variables at which the model is built
Model build_model(const Scene& scene, const EffectSettings& effects, const Design<double>& start,
                  const Design<double>& design,
                  const Differentiation& differentiation = InvariantDifferentiation());

/// Multipliers of the drives of a model.
inline std::vector<int> drive_rows(const Model& model) {
  std::vector<int> rows;
  for (const JointModel& joint : model.joints) {
    if (joint.drive_row >= 0) rows.push_back(joint.drive_row);
  }
  return rows;
}

}  // namespace pleuel
