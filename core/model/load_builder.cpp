#include "core/model/load_builder.hpp"

#include <algorithm>
#include <cassert>
#include <span>

#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/forces/force_term.hpp"
#include "core/forces/joint_force.hpp"
#include "core/forces/point_load.hpp"
#include "core/forces/spring_damper.hpp"
#include "core/frame/number_data.hpp"
#include "core/scene/joint_kind.hpp"
#include "core/scene/visit_numbers.hpp"
#include "core/system/projected_term.hpp"

namespace pleuel {

namespace {

const Joint& find_joint(const Scene& scene, const std::string& name) {
  const Joint* found = find_named(scene.joints, name);
  assert(found);
  return *found;
}

class LoadBuilder {
 public:
  LoadBuilder(const Load& load, const std::vector<BodyModel>& bodies, const BuildContext& context,
              int coordinates)
      : load_(load), bodies_(bodies), context_(context), coordinates_(coordinates) {}

  BuiltLoad operator()(const PointLoad& load) {
    places_.emplace_back(load.body, load.at, bodies_, context_, load.to);
    if (load.over) return over_joint(load);
    PointLoadTopology topology;
    topology.name = load_.name;
    topology.kind = load.kind;
    topology.direction = load.follows_body ? LoadDirection::body : LoadDirection::space;
    const auto parts = parts_of<PointLoadData>([&](const auto& design) {
      PointLoadData<ScalarOf<decltype(design)>> numbers;
      set_numbers(load, design, numbers);
      return numbers;
    });
    topology.marker = parts.markers[0];
    return {project(make_point_load_term(topology, parts.numbers, parts.derivatives), parts.map),
            std::nullopt};
  }

  BuiltLoad operator()(const SpringDamper& spring) {
    for (std::size_t i = 0; i < 2; ++i) attach(spring.bodies[i], spring.at[i]);
    const auto data = [&](const auto& design) {
      using Scalar = ScalarOf<decltype(design)>;
      SpringDamperData<Scalar> numbers;
      for (std::size_t i = 0; i < 2; ++i) numbers.points[i] = places_[i].local_point(design);
      numbers.stiffness = resolve(spring.stiffness, design);
      numbers.damping = resolve(spring.damping, design);
      numbers.free_length = spring.free_length
                                ? resolve(*spring.free_length, design)
                                : Scalar(Vector3<Scalar>(resolve_point(spring.at[1], design) -
                                                         resolve_point(spring.at[0], design))
                                             .norm());
      if (spring.resistance) numbers.resistance = resolve_time_law(*spring.resistance, design);
      return numbers;
    };
    const auto parts = parts_of<SpringDamperData>(data);
    const SpringDamperTopology topology{load_.name, {parts.markers[0], parts.markers[1]}};
    return with_gauge(make_spring_damper(topology, parts.numbers, parts.derivatives), parts.map);
  }

  BuiltLoad operator()(const JointForce& force) {
    const Joint& joint = find_joint(context_.scene, force.joint);
    for (const std::string& body : joint.bodies) attach(body, joint.at);
    visit_joint_ = &joint;
    JointForceTopology topology = joint_topology(joint, force.coordinate);
    const auto data = [&](const auto& design) {
      auto numbers = joint_numbers(joint, topology.coordinate, design, sides_from(0));
      numbers.stiffness = resolve(force.stiffness, design);
      numbers.damping = resolve(force.damping, design);
      numbers.rest = resolve(force.rest, design);
      if (force.motor) numbers.motor = resolve_time_law(*force.motor, design);
      if (force.resistance) numbers.resistance = resolve_time_law(*force.resistance, design);
      if (force.control) {
        numbers.target = resolve_time_law(force.control->target, design, LawOf::motion);
        numbers.proportional = resolve(force.control->proportional, design);
        numbers.derivative = resolve(force.control->derivative, design);
      }
      return numbers;
    };
    const auto parts = parts_of<JointForceData>(data);
    topology.markers = {parts.markers[0], parts.markers[1]};
    return with_gauge(make_joint_force(topology, parts.numbers, parts.derivatives), parts.map);
  }

  /// Of a joint in which nothing acts.
  GaugeModel gauge_of(const Joint& joint, DrivenCoordinate coordinate) {
    for (const std::string& body : joint.bodies) attach(body, joint.at);
    visit_joint_ = &joint;
    JointForceTopology topology = joint_topology(joint, coordinate);
    const auto parts = parts_of<JointForceData>([&](const auto& design) {
      return joint_numbers(joint, topology.coordinate, design, sides_from(0));
    });
    topology.markers = {parts.markers[0], parts.markers[1]};
    return {make_joint_gauge(topology, parts.numbers, parts.derivatives), parts.map};
  }

 private:
  template <class Design>
  using ScalarOf = typename std::remove_cvref_t<Design>::value_type;
  using Sides = std::span<const Attachment>;

  /// A force or a torque over the coordinate of a joint. @pre its own body is attached
  BuiltLoad over_joint(const PointLoad& load) {
    const Joint& joint = find_joint(context_.scene, load.over->joint);
    for (const std::string& body : joint.bodies) attach(body, joint.at);
    visit_joint_ = &joint;
    const JointForceTopology along = joint_topology(joint, load.over->coordinate);
    LoadOverJointTopology topology;
    topology.name = load_.name;
    topology.kind = load.kind;
    topology.direction = load.follows_body ? LoadDirection::body : LoadDirection::space;
    topology.coordinate = along.coordinate;
    topology.sense = along.sense;
    const auto data = [&](const auto& design) {
      const auto of_joint = joint_numbers(joint, along.coordinate, design, sides_from(1));
      LoadOverJointData<ScalarOf<decltype(design)>> numbers;
      set_numbers(load, design, numbers);
      numbers.points = of_joint.points;
      numbers.directions = of_joint.directions;
      numbers.offset = of_joint.offset;
      return numbers;
    };
    const auto parts = parts_of<LoadOverJointData>(data);
    for (std::size_t i = 0; i < 3; ++i) topology.markers[i] = parts.markers[i];
    return {
        project(make_load_over_joint_term(topology, parts.numbers, parts.derivatives), parts.map),
        std::nullopt};
  }

  JointForceTopology joint_topology(const Joint& joint, DrivenCoordinate coordinate) const {
    JointForceTopology topology;
    topology.name = load_.name;
    topology.coordinate = RelativeCoordinate::displacement;
    if (coordinate == DrivenCoordinate::angle) {
      topology.coordinate =
          context_.plane ? RelativeCoordinate::planar_angle : RelativeCoordinate::angle;
    }
    const Eigen::Vector3d axis = to_vector(joint.axis).normalized();
    if (context_.plane && axis.dot(context_.plane->normal) < 0.0) topology.sense = -1.0;
    return topology;
  }

  /// Of the joint, without what acts in it.
  template <class Scalar>
  JointForceData<Scalar> joint_numbers(const Joint& joint, RelativeCoordinate coordinate,
                                       const Design<Scalar>& design, Sides sides) const {
    JointForceData<Scalar> numbers;
    for (std::size_t i = 0; i < 2; ++i) numbers.points[i] = sides[i].local_point(design);
    set_directions(joint, coordinate, design, sides, numbers);
    return numbers;
  }

  /// The sides of a joint among the places.
  Sides sides_from(std::size_t first) const { return Sides(places_).subspan(first, 2); }

  /// @pre its own body is attached
  template <class Scalar, class Data>
  void set_numbers(const PointLoad& load, const Design<Scalar>& design, Data& numbers) const {
    const Eigen::Vector3d global = to_vector(load.direction).normalized();
    numbers.direction = load.follows_body ? places_[0].local_direction(global, design)
                                          : Vector3<Scalar>(global.template cast<Scalar>());
    numbers.value = resolve_time_law(load.value, design);
    if (!load.is_force()) return;
    numbers.point = places_[0].local_point(design);
    if (!load.whole) return;
    // Of the value, that acts on this part of its stretch.
    const auto* body = find_named(context_.scene.bodies, load.body);
    const Scalar share = share_of_stretch(std::get<BeamBody>(body->shape), *load.whole, design);
    numbers.direction = share * numbers.direction;
  }

  void attach(const std::string& body, const Point& at) {
    places_.emplace_back(body, at, bodies_, context_);
  }

  template <class Scalar>
  void set_directions(const Joint& joint, RelativeCoordinate coordinate,
                      const Design<Scalar>& design, Sides sides,
                      JointForceData<Scalar>& numbers) const {
    const Eigen::Vector3d axis = to_vector(joint.axis).normalized();
    if (coordinate == RelativeCoordinate::planar_angle) {
      numbers.offset = sides[1].start_angle(design) - sides[0].start_angle(design);
    } else if (coordinate == RelativeCoordinate::displacement) {
      numbers.directions[0] = sides[0].local_direction(axis, design);
    } else {
      const Eigen::Vector3d reference = angle_reference(joint, sides);
      numbers.directions[0] = sides[0].local_direction(reference, design);
      numbers.directions[1] =
          sides[0].local_direction(Eigen::Vector3d(axis.cross(reference)), design);
      numbers.directions[2] = sides[1].local_direction(reference, design);
    }
  }

  std::set<int> variables() const {
    std::set<int> all;
    for (const Attachment& place : places_) place.add_variables(all);
    add_variables_of(load_, all);
    if (visit_joint_) add_variables_of(*visit_joint_, all);
    return context_.differentiated(std::move(all));
  }

  /// What a force element is made of.
  template <template <class> class Data>
  struct Parts {
    std::vector<Marker> markers;
    Data<double> numbers;
    std::vector<DesignDerivative<Data<double>>> derivatives;
    std::optional<CoordinateMap> map;  ///< none: its coordinates are those of the system
  };

  /// @param data  design → numbers
  template <template <class> class Data, class MakeData>
  Parts<Data> parts_of(const MakeData& data) const {
    Parts<Data> parts;
    for (int variable : variables()) {
      if (auto change = derivative_data(Data<Dual>(data(context_.seeded(variable))))) {
        parts.derivatives.push_back({variable, std::move(*change)});
      }
    }
    bool is_direct = true;
    for (const Attachment& place : places_) {
      parts.markers.push_back(place.marker());
      is_direct = is_direct && place.is_direct();
    }
    parts.numbers = data(context_.design);
    if (!is_direct) parts.map = make_local(places_, parts.markers);
    return parts;
  }

  std::unique_ptr<Term> project(std::unique_ptr<Term> term,
                                const std::optional<CoordinateMap>& map) const {
    if (!map) return term;
    return std::make_unique<ProjectedTerm>(std::move(term), *map, coordinates_);
  }

  BuiltLoad with_gauge(ForceElement element, const std::optional<CoordinateMap>& map) const {
    return {project(std::move(element.term), map), GaugeModel{std::move(element.gauge), map}};
  }

  const Load& load_;
  const std::vector<BodyModel>& bodies_;
  const BuildContext& context_;
  int coordinates_;
  std::vector<Attachment> places_;
  const Joint* visit_joint_ = nullptr;
};

}  // namespace

BuiltLoad make_load(const Load& load, const std::vector<BodyModel>& bodies,
                    const BuildContext& context, int coordinates) {
  return std::visit(LoadBuilder(load, bodies, context, coordinates), load.element);
}

void add_gauges(const Joint& joint, const std::vector<BodyModel>& bodies,
                const BuildContext& context, JointModel& model) {
  const Load nothing{joint.name, JointForce{}};
  const auto gauge = [&](DrivenCoordinate coordinate) {
    return LoadBuilder(nothing, bodies, context, 0).gauge_of(joint, coordinate);
  };
  const bool turns = std::ranges::all_of(joint.bodies, [&](const std::string& body) {
    return Attachment(body, joint.at, bodies, context).has_orientation();
  });
  const JointKind& kind = kind_of(joint.type);
  if (kind.has_angle() && turns) model.angle = gauge(DrivenCoordinate::angle);
  if (kind.has_displacement()) model.displacement = gauge(DrivenCoordinate::displacement);
}

}  // namespace pleuel
