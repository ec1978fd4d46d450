#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "core/scene/joint_kind.hpp"
#include "core/scene/scene.hpp"

/// Where joints and loads hold on to bodies: the only list of it.
namespace pleuel {

/// Where a point stands in a joint or load of a problem file.
struct PointKey {
  const char* key;  ///< "at", "to"
  int index = -1;   ///< of a list of points
};

/// Calls visit(body, at, key) for each point that a joint or a load holds on to: the name of the
/// body or of the ground, the point at t = 0, and where it stands. What acts in a joint holds on to
/// nothing itself.
/// @param holder  a Joint or a Load; of one that is not const, visit() may change body and point
template <class Holder, class Visit>
void visit_held_points(Holder& holder, Visit&& visit) {
  if constexpr (std::is_same_v<std::remove_const_t<Holder>, Joint>) {
    const bool has_length = kind_of(holder.type).has_length();
    visit(holder.bodies[0], holder.at, PointKey{"at"});
    visit(holder.bodies[1], has_length ? holder.to : holder.at, PointKey{has_length ? "to" : "at"});
  } else {
    std::visit(
        [&](auto& element) {
          using Element = std::remove_cvref_t<decltype(element)>;
          if constexpr (std::is_same_v<Element, SpringDamper>) {
            for (std::size_t end : {0U, 1U}) {
              visit(element.bodies[end], element.at[end], PointKey{"at", static_cast<int>(end)});
            }
          } else if constexpr (!std::is_same_v<Element, JointForce>) {
            visit(element.body, element.at, PointKey{"at"});
            if (element.to) visit(element.body, *element.to, PointKey{"to"});
          }
        },
        holder.element);
  }
}

/// Calls visit(at, key) for the same points, once where both bodies of a joint are held at one.
template <class Holder, class Visit>
void visit_held_places(const Holder& holder, Visit&& visit) {
  const Point* last = nullptr;
  visit_held_points(holder, [&](const std::string&, const Point& at, const PointKey& key) {
    if (&at != last) visit(at, key);
    last = &at;
  });
}

/// Calls visit(at, key) for each point that says where a body is.
template <class Visit>
void visit_body_points(const Body& body, Visit&& visit) {
  std::visit(
      [&](const auto& shape) {
        if constexpr (requires { shape.from; }) {
          visit(shape.from, PointKey{"from"});
          visit(shape.to, PointKey{"to"});
        } else {
          visit(shape.at, PointKey{"at"});
        }
      },
      body.shape);
}

/// Whether a load is made of forces. Only their places tell how large a mechanism is and how far
/// its parts reach: a torque may be written at any point of a rigid body.
inline bool has_forces(const Load& load) {
  const auto* point = std::get_if<PointLoad>(&load.element);
  return point == nullptr || point->is_force();
}

/// Where a joint or a load holds on to a body, or an initial deflection is given.
struct AttachedPoint {
  std::string name;  ///< of the joint or load, or "initial deflection"
  Point at;          ///< at t = 0, global axes [m]
};

/// Those of a body: joints first, in the order of the file.
std::vector<AttachedPoint> attached_points(const Scene& scene, const std::string& body);

}  // namespace pleuel
