#include "studies/priced_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/model/motion_plane.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/body_rules.hpp"

namespace pleuel {

namespace {

using Groups = std::vector<NumberGroup>;

constexpr const char* point_ends[] = {"/from", "/to", "/at", "/at/0", "/at/1"};

/// "…/at/1" is the second component of the point "…/at".
struct Component {
  std::string point;
  int index = 0;
};

/// Of a body, a joint or a load, or one of the two of a spring.
bool is_point(const std::string& pointer) {
  return std::any_of(std::begin(point_ends), std::end(point_ends),
                     [&](const char* end) { return pointer.ends_with(end); });
}

std::optional<Component> component_of(const SceneNumber& number) {
  const std::size_t slash = number.pointer.rfind('/');
  const std::string point = number.pointer.substr(0, slash);
  if (!is_point(point)) return std::nullopt;
  return Component{point, std::stoi(number.pointer.substr(slash + 1))};
}

/// Equal for points at one place.
std::string place_text(double x, double y, double z) {
  const auto rounded = [](double value) { return value == 0.0 ? 0.0 : value; };  // no −0
  return fmt::format("{:.12g} {:.12g} {:.12g}", rounded(x), rounded(y), rounded(z));
}

/// PointCoordinates by the text of their coordinates; one with a coordinate that is not fixed has none.
class PointCoordinates {
 public:
  explicit PointCoordinates(const std::vector<SceneNumber>& numbers) {
    for (const SceneNumber& number : numbers) {
      const auto component = component_of(number);
      if (!component) continue;
      auto& coordinates = coordinates_[component->point];
      coordinates[component->index] = number.value;
    }
  }

  /// Equal for points at one place.
  std::string place(const std::string& point) const {
    const auto& [x, y, z] = coordinates_.at(point);
    if (!x || !y || !z) return point;
    return place_text(*x, *y, *z);
  }

 private:
  std::map<std::string, std::array<std::optional<double>, 3>> coordinates_;
};

bool leaves_plane(const Component& component, const std::optional<MotionPlane>& plane) {
  return plane && std::abs(plane->normal(component.index)) > 1e-12;
}

/// @param taken  places of points that variables move: what is there cannot be moved by itself
Groups grouped(const std::vector<SceneNumber>& numbers, const std::optional<MotionPlane>& plane,
               const std::set<std::string>& taken) {
  const PointCoordinates points(numbers);
  Groups groups;
  std::map<std::string, std::size_t> group_of_place;
  for (const SceneNumber& number : numbers) {
    const auto component = component_of(number);
    if (!component) {
      if (number.value != 0.0) groups.push_back({number.pointer, {number.pointer}});
      continue;
    }
    const std::string place = points.place(component->point);
    if (leaves_plane(*component, plane) || taken.contains(place)) continue;
    const std::string key = fmt::format("{} {}", place, component->index);
    const auto [found, is_new] = group_of_place.try_emplace(key, groups.size());
    if (is_new) groups.push_back({number.pointer, {}});
    groups[found->second].pointers.push_back(number.pointer);
  }
  return groups;
}

bool can_be_bound(const ProblemText& text, const Groups& groups) {
  try {
    bind_numbers(text, groups);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// Those that variables can stand for, by halves: mostly all of them, and one reading will do.
Groups bindable(const ProblemText& text, const Groups& groups) {
  if (groups.empty() || can_be_bound(text, groups)) return groups;
  if (groups.size() == 1) return {};
  const auto middle = groups.begin() + static_cast<std::ptrdiff_t>(groups.size() / 2);
  Groups kept = bindable(text, Groups(groups.begin(), middle));
  const Groups rest = bindable(text, Groups(middle, groups.end()));
  kept.insert(kept.end(), rest.begin(), rest.end());
  return kept;
}

}  // namespace

PricedNumbers priced_numbers(const ProblemText& text, const ProblemFile& problem) {
  const Eigen::VectorXd start = start_design(problem);
  const Design<double> design(start.begin(), start.end());
  std::set<std::string> taken;
  for (const Eigen::Vector3d& point : bound_points(problem.scene, design)) {
    taken.insert(place_text(point.x(), point.y(), point.z()));
  }
  const PlaneAnalysis plane = find_motion_plane(problem.scene, design);
  const Groups wanted = grouped(scene_numbers(text), plane.plane, taken);
  PricedNumbers priced{bindable(text, wanted), {}};
  for (const NumberGroup& group : wanted) {
    const bool is_priced =
        std::any_of(priced.groups.begin(), priced.groups.end(),
                    [&](const NumberGroup& one) { return one.name == group.name; });
    if (!is_priced) priced.left_out.push_back(group.name);
  }
  return priced;
}

}  // namespace pleuel
