#include <algorithm>
#include <iterator>
#include <unordered_map>

#include <fmt/format.h>

#include "core/base/diameter.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/model/body_builder.hpp"
#include "core/model/divided_beams.hpp"
#include "core/model/elastic_builders.hpp"
#include "core/model/initial_deflections.hpp"
#include "core/model/joint_builder.hpp"
#include "core/model/load_builder.hpp"
#include "core/model/model.hpp"
#include "core/scene/body_groups.hpp"
#include "core/scene/scene_rules.hpp"
#include "core/start/redundancy.hpp"

namespace pleuel {

const BodyModel& Model::body(const std::string& name) const {
  if (const BodyModel* body = find_named(undivided, name)) return *body;
  return *parts(name).front();
}

std::vector<const BodyModel*> Model::parts(const std::string& name) const {
  const auto numbers = bodies_of_name.find(name);
  if (numbers == bodies_of_name.end()) {
    throw InputError(fmt::format("there is no body \"{}\"", name));
  }
  std::vector<const BodyModel*> parts;
  for (const std::size_t number : numbers->second) parts.push_back(&bodies[number]);
  return parts;
}

const JointModel& Model::joint(const std::string& name) const {
  for (const JointModel& joint : joints) {
    if (joint.name == name && !joint.is_division) return joint;
  }
  throw InputError(fmt::format("there is no joint \"{}\"", name));
}

namespace {

/// Elastic displacements are small against the mechanism, elastic rotations against one.
constexpr double elastic_scale = 1e-3;
/// What a moment compares with a force by in the norm of reactions: a joint carries it by a couple
/// of forces across its bearing, whose breadth is taken as this share of the size of what is tied to it.
constexpr double bearing_share = 0.1;

/// Where a body is: its origin, the end of a beam, the places of an imported body.
void add_points(const Body& body, const Design<double>& start,
                std::vector<Eigen::Vector3d>& points) {
  points.push_back(body_pose(body, start).origin);
  if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
    points.push_back(resolve_point(beam->to, start));
  } else if (const auto* imported = std::get_if<ImportedBody>(&body.shape)) {
    const Pose<double> pose = beam_pose(*imported, start);
    for (const BodyPlace& place : imported->file->constants.places) {
      points.push_back(pose.origin + pose.rotation * place.position);
    }
  }
}

/// Scales of lengths [m], one a group of bodies: what stands beside a mechanism changes nothing of it.
class Sizes {
 public:
  Sizes(const Scene& scene, const Design<double>& start) : groups_(scene) {
    std::unordered_map<int, std::vector<Eigen::Vector3d>> points;
    for (const Body& body : scene.bodies) add_points(body, start, points[groups_.of(body.name)]);
    for (const Joint& joint : scene.joints) {
      points[group_of(joint.bodies)].push_back(resolve_point(joint.at, start));
    }
    for (const auto& [group, of_group] : points) {
      const double size = diameter(of_group);
      sizes_[group] = size > 0.0 ? size : 1.0;
    }
  }

  /// The largest distance between bodies and joints of the group of a body.
  double of(const std::string& body) const { return sizes_.at(groups_.of(body)); }
  double of(const Joint& joint) const { return sizes_.at(group_of(joint.bodies)); }

 private:
  int group_of(const std::array<std::string, 2>& bodies) const {
    return groups_.of(bodies[bodies[0] == ground_name ? 1 : 0]);
  }

  BodyGroups groups_;
  std::unordered_map<int, double> sizes_;
};

class ModelBuilder {
 public:
  /// @param scene    of the file
  /// @param divided  the same with a body for each frame
  ModelBuilder(const Scene& scene, const DividedScene& divided, const EffectSettings& effects,
               const Design<double>& start, const Design<double>& design,
               const Differentiation& differentiation)
      : scene_(scene), divisions_(divided.divisions), context_{divided.scene,
                                                               effects,
                                                               start,
                                                               design,
                                                               std::nullopt,
                                                               resolve_point(scene.gravity, design),
                                                               differentiation} {}

  Model build() {
    model_.has_derivatives = context_.differentiation.has_value();
    decide_motion();
    for (const Body& body : scene_.bodies) {
      if (!std::holds_alternative<BeamBody>(body.shape)) continue;
      context_.beam_effects[body.name] = pleuel::decide_effects(body, context_.effects);
    }
    model_.bodies.reserve(context_.scene.bodies.size());  // bodies are large, and would be copied
    for (const Body& body : context_.scene.bodies) {
      model_.bodies.push_back(make_body_model(body, context_, coordinates_));
      const BodyModel& added = model_.bodies.back();
      model_.bodies_of_name[added.name].push_back(model_.bodies.size() - 1);
      coordinates_ += added.frame.size() + added.elastic_size();
    }
    add_undivided();
    model_.holds = JointHolds(scene_, context_.start);
    add_fittings();
    if (context_.plane) model_.effects.front().coordinates_saved = out_of_plane_coordinates();
    add_body_terms();
    add_joints();
    add_loads();
    set_guess();
    model_.gravity = context_.gravity;
    model_.mechanism.system = std::make_unique<System>(coordinates_, multipliers_,
                                                       context_.variables(), std::move(terms_));
    leave_out_redundant();
    name_equations();
    return std::move(model_);
  }

 private:
  void decide_motion() {
    const EffectChoice choice = context_.effects.spatial_motion;
    PlaneAnalysis analysis = decide_motion_plane(scene_, choice, context_.start);
    context_.plane = analysis.plane;
    EffectRecord record{"spatial_motion",           "", true, EffectRecord::Kind::exact,
                        std::move(analysis.reason), {}, 0};
    if (choice != EffectChoice::automatic) record.kind = EffectRecord::Kind::forced;
    record.is_built = !context_.plane.has_value();
    model_.effects.push_back(record);
  }

  /// Divided beams as they would be undivided.
  void add_undivided() {
    BuildContext whole{
        scene_,         context_.effects, context_.start,           context_.design,
        context_.plane, context_.gravity, context_.differentiation, context_.beam_effects};
    for (const Body& body : scene_.bodies) {
      if (model_.parts(body.name).size() < 2) continue;
      model_.undivided.push_back(make_body_model(body, whole, 0));
    }
  }

  void add_fittings() {
    for (const Body& body : scene_.bodies) {
      if (!std::holds_alternative<BeamBody>(body.shape)) continue;
      if (!model_.parts(body.name).front()->is_elastic) continue;
      if (auto fittings = EndFittings::of(body, scene_, context_)) {
        model_.fittings.emplace(body.name, std::move(*fittings));
      }
    }
  }

  /// What the same mechanism would have in space on top: of frames three of six (one of three for
  /// a point), of nodes with a rotation and in-plane displacements the same number again.
  int out_of_plane_coordinates() const {
    int count = 0;
    for (const BodyModel& body : model_.bodies) {
      count += body.frame.rotations() > 0 ? 3 : 1;
      if (body.is_beam() && !body.has_basis) count += body.elastic_size();
    }
    return count;
  }

  Term* add_term(std::unique_ptr<Term> term) {
    terms_.push_back(std::move(term));
    return terms_.back().get();
  }

  void add_body_terms() {
    bool has_damping = false;
    for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
      const BodyModel& body = model_.bodies[i];
      model_.terms.bodies.push_back(add_term(make_body_term(body, context_)));
      if (body.has_stiffening) {
        model_.terms.stiffening.emplace_back(i, add_term(make_stiffening(body)));
      }
      if (body.frame.rotation == RotationCoordinates::rotation_vector) {
        model_.mechanism.rotations.push_back(body.frame.offset + body.frame.translations());
      } else if (body.frame.rotation == RotationCoordinates::angle) {
        model_.mechanism.angles.push_back(body.frame.offset + body.frame.translations());
      } else {
        model_.mechanism.points.push_back(body.frame.offset);
      }
      has_damping = has_damping || !body.invariants.damping.isZero(0.0);
    }
    for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
      const Body& body = context_.scene.bodies[i];
      if (const auto* imported = std::get_if<ImportedBody>(&body.shape)) {
        for (EffectRecord& record :
             imported_records(*imported, context_.effects, model_.bodies[i])) {
          model_.effects.push_back(std::move(record));
        }
      }
      if (!model_.bodies[i].is_beam() || model_.bodies[i].stretch.begin > 0.0) continue;
      add_beam_records(model_.bodies[i].name);
    }
    record_exact("damping", has_damping, has_damping ? "given for a body" : "no body has any");
    const bool has_gravity = !context_.gravity.isZero();
    record_exact("gravity", has_gravity, has_gravity ? "given" : "none is given");
    const bool has_loads = !context_.scene.loads.empty();
    record_exact("loads", has_loads, has_loads ? "given" : "none are given");
  }

  /// One set of records a beam, whatever number of frames it has.
  void add_beam_records(const std::string& name) {
    const Body& body = *find_named(scene_.bodies, name);
    std::vector<EffectRecord> records;
    for (const BodyModel* part : model_.parts(name)) {
      std::vector<EffectRecord> of_part =
          beam_records(body, context_.effects, *part, context_.plane.has_value());
      for (std::size_t i = 0; i < records.size(); ++i) {
        of_part[i].coordinates_saved += records[i].coordinates_saved;
      }
      records = std::move(of_part);
    }
    std::move(records.begin(), records.end(), std::back_inserter(model_.effects));
  }

  void record_exact(const std::string& name, bool is_built, const std::string& reason) {
    model_.effects.push_back({name, "", is_built, EffectRecord::Kind::exact, reason, {}, 0});
  }

  void add_joints() {
    for (const Joint& joint : context_.scene.joints) {
      model_.joints.push_back(
          make_joint(joint, model_.bodies, context_, coordinates_, multipliers_));
      JointModel& added = model_.joints.back();
      added.is_division = int_size(model_.joints) <= divisions_;
      add_gauges(joint, model_.bodies, context_, added);
      multipliers_ += added.equations();
      if (added.equations() == 0) continue;
      model_.terms.joints.push_back(add_term(make_joint_term(added, coordinates_)));
    }
  }

  void add_loads() {
    for (const Load& load : context_.scene.loads) {
      BuiltLoad built = make_load(load, model_.bodies, context_, coordinates_);
      model_.terms.loads.push_back(add_term(std::move(built.term)));
      const bool is_spring = std::holds_alternative<SpringDamper>(load.element) ||
                             std::holds_alternative<JointForce>(load.element);
      (is_spring ? model_.mechanism.springs : model_.mechanism.loads)
          .push_back(model_.terms.loads.back());
      if (follows_motion(load)) model_.mechanism.has_laws_of_motion = true;
      model_.loads.push_back({load.name, std::move(built.gauge)});
    }
  }

  /// Whether a force is a law of the motion that is more than a stiffness and a damping.
  static bool follows_motion(const Load& load) {
    struct Visitor {
      bool operator()(const PointLoad& load) const { return load.over.has_value(); }
      bool operator()(const SpringDamper& spring) const { return spring.resistance.has_value(); }
      bool operator()(const JointForce& force) const {
        return force.resistance || (force.motor && depends_on_state(*force.motor));
      }
    };
    return std::visit(Visitor(), load.element);
  }

  void name_equations() {
    std::vector<std::string>& names = model_.mechanism.equation_names;
    for (const BodyModel& body : model_.bodies) {
      const int count = body.frame.size() + body.elastic_size();
      names.insert(names.end(), static_cast<std::size_t>(count),
                   fmt::format("the body \"{}\"", body.name));
    }
    for (const JointModel& joint : model_.joints) {
      names.insert(names.end(), static_cast<std::size_t>(joint.equations()),
                   joint.is_division ? fmt::format("the beam {}", joint.name)
                                     : fmt::format("the joint \"{}\"", joint.name));
    }
  }

  void leave_out_redundant() {
    const std::vector<int> redundant = redundant_constraints(model_.mechanism, drive_rows(model_));
    if (redundant.empty()) return;
    model_.mechanism.system->deactivate(redundant);
    std::map<std::string, int> counts;
    for (int row : redundant) {
      const JointModel& joint = joint_of(row);
      ++counts[joint.is_division ? joint.name : fmt::format("\"{}\"", joint.name)];
    }
    std::string text;
    for (const auto& [name, count] : counts) {
      text += fmt::format("{}{} of {}", text.empty() ? "" : ", ", count, name);
    }
    record_exact(
        "redundant_constraints", false,
        fmt::format("{} follow from the others; reactions are not unique: those of least norm",
                    text));
  }

  const JointModel& joint_of(int multiplier) const {
    const auto holds = [multiplier](const JointModel& joint) {
      return joint.first_multiplier <= multiplier &&
             multiplier < joint.first_multiplier + joint.equations();
    };
    return *std::ranges::find_if(model_.joints, holds);
  }

  void set_guess() {
    Mechanism& mechanism = model_.mechanism;
    const Sizes sizes(context_.scene, context_.start);
    mechanism.guess = State(coordinates_, multipliers_);
    mechanism.guess_q_x.setZero(coordinates_, context_.variables());
    mechanism.guess_v_x.setZero(coordinates_, context_.variables());
    mechanism.scale.setOnes(coordinates_);
    mechanism.free_fall.setZero(coordinates_);
    mechanism.assembly_weight.setConstant(coordinates_, 1e4);
    for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
      const Body& body = context_.scene.bodies[i];
      const BodyModel& built = model_.bodies[i];
      const BodyFrame& frame = built.frame;
      const double size = sizes.of(body.name);
      mechanism.guess.q.segment(frame.offset, frame.size()) =
          frame_coordinates(frame, body_pose(body, context_.design));
      for (int variable : context_.differentiated(variables_of(body, context_.scene))) {
        mechanism.guess_q_x.col(variable).segment(frame.offset, frame.size()) =
            derivative_matrix(frame_coordinates(frame, body_pose(body, context_.seeded(variable))));
      }
      set_velocity(body, frame);
      mechanism.scale.segment(frame.offset, frame.translations()).setConstant(size);
      mechanism.free_fall.segment(frame.offset, frame.translations()) =
          frame.basis.transpose() * context_.gravity;
      mechanism.assembly_weight.segment(frame.offset, frame.size()).setOnes();
      set_elastic_scale(built, size);
      for (int k = 0; k < built.elastic_size(); ++k) {
        mechanism.elastic.push_back(built.elastic_offset() + k);
      }
      const double deflection = elastic_scale * size;
      set_initial_deflections(i, model_.bodies, context_, 1.0 / (deflection * deflection),
                              mechanism);
    }
    mechanism.assembly_weight.array() /= mechanism.scale.array().square();
    set_reaction_weight(sizes);
  }

  void set_reaction_weight(const Sizes& sizes) {
    Eigen::VectorXd& weight = model_.mechanism.reaction_weight;
    weight.setOnes(multipliers_);
    for (std::size_t j = 0; j < model_.joints.size(); ++j) {
      const JointModel& joint = model_.joints[j];
      if (joint.is_division) {  // the beam itself: how joints share a load is asked without it
        weight.segment(joint.first_multiplier, joint.equations()).setZero();
        continue;
      }
      const double length = bearing_share * sizes.of(context_.scene.joints[j]);
      for (int i = 0; i < joint.equations(); ++i) {
        if (!traits_of(joint.topology.equations[i].kind).is_moment) continue;
        weight(joint.first_multiplier + i) = 1.0 / (length * length);
      }
    }
  }

  void set_velocity(const Body& body, const BodyFrame& frame) {
    Mechanism& mechanism = model_.mechanism;
    mechanism.guess.v.segment(frame.offset, frame.size()) =
        frame_rates<double>(frame, body, context_.design);
    for (int variable : context_.differentiated(variables_of(body, context_.scene))) {
      mechanism.guess_v_x.col(variable).segment(frame.offset, frame.size()) =
          derivative_matrix(frame_rates<Dual>(frame, body, context_.seeded(variable)));
    }
  }

  /// The largest displacement of a place by a unit of a coordinate counts, or the mean one of the
  /// body.
  void set_elastic_scale(const BodyModel& body, double size) {
    const Invariants<double>& invariants = body.invariants;
    Eigen::VectorXd largest(body.elastic_size());
    for (int k = 0; k < largest.size(); ++k) {
      const double square = invariants.mass_matrix(invariants.pattern.find(k, k));
      largest(k) = std::sqrt(square / invariants.mass) / size;
    }
    const SparseMatrix& shape = body.places.shape;
    for (int row = 0; row < shape.outerSize(); ++row) {
      const double unit = row % 6 < 3 ? size : 1.0;
      for (SparseMatrix::InnerIterator entry(shape, row); entry; ++entry) {
        largest(entry.col()) = std::max(largest(entry.col()), std::abs(entry.value()) / unit);
      }
    }
    model_.mechanism.scale.segment(body.elastic_offset(), body.elastic_size()) =
        elastic_scale * largest.cwiseInverse();
  }

  const Scene& scene_;
  int divisions_;
  BuildContext context_;
  Model model_;
  std::vector<std::unique_ptr<Term>> terms_;
  int coordinates_ = 0, multipliers_ = 0;
};

}  // namespace

Model build_model(const Scene& scene, const EffectSettings& effects, const Design<double>& start,
                  const Design<double>& design, const Differentiation& differentiation) {
  if (const auto broken = find_impossible(scene, start, design)) {
    throw SimulationError("the mechanism is impossible: " + *broken);
  }
  const DividedScene divided = divide_beams(scene, effects, start);
  return ModelBuilder(scene, divided, effects, start, design, differentiation).build();
}

}  // namespace pleuel
