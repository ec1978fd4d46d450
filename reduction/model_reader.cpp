#include "reduction/model_reader.hpp"

#include <algorithm>
#include <filesystem>
#include <numbers>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/scene/reading/key_reader.hpp"
#include "core/scene/reading/syntax_error.hpp"
#include "reduction/calculix_input.hpp"

namespace pleuel {

namespace {

namespace fs = std::filesystem;

/// SI values of the units that the finite-element program counted in.
struct MeshUnits {
  double length, mass, time;
};

constexpr Choice<MeshUnits> unit_choices[] = {{"m-kg-s", {1.0, 1.0, 1.0}},
                                              {"mm-t-s", {1e-3, 1e3, 1.0}},
                                              {"mm-kg-ms", {1e-3, 1.0, 1e-3}},
                                              {"mm-kg-s", {1e-3, 1.0, 1.0}}};

constexpr Choice<int> planes[] = {{"x = 0", 0}, {"y = 0", 1}, {"z = 0", 2}};

/// β of D = β K
constexpr Measure damping_time = {quantities::time, Range::not_negative};

/// Numbers of a model file: in SI, or texts with a unit.
class ModelReader {
 public:
  explicit ModelReader(const JsonNode& root) : root_(root), numbers_({}) {}

  ReductionModel read() {
    const auto describe = [&](Keys& keys) {
      keys.text("body", model_.body, "");
      keys.text(optional_key("description"), model_.description, "");
      keys.fixed(optional_key("damping"), model_.damping, damping_time, "");
      keys.choice(optional_key("plane"), model_.plane, planes, "");
      keys.whole(optional_key("surface"), model_.surface, {4, 100000}, "");
    };
    read_keys(
        root_, numbers_, describe,
        {"mesh", "matrices", "units", "interfaces", "places", "modes", "stress", "stiffening"});
    read_mesh();
    read_interfaces();
    read_modes(root_.at("modes"));
    if (const auto stress = root_.find("stress")) read_stress(*stress);
    if (const auto line = root_.find("stiffening")) read_stiffening(*line);
    return std::move(model_);
  }

 private:
  fs::path file(const JsonNode& name) const {
    return fs::path(root_.file()).parent_path() / name.text();
  }

  void read_mesh() {
    model_.mesh = read_calculix_input(file(root_.at("mesh")));
    const JsonNode matrices = root_.at("matrices");
    matrices.allow_keys({"calculix", "stiffness", "mass"});
    if (const auto job = matrices.find("calculix")) {
      model_.matrices = read_calculix_matrices(file(*job), model_.mesh);
    } else {
      model_.matrices = read_market_matrices(file(matrices.at("stiffness")),
                                             file(matrices.at("mass")), model_.mesh);
    }
    const MeshUnits units = read_choice<MeshUnits>(root_.at("units"), unit_choices);
    scale_mesh(model_.mesh, units.length, units.mass, units.time);
    model_.matrices.stiffness *= units.mass / (units.time * units.time);
    model_.matrices.mass *= units.mass;
  }

  Eigen::Vector3d point(const JsonNode& node) const {
    const std::vector<JsonNode> items = node.items(3);
    Eigen::Vector3d x;
    for (int k = 0; k < 3; ++k) x(k) = numbers_.fixed(items[k], quantities::length);
    return x;
  }

  /// The name of a set of nodes, "surface", or what lies in a box or on a cylinder.
  std::vector<int> nodes(const JsonNode& node) const {
    if (node.value().is_string()) return named_nodes(node);
    node.allow_keys({"box", "cylinder"});
    const auto box = node.find("box");
    const std::vector<int> found = box ? nodes_in_box(*box) : nodes_on(node.at("cylinder"));
    if (found.empty()) {
      const Eigen::Vector3d least = model_.mesh.positions.rowwise().minCoeff();
      const Eigen::Vector3d most = model_.mesh.positions.rowwise().maxCoeff();
      node.fail(
          fmt::format("has no node; the body reaches from ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, "
                      "{:.4g}, {:.4g}) m",
                      least(0), least(1), least(2), most(0), most(1), most(2)));
    }
    return found;
  }

  std::vector<int> named_nodes(const JsonNode& node) const {
    std::string name = node.text();
    if (name == "surface") return surface_corners(model_.mesh);
    std::vector<std::string> known = {"surface"};
    for (const auto& [set, members] : model_.mesh.node_sets) {
      if (!members.empty()) known.push_back(set);
    }
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return std::toupper(c); });
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      fail_unknown_name(node, "set of nodes", node.text(), known);
    }
    return model_.mesh.node_sets.at(name);
  }

  std::vector<int> nodes_in_box(const JsonNode& node) const {
    const std::vector<JsonNode> corners = node.items(2);
    const Eigen::Vector3d a = point(corners[0]), b = point(corners[1]);
    const double slack = 1e-9 * model_.mesh.positions.cwiseAbs().maxCoeff();
    return nodes_where([&](const Eigen::Vector3d& x) {
      return (x.array() >= a.cwiseMin(b).array() - slack).all() &&
             (x.array() <= a.cwiseMax(b).array() + slack).all();
    });
  }

  /// On the surface of a cylinder between two points of its axis.
  std::vector<int> nodes_on(const JsonNode& node) const {
    node.allow_keys({"from", "to", "radius"});
    const Eigen::Vector3d from = point(node.at("from")), axis = point(node.at("to")) - from;
    const double radius = numbers_.fixed(node.at("radius"), quantities::length, Range::positive);
    if (axis.norm() == 0.0) node.at("to").fail("must be another point than \"from\"");
    return nodes_where([&](const Eigen::Vector3d& x) {
      const double along = axis.dot(x - from) / axis.squaredNorm();
      const double distance = (x - from - along * axis).norm();
      return along > -1e-6 && along < 1.0 + 1e-6 && std::abs(distance - radius) < 1e-3 * radius;
    });
  }

  template <class Condition>
  std::vector<int> nodes_where(const Condition& condition) const {
    std::vector<int> found;
    for (int i = 0; i < model_.mesh.size(); ++i) {
      if (condition(Eigen::Vector3d(model_.mesh.positions.col(i)))) found.push_back(i);
    }
    return found;
  }

  InterfaceSet read_set(const std::string& name, const JsonNode& node) const {
    InterfaceSet set{name, nodes(node.at("nodes")), {}, false};
    const auto at = node.find("at");
    set.at = at ? point(*at) : centroid_of(set.nodes, model_.mesh.positions);
    return set;
  }

  void read_interfaces() {
    const JsonNode node = root_.at("interfaces");
    for (const auto& [name, member] : node.members()) {
      member.allow_keys({"nodes", "kind", "at"});
      model_.interfaces.push_back(read_set(name, member));
      model_.interfaces.back().is_rigid =
          read_choice<bool>(member.at("kind"), {{"rigid", true}, {"averaged", false}});
    }
    if (model_.interfaces.empty())
      node.fail("must have an interface: the first holds the body frame");
    const auto places = root_.find("places");
    if (!places) return;
    for (const auto& [name, member] : places->members()) {
      member.allow_keys({"nodes", "at"});
      if (find_named(model_.interfaces, name) != nullptr) {
        member.fail("has the name of an interface, which is a place already");
      }
      model_.places.push_back(read_set(name, member));
    }
  }

  /// A number, {"below": "2 kHz"}, or {"inertia_responses": 2}.
  void read_modes(const JsonNode& node) {
    if (node.value().is_object() && node.find("inertia_responses")) {
      node.allow_keys({"inertia_responses"});
      model_.modes.generations = node.at("inertia_responses").whole_number(1, 20);
    } else if (node.value().is_object()) {
      node.allow_keys({"below", "inertia_responses"});
      model_.modes.frequency =
          numbers_.fixed(node.at("below"), quantities::angular_frequency, Range::positive);
    } else {
      model_.modes.number = node.whole_number(0, 1000);
    }
    if (model_.interfaces.size() == 1 && model_.modes.number == 0 &&
        model_.modes.frequency == 0.0 && model_.modes.generations == 0) {
      node.fail("must be positive with one interface: else nothing of the body is elastic");
    }
  }

  /// Of a rigid interface no stress is known.
  std::vector<int> elastic_nodes(const JsonNode& node) const {
    std::vector<int> found = nodes(node);
    for (const InterfaceSet& interface : model_.interfaces) {
      if (!interface.is_rigid) continue;
      std::erase_if(found, [&](int i) {
        return std::binary_search(interface.nodes.begin(), interface.nodes.end(), i);
      });
    }
    return found;
  }

  /// Nodes, or {NAME: nodes} for groups that responses can name.
  std::vector<NodeGroup> stress_groups(const JsonNode& node) const {
    const bool is_one = node.value().is_string() || node.find("box") || node.find("cylinder");
    if (is_one) return {{"", elastic_nodes(node)}};
    std::vector<NodeGroup> groups;
    for (const auto& [name, member] : node.members()) {
      groups.push_back({name, elastic_nodes(member)});
    }
    if (groups.empty()) node.fail("must have at least one group of nodes");
    return groups;
  }

  void read_stress(const JsonNode& node) {
    StressChoice& stress = model_.stress.emplace();
    const auto describe = [&](Keys& keys) {
      keys.whole(optional_key("most"), stress.most, {1, 100000}, "");
      for (const auto& [word, member] : strength_members<double>) {
        keys.fixed(optional_key(word.data()), stress.strengths.*member,
                   {quantities::stress, Range::positive}, "");
      }
      keys.fixed(optional_key(fatigue_exponent_word.data()), stress.strengths.fatigue_exponent,
                 {quantities::pure_number, Range::positive}, "");
    };
    read_keys(node, numbers_, describe, {"nodes"});
    stress.groups = stress_groups(node.at("nodes"));
  }

  void read_stiffening(const JsonNode& node) {
    StiffeningLine& line = model_.stiffening.emplace();
    line.damping = model_.damping;
    const std::vector<std::string> names = names_of(model_.interfaces);
    std::string begin, end;
    read_keys(node, numbers_, [&](Keys& keys) {
      keys.name("from", "interface", names, begin, "");
      keys.name("to", "interface", names, end, "");
      keys.must("to", begin != end, "must be another interface than \"from\"");
      keys.whole("elements", line.elements, {1, 1000}, "");
      keys.fixed(optional_key("damping"), line.damping, damping_time, "");
    });
    line.begin = *find_named(model_.interfaces, begin);
    line.end = *find_named(model_.interfaces, end);
  }

  JsonNode root_;
  NumberReader numbers_;
  ReductionModel model_;
};

}  // namespace

ReductionModel read_reduction_model(const std::string& path) {
  const Json document = parse_json(read_text_file(path), path);
  return ModelReader(JsonNode(document, path, "", "the model")).read();
}

}  // namespace pleuel
