#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/beam/elastic_basis.hpp"
#include "core/effects/floating_frame_body.hpp"
#include "core/integration/simulate.hpp"
#include "core/joints/joint_term.hpp"
#include "core/model/model.hpp"
#include "sensitivity/direct.hpp"
#include "tests/support/places.hpp"

/// Mechanisms with published answers.
namespace {

using namespace pleuel;

RigidBody body_at(double x, double y, double mass, double inertia) {
  RigidBody body;
  body.at = {x, y, 0.0};
  body.mass = mass;
  body.inertia = {0.0, 0.0, inertia, 0.0, 0.0, 0.0};
  return body;
}

Joint joint(JointType type, const std::string& first, const std::string& second,
            const Eigen::Vector2d& at) {
  Joint result;
  result.name = first + "-" + second;
  result.type = type;
  result.bodies = {first, second};
  result.at = {at.x(), at.y(), 0.0};
  return result;
}

Joint revolute(const std::string& first, const std::string& second, const Eigen::Vector2d& at) {
  return joint(JointType::revolute, first, second, at);
}

/// Value of a function of the step at h → 0 by Richardson's step: the scheme is of second order.
template <class Function>
auto extrapolated(const Function& at, double h) {
  using Value = decltype(at(h));
  const Value coarse = at(h), fine = at(h / 2);
  return Value(fine + (fine - coarse) / 3.0);
}

SimulationOptions options_of(double end, double step) {
  SimulationOptions options{end, step, 0.8};
  options.newton_tolerance = 1e-12;
  return options;
}

// IFToMM benchmark A01: 1 kg at 1 m, from (−1, 0) at rest.

TEST(Pendulum, IsAfterFourPeriodsWhereTheEllipticFunctionsPutIt) {
  const auto end = [](double h) -> Eigen::Vector2d {
    Scene scene;
    scene.gravity = {0.0, -9.81, 0.0};
    scene.bodies = {{"mass", body_at(-1.0, 0.0, 1.0, 0.0)}};
    scene.joints = {revolute(ground_name, "mass", {0.0, 0.0})};
    Model model = build_model(scene, {}, {}, {});
    const Trajectory trajectory = simulate(model.mechanism, options_of(10.0, h));
    return trajectory.q.col(trajectory.steps()).head<2>();
  };
  const Eigen::Vector2d found = extrapolated(end, 1e-3);
  // Measured 1e-8 and 8e-10: what h⁴ leaves.
  EXPECT_NEAR(found.x(), -0.27508746257612, 1e-7);
  EXPECT_NEAR(found.y(), -0.96141920509912, 1e-8);
}

// IFToMM benchmark A02: N four-bars, links of 1 m and 1 kg.

struct FourBars {
  explicit FourBars(int count) {
    Scene scene;
    scene.gravity = {0.0, -9.81, 0.0};
    for (int i = 0; i <= count; ++i) {
      Body bar{"upright " + std::to_string(i), body_at(i, 0.5, 1.0, 1.0 / 12)};
      bar.velocity = {0.5, 0.0, 0.0};
      bar.angular_velocity = {0.0, 0.0, -1.0};
      scene.bodies.push_back(bar);
      scene.joints.push_back(revolute(ground_name, bar.name, {i, 0.0}));
    }
    for (int i = 0; i < count; ++i) {
      Body bar{"coupler " + std::to_string(i), body_at(i + 0.5, 1.0, 1.0, 1.0 / 12)};
      bar.velocity = {1.0, 0.0, 0.0};
      scene.bodies.push_back(bar);
      scene.joints.push_back(revolute("upright " + std::to_string(i), bar.name, {i, 1.0}));
      scene.joints.push_back(revolute("upright " + std::to_string(i + 1), bar.name, {i + 1, 1.0}));
    }
    model = build_model(scene, {}, {}, {});
  }
  /// Position and velocity of B0, the upper end of the first link.
  Eigen::Vector4d point_of(const Trajectory& trajectory, int step) const {
    const double x = trajectory.q(0, step), y = trajectory.q(1, step);  // its middle
    return {2 * x, 2 * y, 2 * trajectory.v(0, step), 2 * trajectory.v(1, step)};
  }
  Model model;
};

/// All links lie in a line some twenty times in 10 s, and could then go on as an
/// anti-parallelogram. No time step hits a singular position exactly, and near it inertia decides:
/// the scheme passes with every step that was tried (1e-2 … 3e-4 s), with an error of 46 … 56 h².
/// The reference is the motion of the one coordinate that the parallel linkage has, to 1e-12.
TEST(FourBarLinkage, PassesItsSingularPositions) {
  using Vector = Eigen::Matrix<double, 8, 1>;
  const auto at_1_and_10 = [](double h) {
    FourBars bars(2);
    const Trajectory trajectory = simulate(bars.model.mechanism, options_of(10.0, h));
    Vector result;
    result << bars.point_of(trajectory, trajectory.steps() / 10),
        bars.point_of(trajectory, trajectory.steps());
    return result;
  };
  const Vector found = extrapolated(at_1_and_10, 1e-3);
  // Measured: 2e-10 at 1 s, 2e-7 (position) and 4e-7 m/s at 10 s.
  EXPECT_NEAR(found(0), -0.195020301949, 2e-9);
  EXPECT_NEAR(found(1), -0.980799205662, 2e-9);
  EXPECT_NEAR(found(4), 0.328458111534, 2e-6);
  EXPECT_NEAR(found(5), 0.944518538181, 2e-6);
  EXPECT_NEAR(found(6), 1.423051470191, 4e-6);
  EXPECT_NEAR(found(7), -0.494868845469, 4e-6);
  for (double h : {1e-2, 4.1e-3}) {
    EXPECT_LE((at_1_and_10(h) - found).norm(), 300 * h * h) << "passes with h = " << h;
  }
}

/// It cannot start in one: which way it moves is not determined.
TEST(FourBarLinkage, DoesNotStartInASingularPosition) {
  Scene scene;
  scene.gravity = {0.0, -9.81, 0.0};
  scene.bodies = {{"left", body_at(0.5, 0.0, 1.0, 1.0 / 12)},
                  {"coupler", body_at(1.5, 0.0, 1.0, 1.0 / 12)},
                  {"right", body_at(1.5, 0.0, 1.0, 1.0 / 12)}};
  scene.joints = {revolute(ground_name, "left", {0.0, 0.0}),
                  revolute("left", "coupler", {1.0, 0.0}), revolute("right", "coupler", {2.0, 0.0}),
                  revolute(ground_name, "right", {1.0, 0.0})};
  Model model = build_model(scene, {}, {}, {});
  try {
    simulate(model.mechanism, options_of(1.0, 1e-3));
    FAIL() << "a singular start must not go unnoticed";
  } catch (const SimulationError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("constrain the same motion twice"));
  }
}

// Andrews' squeezer mechanism (IVP Test Set; IFToMM benchmark A03).

struct Squeezer {
  // beta, Theta, gamma, Phi, delta, Omega, epsilon at the start
  static constexpr std::array<double, 7> start = {-0.0617138900142764496, 0.0,
                                                  0.455279819163070380,   0.222668390165885885,
                                                  0.487364979543842550,   -0.222668390165885885,
                                                  1.23054744454982120};

  static Scene scene() {
    using Vector = Eigen::Vector2d;
    constexpr double d = 0.028, da = 0.0115, e = 0.02, ea = 0.01421, rr = 0.007, ra = 0.00092,
                     ss = 0.035, sa = 0.01874, sb = 0.01043, sc = 0.018, sd = 0.02, ta = 0.02308,
                     tb = 0.00916, u = 0.04, ua = 0.01228, ub = 0.00449, zf = 0.02, zt = 0.04,
                     fa = 0.01421;
    const Vector a(-0.06934, -0.00227), b(-0.03635, 0.03273), c(0.014, 0.072), origin(0.0, 0.0);
    const auto [beta, theta, gamma, phi, delta, omega, epsilon] = start;
    // Unit vectors along and across the links.
    const auto along = [](double angle) { return Vector(std::cos(angle), std::sin(angle)); };
    const auto across = [](double angle) { return Vector(std::sin(angle), -std::cos(angle)); };
    const Vector pin = rr * along(beta), knot = pin - d * along(beta + theta);
    const Vector left = a + zt * along(delta), lower = a + u * across(epsilon);
    EXPECT_LE((b + ss * across(gamma) - knot).norm(), 1e-15) << "the data close";
    const std::array<Vector, 7> centres = {ra * along(beta),
                                           pin - da * along(beta + theta),
                                           b + sa * across(gamma) + sb * along(gamma),
                                           left + (e - ea) * across(phi + delta),
                                           a + ta * along(delta) - tb * across(delta),
                                           lower + (zf - fa) * along(omega + epsilon),
                                           a + ua * across(epsilon) - ub * along(epsilon)};
    constexpr std::array<double, 7> mass = {0.04325, 0.00365, 0.02373, 0.00706,
                                            0.07050, 0.00706, 0.05498};
    constexpr std::array<double, 7> inertia = {2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7,
                                               1.169e-5, 5.667e-7, 1.912e-5};
    Scene scene;
    for (std::size_t i = 0; i < 7; ++i) {
      scene.bodies.push_back({"K" + std::to_string(i + 1),
                              body_at(centres[i].x(), centres[i].y(), mass[i], inertia[i])});
    }
    scene.joints = {revolute(ground_name, "K1", origin), revolute("K1", "K2", pin),
                    revolute("K2", "K3", knot),          revolute("K2", "K4", knot),
                    revolute("K2", "K6", knot),          revolute(ground_name, "K3", b),
                    revolute("K4", "K5", left),          revolute(ground_name, "K5", a),
                    revolute("K6", "K7", lower),         revolute(ground_name, "K7", a)};
    const Vector hook = b + sc * across(gamma) + sd * along(gamma);
    SpringDamper spring{{ground_name, "K3"},
                        {Point{c.x(), c.y(), 0.0}, Point{hook.x(), hook.y(), 0.0}},
                        4530.0,
                        0.0,
                        0.07785};
    PointTorque motor{"K1", {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {}, false};
    motor.value = ConstantFunction{0.033};
    scene.loads = {{"spring", spring}, {"motor", motor}};
    return scene;
  }

  /// The angles at the end from the turns of the bodies.
  static Eigen::VectorXd end(double time, double h) {
    Model model = build_model(scene(), {}, {}, {});
    SimulationOptions options = options_of(time, h);
    const Trajectory trajectory = simulate(model.mechanism, options);
    const auto turn = [&](const char* body) {
      return trajectory.q(model.body(body).frame.offset + 2, trajectory.steps());
    };
    Eigen::VectorXd q(7);
    q << turn("K1"), turn("K2") - turn("K1"), turn("K3"), turn("K4") - turn("K5"), turn("K5"),
        turn("K6") - turn("K7"), turn("K7");
    return q + Eigen::Map<const Eigen::VectorXd>(start.data(), 7);
  }
};

TEST(SqueezerMechanism, IsWhereTheTestSetPutsIt) {
  Eigen::VectorXd reference(7);
  reference << 15.81077119629904, -15.75637105984298, 0.04082224013073101, -0.5347301163226948,
      0.5244099658805304, 0.5347301163226948, 1.048080741042263;
  const Eigen::VectorXd found = extrapolated([](double h) { return Squeezer::end(0.03, h); }, 1e-5);
  // Measured 4e-8 of the angles that make two and a half turns, 5e-11 of the others. The reference
  // was computed with a tolerance of 1e-14.
  EXPECT_LE((found - reference).head(2).lpNorm<Eigen::Infinity>(), 4e-7);
  EXPECT_LE((found - reference).tail(5).lpNorm<Eigen::Infinity>(), 5e-10);
}

// The slider-crank of SUNDIALS' example idasSlCrank_FSA_dns, with sensitivities.

struct SpringSliderCrank {
  static Scene scene() {
    const double p = -std::numbers::pi / 6;  // sin p = −1/2
    const Eigen::Vector2d pin(0.0, 0.5), slider(std::cos(p), 0.0);
    Scene scene;
    scene.bodies = {{"crank", body_at(0.0, 0.0, 1.0, 1.0)},
                    {"rod", body_at(slider.x(), slider.y(), 1.0, 2.0)}};
    scene.joints = {revolute(ground_name, "crank", {0.0, 0.0}), revolute("crank", "rod", pin),
                    joint(JointType::point_on_line, ground_name, "rod", slider)};
    scene.joints[2].axis = {1.0, 0.0, 0.0};
    const Eigen::Vector2d middle = 0.5 * (pin + slider), far = 2.0 * slider - pin;
    SpringDamper spring{{"crank", "rod"},
                        {Point{0.0, 0.25, 0.0}, Point{middle.x(), middle.y(), 0.0}},
                        Number::bound(0),
                        Number::bound(1),
                        1.0};
    PointForce force{"rod", {far.x(), far.y(), 0.0}, {1.0, 0.0, 0.0}, {}, false};
    force.value = ConstantFunction{1.0};
    scene.loads = {{"spring", spring}, {"force", force}};
    return scene;
  }

  /// G = ∫ kinetic energy dt and its derivatives, by the trapezoidal rule.
  static Eigen::Vector3d values(double h) {
    const Design<double> design = {1.0, 1.0};
    Model model = build_model(scene(), {}, design, design);
    const Trajectory trajectory = simulate(model.mechanism, options_of(10.0, h));
    // Frames in the centres of mass: a constant mass matrix.
    Eigen::VectorXd mass(6);
    mass << 1.0, 1.0, 1.0, 1.0, 1.0, 2.0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    differentiate(model.mechanism, trajectory,
                  [&](int step, const State& state, const StateSensitivity& s) {
                    const bool is_end = step == 0 || step == trajectory.steps();
                    const Eigen::VectorXd momentum = mass.cwiseProduct(state.v);
                    Eigen::Vector3d now;
                    now << 0.5 * momentum.dot(state.v), s.v.transpose() * momentum;
                    sum += (is_end ? 0.5 : 1.0) * trajectory.scheme.step * now;
                  });
    return sum;
  }
};

TEST(SpringSliderCrank, HasTheIntegralAndTheGradientOfSundials) {
  const Eigen::Vector3d found = extrapolated(&SpringSliderCrank::values, 5e-3);
  // Converged: 3.33660680, 0.33344811, −0.36375403, the same to 4e-9 with twice the step. The
  // published numbers were computed with a tolerance of 1e-6 and differ by 4e-6 to 4e-5 of
  // themselves.
  EXPECT_NEAR(found(0), 3.33662, 3e-5);
  EXPECT_NEAR(found(1), 0.33346, 3e-5);
  EXPECT_NEAR(found(2), -0.36375, 1e-5);
  EXPECT_LE((extrapolated(&SpringSliderCrank::values, 1e-2) - found).norm(), 1e-7);
}

// The flexible slider-crank of the IVP Test Set (Simeon 1998): rigid crank, rod with two sine modes
// in bending and a quadratic axial displacement, no gravity, Ω = 150 rad/s.

namespace simeon {

constexpr double pi = std::numbers::pi;
constexpr double crank_length = 0.15, rod_length = 0.3, depth = 0.008, density = 7870.0;
constexpr double crank_inertia = 0.002727, slider_mass = 0.075552, speed = 150.0;

// At the start: q of the sines, of the axial displacement in the middle and at the end.
constexpr double q3 = 0.103339863e-4, q4 = 0.169327969e-4;
constexpr std::array<double, 4> rates = {0.444896105, 0.463434311e-2, -0.178591076e-5,
                                         -0.268938672e-5};
constexpr double rod_rate = -74.9957670;

/// The test set's problem as a scene with a rod of so many elements.
Scene scene(int elements) {
  Scene scene;
  scene.materials.push_back({"steel", 2e11, 0.3, density});
  BeamBody rod;
  rod.from = {crank_length, 0.0, 0.0};
  rod.to = {crank_length + rod_length, 0.0, 0.0};
  rod.material = "steel";
  rod.segments = {{RectangleSection{depth, depth}, elements, {}}};
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

/// Displacements of the modes: value and derivative along the rod at x.
struct Modes {
  std::array<double, 2> sine, slope;
  double middle, end;  ///< of the axial displacement
};
Modes modes_at(double x) {
  const double s = x / rod_length;
  Modes modes{};
  for (std::size_t k = 0; k < 2; ++k) {
    const double number = pi * static_cast<double>(k + 1);
    modes.sine[k] = std::sin(number * s);
    modes.slope[k] = number / rod_length * std::cos(number * s);
  }
  modes.middle = 4.0 * s * (1.0 - s);
  modes.end = s * (2.0 * s - 1.0);
  return modes;
}

/// Nodal displacements of the four modes in the coordinates of a chord frame, n × 4.
Eigen::MatrixXd basis_of(const BodyModel& rod) {
  Eigen::MatrixXd z = Eigen::MatrixXd::Zero(rod.coordinates->size(), 4);
  for (int node = 0; node < rod.coordinates->node_count(); ++node) {
    const Modes modes = modes_at(rod.beam.node_position(node));
    const auto set = [&](int displacement, int mode, double value) {
      const int row = rod.coordinates->index(node, displacement);
      if (row >= 0) z(row, mode) = value;
    };
    for (int k = 0; k < 2; ++k) {
      set(1, k, modes.sine[static_cast<std::size_t>(k)]);
      set(5, k, modes.slope[static_cast<std::size_t>(k)]);
    }
    set(0, 2, modes.middle);
    set(0, 3, modes.end);
  }
  return z;
}

const Eigen::Vector4d start_values(0.0, 0.0, q3, q4);
const Eigen::Vector4d start_rates(rates[0], rates[1], rates[2], rates[3]);

void set_start(const Model& model, Mechanism& mechanism, const Eigen::VectorXd& q,
               const Eigen::VectorXd& v) {
  State& guess = mechanism.guess;
  guess.v(model.body("crank").frame.offset + 2) = speed;
  const int rod = model.body("rod").frame.offset;
  guess.v(rod + 1) = speed * crank_length;
  guess.v(rod + 2) = rod_rate;
  guess.q.segment(rod + 3, q.size()) = q;
  guess.v.segment(rod + 3, v.size()) = v;
}

/// The test set's four elastic coordinates put together by hand from the terms of the code under
/// test: its rod has rigid rotary inertia (J₂ = m₂ l₂²/3 + m₂ h²/12), but none of the modes.
class FourModes {
 public:
  FourModes() {
    const Model model = build_model(scene(elements), {}, {}, {});
    const BodyModel& beam = model.body("rod");
    Invariants<double> modes = project_invariants(
        beam_invariants(beam.beam, *beam.coordinates, RotaryInertia::neglected), basis_of(beam));
    modes.second_moment(1, 1) += modes.mass * depth * depth / 12;
    add_body("crank", frame(crank, true), crank_invariants());
    add_body("rod", frame(rod, true), modes);
    add_body("slider", frame(slider, false), point_mass());
    add_joints();
    mechanism.system = std::make_unique<System>(coordinates, multipliers, 0, std::move(terms_));
    mechanism.scale.setConstant(coordinates, 0.45);
    mechanism.scale.segment(rod_modes, 4).setConstant(0.45e-3);
    mechanism.assembly_weight = mechanism.scale.cwiseAbs2().cwiseInverse();
    mechanism.guess_q_x.setZero(coordinates, 0);
    mechanism.guess_v_x.setZero(coordinates, 0);
    set_guess();
  }

  static constexpr int crank = 0, rod = 3, rod_modes = 6, slider = 10, coordinates = 12;
  static constexpr int drive_row = 2, guide_row = 7, multipliers = 8;
  Mechanism mechanism;

 private:
  static constexpr int elements = 200;  ///< linear axial shapes: an error of 2e-6 of q3, q4

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
  void add_body(const char* name, const BodyFrame& frame, const Invariants<double>& invariants) {
    terms_.push_back(std::make_unique<FloatingFrameBody>(
        name, frame, invariants, std::vector<DesignDerivative<Invariants<double>>>{},
        Eigen::Vector3d::Zero()));
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

/// φ2, x3, q1 … q4, φ̇2, λ1, λ3 at t = 0.1 s, consistent mass, recomputed independently with two
/// tolerances. (The published column has an axial mass without the factor 1/15 of a quadratic
/// element.)
const std::array<double, 9> reference = {
    -.331173430332826,   .169737395832603,  1.89308169318799e-4,
    2.37620108497718e-5, -5.28102475991e-6, -8.30355444483e-6,
    60.2531179600310,    -62.2052136559283, 24.9721849020498};

}  // namespace simeon

/// found/expected − 1 against a limit for each of the nine numbers.
void expect_near(const Eigen::VectorXd& found, const std::array<double, 9>& limits) {
  constexpr std::array names = {"phi2", "x3",    "q1",      "q2",     "q3",
                                "q4",   "phi2'", "lambda1", "lambda3"};
  for (std::size_t i = 0; i < 9; ++i) {
    const double value = found(static_cast<Eigen::Index>(i));
    EXPECT_NEAR(value / simeon::reference[i], 1.0, limits[i]) << names[i];
  }
}

/// In the test set's own coordinates it must come to the last digit: what is left at this step is
/// the phase of axial vibrations of 26 and 95 krad/s, which the start leaves, of 1 % of q3. Limits
/// are three times what was measured; with a quarter of the step q3 is right to 1e-5, λ to 2e-4.
TEST(FlexibleSliderCrank, WithFourModesIsThatOfTheTestSet) {
  using namespace simeon;
  FourModes rod;
  const Trajectory trajectory = simulate(rod.mechanism, options_of(0.1, 5e-7));
  State state;
  trajectory.load(trajectory.steps(), state);
  Eigen::VectorXd found(9);
  found << state.q(FourModes::rod + 2), state.q(FourModes::slider),
      state.q.segment(FourModes::rod_modes, 4), state.v(FourModes::rod + 2),
      state.lambda(FourModes::guide_row), state.lambda(FourModes::drive_row);
  expect_near(found, {1e-8, 2e-8, 3e-6, 1.5e-5, 1e-3, 4e-4, 1e-5, 6e-3, 2e-3});
}

/// A rod of elements has all modes. Its amplitudes of the two sines come close (its start excites
/// further modes, and axial vibrations of 1 … 2 % stay in q3, q4 and in forces); elastic rotary
/// inertia, which the test set has not, would change q1 by 1.3e-3. Measured times three.
TEST(FlexibleSliderCrank, WithElementsComesCloseToTheTestSet) {
  using namespace simeon;
  constexpr int elements = 16;
  EffectSettings effects;
  effects.geometric_stiffening = effects.rotary_inertia = EffectChoice::off;
  Model model = build_model(scene(elements), effects, {}, {});
  const BodyModel &rod = model.body("rod"), &slider = model.body("slider");
  const Eigen::MatrixXd z = basis_of(rod);
  set_start(model, model.mechanism, z * start_values, z * start_rates);
  model.mechanism.guess.q(slider.frame.offset) += q4;
  const Trajectory trajectory = simulate(model.mechanism, options_of(0.1, 5e-6));
  State state;
  trajectory.load(trajectory.steps(), state);
  Eigen::Vector2d sines = Eigen::Vector2d::Zero();  // (2/N) Σ vᵢ sin(kπ i/N)
  for (int node = 1; node < elements; ++node) {
    const Modes modes = modes_at(rod.beam.node_position(node));
    const double v = state.q(rod.coordinate(node, 1));
    for (int k = 0; k < 2; ++k)
      sines(k) += 2.0 / elements * v * modes.sine[static_cast<std::size_t>(k)];
  }
  Eigen::VectorXd found(9);
  found << state.q(rod.frame.offset + 2), state.q(slider.frame.offset), sines,
      deflection_at(rod, state, 0.5).x(), deflection_at(rod, state, 1.0).x(),
      state.v(rod.frame.offset + 2), state.lambda(model.joint("ground-slider").first_multiplier),
      state.lambda(model.joint("ground-crank").drive_row);
  expect_near(found, {5e-7, 1e-6, 1.2e-4, 9e-4, 2e-2, 2e-2, 3e-5, 5e-2, 1e-2});
}

}  // namespace
