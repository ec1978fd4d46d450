#include "core/model/load_builder.hpp"

#include <cassert>

#include "core/base/find_named.hpp"
#include "core/forces/joint_force.hpp"
#include "core/forces/point_force.hpp"
#include "core/forces/point_torque.hpp"
#include "core/forces/spring_damper.hpp"
#include "core/frame/number_data.hpp"
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

  std::unique_ptr<Term> operator()(const PointForce& force) {
    attach(force.body, force.at);
    PointForceTopology topology;
    topology.name = load_.name;
    topology.direction = force.follows_body ? LoadDirection::body : LoadDirection::space;
    const auto data = [&](const auto& design) {
      PointForceData<ScalarOf<decltype(design)>> numbers;
      numbers.point = places_[0].local_point(design);
      numbers.direction = load_direction(force.direction, force.follows_body, design);
      numbers.value = resolve_time_law(force.value, design);
      return numbers;
    };
    return finish<PointForceData>(data, [&](std::span<const Marker> markers, auto numbers, auto x) {
      topology.marker = markers[0];
      return make_point_force_term(topology, numbers, x);
    });
  }

  std::unique_ptr<Term> operator()(const PointTorque& torque) {
    attach(torque.body, torque.at);
    PointTorqueTopology topology;
    topology.name = load_.name;
    topology.direction = torque.follows_body ? LoadDirection::body : LoadDirection::space;
    const auto data = [&](const auto& design) {
      PointTorqueData<ScalarOf<decltype(design)>> numbers;
      numbers.direction = load_direction(torque.direction, torque.follows_body, design);
      numbers.value = resolve_time_law(torque.value, design);
      return numbers;
    };
    return finish<PointTorqueData>(data,
                                   [&](std::span<const Marker> markers, auto numbers, auto x) {
                                     topology.marker = markers[0];
                                     return make_point_torque_term(topology, numbers, x);
                                   });
  }

  std::unique_ptr<Term> operator()(const SpringDamper& spring) {
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
      return numbers;
    };
    return finish<SpringDamperData>(
        data, [&](std::span<const Marker> markers, auto numbers, auto x) {
          return make_spring_damper_term({load_.name, {markers[0], markers[1]}}, numbers, x);
        });
  }

  std::unique_ptr<Term> operator()(const JointForce& force) {
    const Joint& joint = find_joint(context_.scene, force.joint);
    for (const std::string& body : joint.bodies) attach(body, joint.at);
    visit_joint_ = &joint;
    const Eigen::Vector3d axis = to_vector(joint.axis).normalized();
    JointForceTopology topology;
    topology.name = load_.name;
    topology.coordinate = RelativeCoordinate::displacement;
    if (force.coordinate == DrivenCoordinate::angle) {
      topology.coordinate =
          context_.plane ? RelativeCoordinate::planar_angle : RelativeCoordinate::angle;
    }
    if (context_.plane && axis.dot(context_.plane->normal) < 0.0) topology.sense = -1.0;
    const auto data = [&](const auto& design) {
      JointForceData<ScalarOf<decltype(design)>> numbers;
      for (std::size_t i = 0; i < 2; ++i) numbers.points[i] = places_[i].local_point(design);
      set_directions(joint, axis, topology.coordinate, design, numbers);
      numbers.stiffness = resolve(force.stiffness, design);
      numbers.damping = resolve(force.damping, design);
      numbers.rest = resolve(force.rest, design);
      if (force.motor) numbers.motor = resolve_time_law(*force.motor, design);
      return numbers;
    };
    return finish<JointForceData>(data, [&](std::span<const Marker> markers, auto numbers, auto x) {
      topology.markers = {markers[0], markers[1]};
      return make_joint_force_term(topology, numbers, x);
    });
  }

 private:
  template <class Design>
  using ScalarOf = typename std::remove_cvref_t<Design>::value_type;

  void attach(const std::string& body, const Point& at) {
    places_.emplace_back(body, at, bodies_, context_);
  }

  template <class Scalar>
  Vector3<Scalar> load_direction(const std::array<double, 3>& direction, bool follows,
                                 const Design<Scalar>& design) const {
    const Eigen::Vector3d global = to_vector(direction).normalized();
    if (!follows) return global.template cast<Scalar>();
    return places_[0].local_direction(global, design);
  }

  template <class Scalar>
  void set_directions(const Joint& joint, const Eigen::Vector3d& axis,
                      RelativeCoordinate coordinate, const Design<Scalar>& design,
                      JointForceData<Scalar>& numbers) const {
    if (coordinate == RelativeCoordinate::planar_angle) {
      numbers.offset = places_[1].start_angle(design) - places_[0].start_angle(design);
    } else if (coordinate == RelativeCoordinate::displacement) {
      numbers.directions[0] = places_[0].local_direction(axis, design);
    } else {
      const Eigen::Vector3d reference = joint.type == JointType::universal
                                            ? to_vector(joint.second_axis).normalized()
                                            : reference_direction(places_, axis);
      numbers.directions[0] = places_[0].local_direction(reference, design);
      numbers.directions[1] =
          places_[0].local_direction(Eigen::Vector3d(axis.cross(reference)), design);
      numbers.directions[2] = places_[1].local_direction(reference, design);
    }
  }

  std::set<int> variables() const {
    std::set<int> all;
    for (const Attachment& place : places_) place.add_variables(all);
    const auto add = [&](const Number& number, const Quantity&) {
      if (number.is_bound()) all.insert(number.variable);
    };
    visit_numbers(load_, add);
    if (visit_joint_) visit_numbers(*visit_joint_, add);
    return all;
  }

  /// @param data  design → numbers;  @param make  markers, numbers, derivatives → term
  template <template <class> class Data, class MakeData, class MakeTerm>
  std::unique_ptr<Term> finish(const MakeData& data, const MakeTerm& make) {
    std::vector<DesignDerivative<Data<double>>> derivatives;
    for (int variable : variables()) {
      if (auto change = derivative_data(Data<Dual>(data(context_.seeded(variable))))) {
        derivatives.push_back({variable, std::move(*change)});
      }
    }
    std::vector<Marker> markers;
    bool is_direct = true;
    for (const Attachment& place : places_) {
      markers.push_back(place.marker());
      is_direct = is_direct && place.is_direct();
    }
    const Data<double> numbers = data(context_.design);
    if (is_direct) return make(markers, numbers, derivatives);
    CoordinateMap map = make_local(places_, markers);
    return std::make_unique<ProjectedTerm>(make(markers, numbers, derivatives), std::move(map),
                                           coordinates_);
  }

  const Load& load_;
  const std::vector<BodyModel>& bodies_;
  const BuildContext& context_;
  int coordinates_;
  std::vector<Attachment> places_;
  const Joint* visit_joint_ = nullptr;
};

}  // namespace

std::unique_ptr<Term> make_load_term(const Load& load, const std::vector<BodyModel>& bodies,
                                     const BuildContext& context, int coordinates) {
  return std::visit(LoadBuilder(load, bodies, context, coordinates), load.element);
}

}  // namespace pleuel
