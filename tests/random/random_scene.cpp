#include "tests/random/random_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/monitors.hpp"
#include "tests/support/problem_runs.hpp"

namespace pleuel::test {

namespace {

using Eigen::Vector3d;

constexpr double pi = std::numbers::pi;

/// Distributions of the standard library differ between implementations.
class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) { engine_.discard(16); }

  double uniform(double from, double to) {
    return from + (to - from) * static_cast<double>(engine_()) / 4294967296.0;
  }
  double decades(double from, double to) { return std::exp(uniform(std::log(from), std::log(to))); }
  int whole(int from, int to) { return static_cast<int>(std::floor(uniform(from, to + 1))); }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  std::string one_of(const std::vector<std::string>& choices) {
    return choices[static_cast<std::size_t>(whole(0, static_cast<int>(choices.size()) - 1))];
  }

 private:
  std::mt19937 engine_;
};

Json point(const Vector3d& p) {
  return Json::array({p.x(), p.y(), p.z()});
}

struct Properties {
  double area, inertia;  ///< [m²], [m⁴], the smaller one
};

class SceneMaker {
 public:
  explicit SceneMaker(unsigned seed) : dice_(seed) {
    file_["scene"]["materials"] = {{"stuff",
                                    {{"young", dice_.decades(2e8, 2e12)},
                                     {"poisson", dice_.uniform(0.0, 0.45)},
                                     {"density", dice_.decades(800, 8000)}}}};
    size_ = dice_.decades(0.05, 2.0);
    kind_ = dice_.whole(0, 3);
    share_ = dice_.decades(0.01, 0.8);
  }

  RandomMechanism make() {
    if (kind_ == 0) make_four_bar();
    if (kind_ == 1) make_slider_crank();
    if (kind_ == 2) make_spatial_slider_crank();
    if (kind_ == 3) make_chain();
    add_gravity();
    add_simulation();
    add_responses();
    static const std::array<const char*, 4> kinds = {"four-bar", "slider-crank",
                                                     "spatial slider-crank", "chain"};
    const double share = torque_.empty() ? 0.0 : speed_ / lowest_;
    return {file_, kinds[kind_], is_spatial_, share, weight()};
  }

 private:
  Json& bodies() { return file_["scene"]["bodies"]; }
  Json& joints() { return file_["scene"]["joints"]; }

  /// @param thickness  over the length
  Json section(const std::string& body, double breadth, Properties& properties) {
    const std::string type =
        dice_.one_of({"rectangle", "circle", "tube", "ellipse", "box", "i", "general"});
    const double b = breadth, h = breadth * dice_.uniform(0.6, 1.5), t = 0.15 * std::min(b, h);
    const auto variable = [&](const char* what, double value) {
      if (file_["variables"].size() == 2) return Json(value);
      const std::string name = body + "_" + what;
      file_["variables"][name] = {{"start", value}, {"lower", 0.7 * value}, {"upper", 1.3 * value}};
      return Json{{"variable", name}};
    };
    Json section = {{"type", type}};
    const double m = std::min(b, h), M = std::max(b, h);
    properties = {0.4 * b * h, 0.02 * M * m * m * m};
    if (type == "rectangle" || type == "ellipse" || type == "box" || type == "i") {
      section["width"] = b;
      section["height"] = variable("height", h);
    }
    if (type == "rectangle" || type == "ellipse") properties = {0.8 * b * h, 0.05 * M * m * m * m};
    if (type == "box") section["thickness"] = t;
    if (type == "i") {
      section["flange_thickness"] = t;
      section["web_thickness"] = 0.8 * t;
    }
    if (type == "circle") {
      section["diameter"] = variable("diameter", b);
      properties = {pi * b * b / 4, pi * std::pow(b, 4) / 64};
    }
    if (type == "tube") {
      section["outer_diameter"] = variable("diameter", b);
      section["thickness"] = 0.15 * b;
      properties = {0.4 * b * b, 0.035 * std::pow(b, 4)};
    }
    if (type == "general") {
      section["area"] = variable("area", b * h);
      section["inertia_y"] = h * b * b * b / 12;
      section["inertia_z"] = b * h * h * h / 12;
      section["torsion"] = 0.14 * m * m * m * M;
      section["points"] = {{{"y", h / 2}, {"z", b / 2}, {"shear", 1 / (0.2 * m * m * M)}},
                           {{"y", -h / 2}, {"z", 0.0}, {"shear", 1 / (0.21 * m * m * M)}}};
      properties = {b * h, m * m * m * M / 12};
    }
    return section;
  }

  /// Remembers the lowest angular frequency of bending between hinges.
  void add_beam(const std::string& name, const Vector3d& from, const Vector3d& to) {
    const double length = (to - from).norm();
    Properties properties{};
    const double breadth = std::max(length, least_length_) * dice_.uniform(0.02, 0.07);
    Json body = {{"type", "beam"}, {"from", point(from)}, {"to", point(to)}, {"material", "stuff"}};
    body["section"] = section(name, breadth, properties);
    body["elements"] = dice_.whole(1, is_long_ ? 3 : 6);
    if (dice_.chance(0.15) && !is_long_) {
      const Json section = body["section"];
      body.erase("section");
      const int elements = body["elements"];
      body.erase("elements");
      body["segments"] = {{{"section", section}, {"elements", elements}},
                          {{"section", section}, {"elements", dice_.whole(1, 3)}}};
    }
    body["frame"] = dice_.one_of({"tangent", "chord", "mean-axis"});
    const Vector3d axis = (to - from).normalized();
    const Vector3d across =
        normal_.cross(axis).norm() > 0.1 ? normal_.cross(axis) : axis.unitOrthogonal();
    body["reference"] = point(across.normalized());
    const auto& stuff = file_["scene"]["materials"]["stuff"];
    const double stiffness = stuff["young"].get<double>() * properties.inertia;
    const double mass = stuff["density"].get<double>() * properties.area;
    const double frequency = std::pow(pi / length, 2) * std::sqrt(stiffness / mass);
    lowest_ = std::min(lowest_, frequency);
    if (dice_.chance(0.15) && has_elastic_) {
      body["rigid"] = true;
    } else {
      has_elastic_ = true;
      elastic_ = name;
      if (dice_.chance(0.2)) body["reduction"] = {{"modes", dice_.whole(0, 2)}};
      if (dice_.chance(0.6))
        body["damping"] = {{"stiffness", 2 * dice_.decades(3e-3, 0.5) / frequency}};
    }
    bodies()[name] = body;
    mass_ += mass * length;
  }

  void add_joint(const std::string& name, const std::string& type, const std::string& first,
                 const std::string& second, const Vector3d& at) {
    joints()[name] = {{"type", type}, {"bodies", {first, second}}, {"at", point(at)}};
    if (type == "revolute") joints()[name]["axis"] = point(normal_);
  }

  /// Over the other members: what accelerates a rod sideways bends it by the square of the speed's
  /// share of the resonance, so fast cranks are short.
  double crank_share(double from, double to) {
    const double share = dice_.uniform(from, to) * std::min(1.0, 0.03 / (share_ * share_));
    least_length_ = 0.4 * size_;
    return share;
  }

  /// Of the masses of beams. Heavy ones buckle a fast rod.
  double slider_share() { return dice_.decades(0.1, 3) * std::min(1.0, 0.3 / share_); }

  void add_drive(const std::string& joint) {
    speed_ = lowest_ * share_;
    const double period = 2 * pi / speed_;
    const std::string type = dice_.one_of({"ramp-to-speed", "ramp-to-speed", "constant-speed"});
    if (type == "constant-speed") {
      joints()[joint]["drive"] = {{"type", type}, {"speed", speed_}};
    } else {
      joints()[joint]["drive"] = {
          {"type", type}, {"speed", speed_}, {"ramp", period * dice_.uniform(0.1, 0.8)}};
    }
    end_ = period * dice_.uniform(0.5, 1.3);
    torque_ = joint;
  }

  void make_four_bar() {
    const double d = size_, a = d * crank_share(0.2, 0.35), b = d * dice_.uniform(0.75, 1.1),
                 c = d * dice_.uniform(0.6, 1.0), angle = dice_.uniform(0, 2 * pi);
    const Vector3d A(0, 0, 0), D(d, 0, 0), B(a * std::cos(angle), a * std::sin(angle), 0);
    // C at b from B and c from D.
    const Vector3d e = D - B;
    const double s = e.norm(), along = (s * s + b * b - c * c) / (2 * s);
    const double height = std::sqrt(std::max(0.0, b * b - along * along));
    const Vector3d C = B + along * e / s + height * Vector3d(-e.y(), e.x(), 0) / s;
    add_beam("crank", A, B);
    add_beam("coupler", B, C);
    add_beam("rocker", C, D);
    add_joint("bearing", "revolute", "ground", "crank", A);
    add_joint("pin", "revolute", "crank", "coupler", B);
    add_joint("knee", "revolute", "coupler", "rocker", C);
    add_joint("pivot", "revolute", "rocker", "ground", D);
    add_drive("bearing");
    reaction_ = "pivot";
    add_load("rocker", C);
  }

  void make_slider_crank() {
    const double a = size_ * crank_share(0.1, 0.3), l = size_ * dice_.uniform(0.6, 1.0),
                 offset = a * dice_.uniform(-0.4, 0.4), angle = dice_.uniform(0, 2 * pi);
    const Vector3d B(a * std::cos(angle), a * std::sin(angle), 0);
    const Vector3d C(B.x() + std::sqrt(l * l - std::pow(offset - B.y(), 2)), offset, 0);
    add_beam("crank", Vector3d::Zero(), B);
    add_beam("rod", B, C);
    bodies()["slider"] = {
        {"type", "point-mass"}, {"at", point(C)}, {"mass", mass_ * slider_share()}};
    add_joint("bearing", "revolute", "ground", "crank", Vector3d::Zero());
    add_joint("pin", "revolute", "crank", "rod", B);
    add_joint("end", "revolute", "rod", "slider", C);
    add_joint("guide", "point-on-line", "ground", "slider", C);
    joints()["guide"]["axis"] = {1.0, 0.0, 0.0};
    add_drive("bearing");
    reaction_ = "guide";
    add_load("slider", C);
  }

  void make_spatial_slider_crank() {
    is_spatial_ = true;
    const double a = size_ * crank_share(0.1, 0.25), angle = dice_.uniform(0, 2 * pi);
    // The crank turns about x in the plane x = 0, the slider moves along z beside it.
    const double l = size_ * dice_.uniform(0.8, 1.0), aside = size_ * dice_.uniform(0.1, 0.4);
    normal_ = Vector3d::UnitX();
    const Vector3d B(0, a * std::cos(angle), a * std::sin(angle));
    const Vector3d C(aside, 0, B.z() + std::sqrt(l * l - aside * aside - B.y() * B.y()));
    add_beam("crank", Vector3d::Zero(), B);
    add_beam("rod", B, C);
    const double mass = mass_ * slider_share(), inertia = mass * 0.01 * l * l;
    bodies()["slider"] = {{"type", "rigid"},
                          {"at", point(C)},
                          {"mass", mass},
                          {"inertia", {inertia, inertia, inertia, 0, 0, 0}}};
    add_joint("bearing", "revolute", "ground", "crank", Vector3d::Zero());
    add_joint("pin", "spherical", "crank", "rod", B);
    add_joint("end", "universal", "slider", "rod", C);
    const Vector3d along = (C - B).normalized(), first = along.unitOrthogonal();
    joints()["end"]["axis"] = point(first);
    joints()["end"]["second_axis"] = point(along.cross(first));
    add_joint("guide", "prismatic", "ground", "slider", C);
    joints()["guide"]["axis"] = {0.0, 0.0, 1.0};
    add_drive("bearing");
    reaction_ = "guide";
    add_load("slider", C);
  }

  void make_chain() {
    const int links = dice_.whole(2, 6);
    is_spatial_ = dice_.chance(0.3);
    is_long_ = links > 3;
    Vector3d from = Vector3d::Zero();
    std::string before = "ground";
    for (int i = 0; i < links; ++i) {
      const double angle = dice_.uniform(-1.0, 1.0) + 0.7 * i;
      const Vector3d to = from + size_ / links * dice_.uniform(0.7, 1.3) *
                                     Vector3d(std::cos(angle), std::sin(angle), 0);
      const std::string name = fmt::format("link{}", i + 1), joint = fmt::format("hinge{}", i + 1);
      add_beam(name, from, to);
      const bool is_ball = is_spatial_ && i > 0 && dice_.chance(0.5);
      add_joint(joint, is_ball ? "spherical" : "revolute", before, name, from);
      before = name;
      from = to;
    }
    reaction_ = "hinge1";
    if (dice_.chance(0.5)) {
      add_drive("hinge1");
    } else {
      end_ = dice_.uniform(0.3, 0.8) * std::sqrt(size_ / weight());
    }
    add_load(before, from);
    end_ = std::min(end_, 2.0 * std::sqrt(size_ / weight()));
  }

  /// Acceleration of gravity [m/s²], less where members would sag far.
  double weight() const {
    const double length =
        size_ / (kind_ == 3 ? static_cast<double>(file_.at("scene").at("bodies").size()) : 1.0);
    return std::min(9.81, 0.01 * length * lowest_ * lowest_);
  }

  void add_load(const std::string& body, const Vector3d& at) {
    if (!dice_.chance(0.4)) return;
    const Vector3d direction =
        is_spatial_ ? Vector3d(dice_.uniform(-1, 1), dice_.uniform(-1, 1), 1).normalized()
                    : Vector3d(dice_.uniform(-1, 1), 1, 0).normalized();
    const double size = weight() * mass_;
    Json load = {
        {"type", "force"}, {"body", body}, {"at", point(at)}, {"direction", point(direction)}};
    const double force = size * dice_.uniform(0.2, 2.0);
    const int law = dice_.whole(0, 4);
    if (law <= 2) {
      load["value"] = {{"type", "harmonic"},
                       {"amplitude", force},
                       {"frequency", 2 * pi / end_ * dice_.uniform(0.5, 4.0)}};
    } else if (law == 3) {  // all at once
      load["value"] = {{"type", "table"},
                       {"times", {-0.1 * end_, 0.0}},
                       {"values", {0.0, force}},
                       {"interpolation", "step"}};
    } else {
      const double begin = end_ * dice_.uniform(0.1, 0.5), rise = end_ * dice_.uniform(0.03, 0.2);
      load["value"] = {{"type", "table"},
                       {"times", {begin, begin + rise, begin + 2 * rise}},
                       {"values", {0.0, force, 0.4 * force}},
                       {"interpolation", dice_.one_of({"linear", "step", "monotone"})}};
    }
    file_["scene"]["loads"]["push"] = load;
  }

  void add_gravity() {
    const bool is_needed = kind_ == 3 && torque_.empty();
    if (!is_needed && dice_.chance(0.4)) return;
    const double angle = dice_.uniform(0, 2 * pi);
    Vector3d down(std::cos(angle), std::sin(angle), 0);
    if (is_spatial_) down = Vector3d(down.x(), down.y(), dice_.uniform(-1, 1)).normalized();
    file_["scene"]["gravity"] = point(weight() * down);
  }

  void add_simulation() {
    Json& simulation = file_["simulation"];
    simulation = {{"end_time", end_}, {"step", end_ / dice_.whole(120, 500)}};
    const int formulation = dice_.whole(0, 3);
    if (formulation == 1) simulation["formulation"] = "stabilized-index-2";
    if (formulation >= 2) simulation["formulation"] = "index-1";
    if (formulation == 2) simulation["projection"] = true;
    if (formulation == 3) simulation["baumgarte"] = 0.05 / simulation["step"].get<double>();
    simulation["spectral_radius"] = std::stod(dice_.one_of({"0.6", "0.8", "0.9"}));
    simulation["newton_tolerance"] = 1e-12;
    if (dice_.chance(0.15)) simulation["initial_state"] = "quasi-static";
  }

  void add_responses() {
    Json& responses = file_["responses"];
    responses["mass"] = {{"type", "mass"}};
    responses["stress"] = {{"type", "stress"}, {"body", elastic_}, {"over_time", "max"}};
    responses["bow"] = {{"type", "deflection"}, {"body", elastic_}, {"at", 0.5},
                        {"against", "chord"},   {"direction", "y"}, {"over_time", "max-abs"}};
    responses["speed"] = {{"type", "velocity"},
                          {"body", elastic_},
                          {"at", 0.7},
                          {"direction", "magnitude"},
                          {"over_time", "rms"}};
    responses["acceleration"] = {{"type", "acceleration"},
                                 {"body", elastic_},
                                 {"at", 0.5},
                                 {"direction", "magnitude"},
                                 {"over_time", "rms"}};
    if (!torque_.empty()) {
      responses["torque_rms"] = {
          {"type", "drive-torque"}, {"joint", torque_}, {"over_time", "rms"}};
      responses["torque_peak"] = {
          {"type", "drive-torque"}, {"joint", torque_}, {"over_time", "max-abs"}};
    }
    responses["reaction"] = {{"type", "reaction-force"},
                             {"joint", reaction_},
                             {"direction", "magnitude"},
                             {"over_time", "max"}};
    responses["kinetic"] = {{"type", "kinetic-energy"}, {"over_time", "rms"}};
    responses["elastic"] = {{"type", "elastic-energy"}, {"over_time", "max"}};
  }

  Dice dice_;
  Json file_;
  int kind_ = 0;
  double size_ = 1.0;
  Vector3d normal_ = Vector3d::UnitZ();
  bool is_spatial_ = false, is_long_ = false, has_elastic_ = false;
  std::string elastic_, torque_, reaction_;
  double lowest_ = 1e300, mass_ = 0.0, speed_ = 0.0, end_ = 0.0;
  double share_ = 0.0;  ///< of the first resonance
  double least_length_ = 0.0;
};

bool is_vector_key(const std::string& key) {
  for (const char* name :
       {"from", "to", "at", "axis", "second_axis", "direction", "reference", "gravity"}) {
    if (key == name) return true;
  }
  return false;
}

void rotate(Json& node, const Eigen::Matrix3d& rotation) {
  for (auto& [key, value] : node.items()) {
    if (is_vector_key(key) && value.is_array() && value.size() == 3 && value[0].is_number()) {
      value = point(rotation * Vector3d(value[0].get<double>(), value[1].get<double>(),
                                        value[2].get<double>()));
    } else if (value.is_structured()) {
      rotate(value, rotation);
    }
  }
}

void nudge(Json& node, double share, Dice& dice) {
  for (auto& [key, value] : node.items()) {
    if (value.is_number_float()) {
      value = value.get<double>() * (1.0 + (dice.chance(0.5) ? share : -share));
    } else if (value.is_structured()) {
      nudge(value, share, dice);
    }
  }
}

/// Appends a suffix to every key and every text that is one of the names.
Json with_names(const Json& node, const std::vector<std::string>& names) {
  const auto change = [&](const std::string& text) {
    const bool is_name = std::find(names.begin(), names.end(), text) != names.end();
    return is_name ? "zz " + text + "'" : text;
  };
  if (node.is_string()) return change(node.get<std::string>());
  if (node.is_array()) {
    Json list = Json::array();
    for (const Json& entry : node) list.push_back(with_names(entry, names));
    return list;
  }
  if (!node.is_object()) return node;
  Json object = Json::object();
  for (const auto& [key, value] : node.items()) object[change(key)] = with_names(value, names);
  return object;
}

/// The unit that a number under a key is written in, and what one of it is in SI units.
struct Unit {
  const char* name;
  double size;
};

const Unit* unit_of(const std::string& key, const std::string& type) {
  static const Unit length{"mm", 1e-3}, time{"ms", 1e-3}, modulus{"MPa", 1e6},
      density{"g/cm^3", 1e3}, mass{"g", 1e-3}, acceleration{"mm/s^2", 1e-3}, force{"kN", 1e3},
      rate{"1/ms", 1e3}, speed{"rad/ms", 1e3}, area{"mm^2", 1e-6}, inertia{"mm^4", 1e-12};
  for (const char* name : {"from", "to", "at", "width", "height", "diameter", "outer_diameter",
                           "thickness", "flange_thickness", "web_thickness"}) {
    if (key == name) return &length;
  }
  for (const char* name : {"end_time", "step", "ramp", "times"}) {
    if (key == name) return &time;
  }
  if (key == "young") return &modulus;
  if (key == "density") return &density;
  if (key == "gravity") return &acceleration;
  if (key == "amplitude" || key == "values") return &force;
  if (key == "baumgarte") return &rate;
  if (key == "speed") return &speed;
  if (key == "area") return &area;
  if (key == "inertia_y" || key == "inertia_z" || key == "torsion") return &inertia;
  if (key == "mass" && type != "") return &mass;
  return nullptr;
}

/// Multiplies numbers under some keys, or all of a list there.
void scale(Json& node, const std::vector<std::string>& keys, double factor) {
  for (auto& [key, value] : node.items()) {
    const bool is_named =
        node.is_object() && std::find(keys.begin(), keys.end(), key) != keys.end();
    if (is_named && value.is_number()) {
      value = factor * value.get<double>();
    } else if (is_named && value.is_array()) {
      for (Json& entry : value) entry = factor * entry.get<double>();
    } else if (value.is_structured()) {
      scale(value, keys, factor);
    }
  }
}

std::string written(double value, const Unit& unit) {
  return fmt::format("{:.17g} {}", value / unit.size, unit.name);
}

void write_units(Json& node) {
  const std::string type = node.is_object() && node.contains("type") && node["type"].is_string()
                               ? node["type"].get<std::string>()
                               : "";
  for (auto& [key, value] : node.items()) {
    const Unit* unit = node.is_object() ? unit_of(key, type) : nullptr;
    if (unit && value.is_number()) {
      value = written(value.get<double>(), *unit);
    } else if (unit && value.is_array() && value[0].is_number()) {
      for (Json& entry : value) entry = written(entry.get<double>(), *unit);
    } else if (value.is_structured()) {
      write_units(value);
    }
  }
}

}  // namespace

RandomMechanism random_scene(unsigned seed) {
  return SceneMaker(seed).make();
}

RandomMechanism slowed(RandomMechanism scene, double factor) {
  Json& file = scene.file;
  scale(file, {"end_time", "step", "ramp", "times"}, 1.0 / factor);
  scale(file, {"speed", "frequency", "baumgarte"}, factor);
  scale(file, {"gravity", "amplitude", "values"}, factor * factor);
  scene.resonance_share *= factor;
  return scene;
}

bool is_planar(const Json& scene) {
  if (scene["scene"]["joints"].contains("guide") &&
      scene["scene"]["joints"]["guide"]["type"] == "prismatic") {
    return false;
  }
  const auto is_out = [](const Json& vector) { return vector[2].get<double>() != 0.0; };
  for (const auto& [name, joint] : scene["scene"]["joints"].items()) {
    if (joint["type"] == "spherical") return false;
  }
  if (scene["scene"].contains("gravity") && is_out(scene["scene"]["gravity"])) return false;
  return !scene["scene"].contains("loads") || !is_out(scene["scene"]["loads"]["push"]["direction"]);
}

Json rotated(const Json& scene, const Eigen::Matrix3d& rotation) {
  Json turned = scene;
  rotate(turned["scene"], rotation);
  return turned;
}

RandomMechanism suddenly_loaded(RandomMechanism scene, unsigned seed) {
  Dice dice(seed + 5555);
  Json& mechanism = scene.file["scene"];
  Json& simulation = scene.file["simulation"];
  simulation.erase("initial_state");
  if (dice.chance(0.4)) simulation["initial_state"] = "quasi-static";
  if (!mechanism.contains("gravity")) mechanism["gravity"] = {0.0, -scene.weight, 0.0};
  if (dice.chance(0.4)) scale(mechanism, {"stiffness"}, dice.decades(3, 100));
  if (!mechanism.contains("loads")) return scene;
  Json& value = mechanism["loads"]["push"]["value"];
  const double force = value.contains("values") ? value["values"][1].get<double>()
                                                : value["amplitude"].get<double>();
  const double end = simulation["end_time"], jump = dice.chance(0.5) ? 0.0 : dice.uniform(0.1, 0.6);
  value = {{"type", "table"},
           {"times", {-0.1 * end, jump * end}},
           {"values", {0.0, force}},
           {"interpolation", "step"}};
  return scene;
}

RandomMechanism with_half_the_step(RandomMechanism scene) {
  scale(scene.file["simulation"], {"step"}, 0.5);
  scale(scene.file["simulation"], {"baumgarte"}, 2.0);
  return scene;
}

Json nudged(const Json& scene, unsigned seed, double share) {
  Json other = scene;
  Dice dice(seed);
  nudge(other["scene"], share, dice);
  nudge(other["variables"], share, dice);
  return other;
}

Json renamed(const Json& scene) {
  std::vector<std::string> names = {"stuff"};
  for (const char* group : {"bodies", "joints", "loads"}) {
    if (!scene["scene"].contains(group)) continue;
    for (const auto& [name, value] : scene["scene"][group].items()) names.push_back(name);
  }
  for (const auto& [name, value] : scene["variables"].items()) names.push_back(name);
  return with_names(scene, names);
}

Json in_other_units(const Json& scene) {
  Json other = scene;
  write_units(other["scene"]);
  write_units(other["simulation"]);
  for (auto& [name, variable] : other["variables"].items()) {
    const bool is_area = name.size() > 5 && name.ends_with("_area");
    const Unit unit = is_area ? Unit{"cm^2", 1e-4} : Unit{"mm", 1e-3};
    for (const char* key : {"start", "lower", "upper"})
      variable[key] = written(variable[key].get<double>(), unit);
  }
  return other;
}

Json in_space(const Json& scene) {
  Json spatial = scene;
  spatial["effects"]["spatial_motion"] = "on";
  return spatial;
}

Eigen::Matrix3d general_rotation(unsigned seed) {
  Dice dice(seed + 7777);
  const Vector3d axis(dice.uniform(-1, 1), dice.uniform(-1, 1), dice.uniform(0.2, 1));
  return Eigen::AngleAxisd(dice.uniform(0.3, 3.0), axis.normalized()).toRotationMatrix();
}

ProblemFile read(const Json& scene) {
  static std::mutex one_at_a_time;  // the library of units knows no threads
  const std::lock_guard lock(one_at_a_time);
  return problem_from(scene.dump());
}

namespace {

constexpr int most_attempts = 6;
constexpr double largest_rotation = 0.2, aimed_rotation = 0.15;  ///< [rad]
constexpr double slow = 0.4;

}  // namespace

SimulatedScene simulated_scene(unsigned seed) {
  return simulated(random_scene(seed));
}

SimulatedScene simulated(RandomMechanism mechanism) {
  SimulatedScene scene;
  scene.mechanism = std::move(mechanism);
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    scene.problem = read(scene.mechanism.file);
    try {
      scene.analysis = analyze(scene.problem, start_design(scene.problem));
    } catch (const SimulationError& error) {
      scene.failure = error.what();
      scene.mechanism = with_half_the_step(slowed(scene.mechanism, slow));
      continue;
    }
    const Trajectory& trajectory = scene.analysis->trajectory;
    const double rotation = monitor(scene.analysis->model, trajectory).elastic_rotation;
    if (rotation > largest_rotation) {
      scene.failure = "bends too far";
      const double factor = std::max(slow, std::sqrt(aimed_rotation / rotation));
      scene.mechanism = slowed(scene.mechanism, factor);
    } else if (trajectory.split_steps > 0) {
      scene.failure = "needs other steps";
      scene.mechanism = with_half_the_step(scene.mechanism);
    } else {
      return scene;
    }
  }
  scene.analysis.reset();
  return scene;
}

Eigen::VectorXd magnitudes_of(const Analysis& analysis) {
  Eigen::VectorXd magnitudes = values_of(analysis).cwiseAbs();
  for (std::size_t i = 0; i < analysis.histories.size(); ++i) {
    const Eigen::MatrixXd& history = analysis.histories[i];
    if (history.size() == 0) continue;
    magnitudes(i) = history.cwiseAbs().maxCoeff();
  }
  return magnitudes;
}

Eigen::VectorXd start_values(const Json& scene) {
  const ProblemFile problem = read(scene);
  return values_of(*analyze(problem, start_design(problem)));
}

}  // namespace pleuel::test
