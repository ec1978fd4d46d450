#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "core/beam/elastic_basis.hpp"
#include "core/effects/floating_frame_body.hpp"
#include "core/joints/joint_term.hpp"
#include "core/model/model.hpp"
#include "tests/support/sample_parts.hpp"

/// The flexible slider-crank of the IVP Test Set (Simeon 1998): rigid crank, rod with two sine
/// modes in bending and a quadratic axial displacement, no gravity, Ω = 150 rad/s.
namespace simeon {

using namespace pleuel;

inline constexpr double crank_length = 0.15, rod_length = 0.3, width = 0.008;
inline constexpr double crank_inertia = 0.002727, slider_mass = 0.075552, speed = 150.0;

/// Design variables, all of the rod: Young's modulus [Pa], density [kg/m³], height [m].
enum Variable { young, density, height };
inline constexpr int variables = 3;
inline const Design<double> design = {2e11, 7870.0, 0.008};

// At the start: q of the sines, of the axial displacement in the middle and at the end.
inline constexpr double q3 = 0.103339863e-4, q4 = 0.169327969e-4;
inline constexpr std::array<double, 4> rates = {0.444896105, 0.463434311e-2, -0.178591076e-5,
                                                -0.268938672e-5};
inline constexpr double rod_rate = -74.9957670;
inline const Eigen::Vector4d start_values(0.0, 0.0, q3, q4);
inline const Eigen::Vector4d start_rates(rates[0], rates[1], rates[2], rates[3]);

/// The test set's problem as a scene with a rod of so many elements.
inline Scene scene(int elements) {
  Scene scene;
  scene.materials.push_back({"steel", Number::bound(young), 0.3, Number::bound(density)});
  BeamBody rod;
  rod.from = {crank_length, 0.0, 0.0};
  rod.to = {crank_length + rod_length, 0.0, 0.0};
  rod.material = "steel";
  rod.segments = {{RectangleSection{width, Number::bound(height)}, elements, {}}};
  rod.frame = ReferenceCondition::chord;
  const Eigen::Vector2d origin(0.0, 0.0), pin(crank_length, 0.0), end(crank_length + rod_length, 0);
  scene.bodies = {{"crank", body_at(0.0, 0.0, 0.36, crank_inertia)},
                  {"rod", rod},
                  {"slider", PointMass{{end.x(), 0.0, 0.0}, slider_mass}}};
  scene.joints = {revolute(ground_name, "crank", origin), revolute("crank", "rod", pin),
                  revolute("rod", "slider", end),
                  joint(JointType::point_on_line, ground_name, "slider", end)};
  scene.joints[0].drive = ConstantSpeedDrive{speed};
  scene.joints[3].axis = {1.0, 0.0, 0.0};
  return scene;
}

/// Of that scene: linear elasticity, and a rod whose elastic displacements have no rotary inertia.
inline Model build(int elements) {
  EffectSettings effects;
  effects.geometric_stiffening = effects.rotary_inertia = EffectChoice::off;
  return build_model(scene(elements), effects, design, design);
}

/// Displacements of the modes: value and derivative along the rod at x.
struct Modes {
  std::array<double, 2> sine, slope;
  double middle, end;  ///< of the axial displacement
};
inline Modes modes_at(double x) {
  const double s = x / rod_length;
  Modes modes{};
  for (std::size_t k = 0; k < 2; ++k) {
    const double number = std::numbers::pi * static_cast<double>(k + 1);
    modes.sine[k] = std::sin(number * s);
    modes.slope[k] = number / rod_length * std::cos(number * s);
  }
  modes.middle = 4.0 * s * (1.0 - s);
  modes.end = s * (2.0 * s - 1.0);
  return modes;
}

/// Nodal displacements of the four modes in the coordinates of a chord frame, n × 4.
inline Eigen::MatrixXd basis_of(const BodyModel& rod) {
  Eigen::MatrixXd z = Eigen::MatrixXd::Zero(rod.coordinates.size(), 4);
  for (int node = 0; node < rod.coordinates.node_count(); ++node) {
    const Modes modes = modes_at(rod.beam.node_position(node));
    const auto set = [&](int displacement, int mode, double value) {
      const int row = rod.coordinates.index(node, displacement);
      if (row >= 0) z(row, mode) = value;
    };
    for (int k = 0; k < 2; ++k) {
      set(1, k, modes.sine[k]);
      set(5, k, modes.slope[k]);
    }
    set(0, 2, modes.middle);
    set(0, 3, modes.end);
  }
  return z;
}

/// Invariants and their derivatives.
struct DesignedInvariants {
  Invariants<double> value;
  std::vector<DesignDerivative<Invariants<double>>> derivatives;
};

/// Those of the rod in the four modes, as the beam's elements have them. The test set gives the rod
/// as a whole the rotary inertia of its sections: J₂ = m₂ l₂²/3 + m₂ h²/12.
inline DesignedInvariants invariants_of_elements(int elements) {
  const Model model = build(elements);
  const BodyModel& rod = model.body("rod");
  const Eigen::MatrixXd basis = basis_of(rod);
  const double h = design[height];
  DesignedInvariants result{project_invariants(rod.invariants, basis), {}};
  result.value.second_moment(1, 1) += result.value.mass * h * h / 12;
  for (const auto& [variable, change] : rod.invariants_x) {
    Invariants<double> derivative = project_invariants(change, basis);
    derivative.second_moment(1, 1) += derivative.mass * h * h / 12;
    if (variable == height) derivative.second_moment(1, 1) += result.value.mass * h / 6;
    result.derivatives.push_back({variable, std::move(derivative)});
  }
  return result;
}

/// Value without its error of second order, from one of half as many elements.
inline Invariants<double> extrapolated(const Invariants<double>& coarse,
                                       const Invariants<double>& fine) {
  Invariants<double> result = fine;
  const auto improve = [](auto& best, const auto& less) { best += (best - less) / 3.0; };
  improve(result.mass, coarse.mass);
  improve(result.first_moment, coarse.first_moment);
  improve(result.second_moment, coarse.second_moment);
  improve(result.shape, coarse.shape);
  improve(result.mixed, coarse.mixed);
  improve(result.moments, coarse.moments);
  improve(result.mass_matrix, coarse.mass_matrix);
  improve(result.stiffness, coarse.stiffness);
  return result;
}

/// Elements bend like cubics, but stretch linearly: the quadratic axial displacement of 200 of them
/// has an error of (1/200)², 1e-5 of a frequency and 0.03 rad of an axial vibration in 0.1 s.
/// Extrapolated, what is left is 1e-8.
inline DesignedInvariants invariants_of_modes() {
  const DesignedInvariants coarse = invariants_of_elements(100), fine = invariants_of_elements(200);
  DesignedInvariants result{extrapolated(coarse.value, fine.value), {}};
  for (std::size_t i = 0; i < fine.derivatives.size(); ++i) {
    const auto& [variable, change] = fine.derivatives[i];
    result.derivatives.push_back({variable, extrapolated(coarse.derivatives[i].data, change)});
  }
  return result;
}

/// The test set's four elastic coordinates put together by hand from the terms of the code under
/// test.
class FourModes {
 public:
  FourModes() {
    add_body("crank", frame(crank, true), {crank_invariants(), {}});
    add_body("rod", frame(rod, true), invariants_of_modes());
    add_body("slider", frame(slider, false), {point_mass(), {}});
    add_joints();
    mechanism.system =
        std::make_unique<System>(coordinates, multipliers, variables, std::move(terms_));
    mechanism.scale.setConstant(coordinates, 0.45);
    mechanism.scale.segment(rod_modes, 4).setConstant(0.45e-3);
    mechanism.assembly_weight = mechanism.scale.cwiseAbs2().cwiseInverse();
    mechanism.guess_q_x.setZero(coordinates, variables);
    mechanism.guess_v_x.setZero(coordinates, variables);
    set_guess();
  }

  static constexpr int crank = 0, rod = 3, rod_modes = 6, slider = 10, coordinates = 12;
  static constexpr int drive_row = 2, guide_row = 7, multipliers = 8;
  Mechanism mechanism;

 private:
  static BodyFrame frame(int offset, bool turns) {
    BodyFrame frame;
    frame.offset = offset;
    frame.basis = Eigen::Matrix3d::Identity().leftCols(2);
    if (turns) frame.rotation = RotationCoordinates::angle;
    return frame;
  }
  static Invariants<double> crank_invariants() {
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
    second(0, 0) = crank_inertia;
    return rigid_invariants<double>(0.36, Eigen::Vector3d::Zero(), second);
  }
  static Invariants<double> point_mass() {
    return rigid_invariants<double>(slider_mass, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero());
  }
  void add_body(const char* name, const BodyFrame& frame, const DesignedInvariants& invariants) {
    terms_.push_back(std::make_unique<FloatingFrameBody>(
        name, frame, invariants.value, invariants.derivatives, Eigen::Vector3d::Zero()));
  }

  void add_point(const Marker& first, const Eigen::Vector3d& on_first, const Marker& second,
                 const Eigen::Vector3d& on_second, int row, bool is_driven = false) {
    JointTopology topology;
    topology.markers = {first, second};
    topology.multiplier = coordinates + row;
    topology.is_driven = is_driven;
    for (int i = 0; i < 2; ++i) {
      JointEquation equation{EquationKind::coincident};
      equation.fixed = Eigen::Vector3d::Unit(i);
      topology.equations.push_back(equation);
    }
    JointData<double> data;
    data.points = {on_first, on_second};
    if (is_driven) {
      JointEquation equation{EquationKind::planar_angle};
      equation.is_driven = true;
      topology.equations.push_back(equation);
      data.drive.parameters = {0.0, speed};
    }
    terms_.push_back(make_joint_term(topology, data, {}));
  }
  void add_joints() {
    const Eigen::Vector3d zero = Eigen::Vector3d::Zero(), x = Eigen::Vector3d::UnitX();
    Marker ground, end;
    ground.frame = ground_frame();
    const Marker on_crank{frame(crank, true)}, on_rod{frame(rod, true)},
        on_slider{frame(slider, false)};
    end.frame = frame(rod, true);
    end.elastic[0] = rod_modes + 3;
    add_point(ground, zero, on_crank, zero, 0, true);
    add_point(on_crank, crank_length * x, on_rod, zero, 3);
    add_point(end, rod_length * x, on_slider, zero, 5);
    JointTopology guide;
    guide.markers = {ground, on_slider};
    guide.multiplier = coordinates + guide_row;
    JointEquation equation{EquationKind::on_plane};
    equation.first = 0;
    guide.equations = {equation};
    JointData<double> data;
    data.points = {zero, zero};
    data.directions = {Eigen::Vector3d::UnitY()};
    terms_.push_back(make_joint_term(guide, data, {}));
  }
  void set_guess() {
    State& guess = mechanism.guess = State(coordinates, multipliers);
    guess.q << 0.0, 0.0, 0.0, crank_length, 0.0, 0.0, start_values, crank_length + rod_length + q4,
        0.0;
    guess.v << 0.0, 0.0, speed, 0.0, speed * crank_length, rod_rate, start_rates, rates[3], 0.0;
  }

  std::vector<std::unique_ptr<Term>> terms_;
};

}  // namespace simeon
