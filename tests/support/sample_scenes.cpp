#include "tests/support/sample_scenes.hpp"

namespace {

using namespace pleuel;

class SceneWriter {
 public:
  /// A number bound to a new variable.
  Number variable(const std::string& name, double value) {
    sample.variables.push_back(name);
    sample.design.push_back(value);
    return Number::bound(static_cast<int>(sample.design.size()) - 1);
  }
  /// constant + factor · an existing variable
  static Number shifted(double constant, const Number& number, double factor = 1.0) {
    Number result = Number::bound(number.variable, factor * number.factor);
    result.constant = constant + factor * number.constant;
    return result;
  }
  Scene& scene() { return sample.scene; }

  SampleScene sample;
};

Joint joint(const std::string& name, JointType type, const std::string& first,
            const std::string& second, const Point& at, const std::array<double, 3>& axis) {
  Joint result;
  result.name = name;
  result.type = type;
  result.bodies = {first, second};
  result.at = at;
  result.axis = axis;
  return result;
}

BeamBody beam(const Point& from, const Point& to, std::vector<Segment> segments,
              ReferenceCondition frame) {
  BeamBody result;
  result.from = from;
  result.to = to;
  result.material = "steel";
  result.segments = std::move(segments);
  result.frame = frame;
  return result;
}

}  // namespace

SampleScene planar_sample() {
  SceneWriter write;
  write.sample.name = "Planar";
  Scene& scene = write.scene();
  scene.gravity = {1.0, -9.81, 0.0};
  // A soft and light material: bending, inertia and gravity are of comparable size.
  scene.materials.push_back({"steel", write.variable("young", 3e9), write.variable("poisson", 0.3),
                             write.variable("density", 2100.0)});
  const Number crank_x = write.variable("crank_x", 0.11), crank_y = write.variable("crank_y", 0.04);
  const Number reach = write.variable("slider_x", 0.33);
  const Number damping = write.variable("stiffness_damping", 2e-4);
  const Number mass_damping = write.variable("mass_damping", 3.0);
  const Number height = write.variable("crank_height", 0.02);
  const Number outer = write.variable("rod_diameter", 0.015);
  const Number wall = write.variable("rod_wall", 0.003);

  const Point origin = {0.01, 0.02, 0.0}, pin = {crank_x, crank_y, 0.0},
              slider = {reach, 0.02, 0.0};
  BeamBody crank =
      beam(origin, pin, {{RectangleSection{0.012, height}, 2, {}}}, ReferenceCondition::tangent);
  crank.damping = {mass_damping, damping};
  BeamBody rod =
      beam(pin, slider, {{CircleSection{outer}, 1, 0.4}, {TubeSection{outer, wall}, 2, {}}},
           ReferenceCondition::chord);
  rod.segments[1].fraction = 0.6;
  rod.damping = {0.0, damping};
  const Point block_at = {0.5, 0.1, 0.0};
  RigidBody block;
  block.at = block_at;
  block.mass = write.variable("block_mass", 0.4);
  block.inertia = {0.01, 0.02, write.variable("block_inertia", 0.015), 0.001, 0.0, 0.0};
  const Number arm_x = write.variable("arm_x", 0.62);
  const Point arm_from = {0.52, 0.13, 0.0}, arm_to = {arm_x, 0.21, 0.0};
  BeamBody arm = beam(arm_from, arm_to, {{RectangleSection{height, 0.01}, 2, {}}},
                      ReferenceCondition::tangent);
  scene.bodies = {{"crank", crank},
                  {"rod", rod},
                  {"slider", PointMass{slider, write.variable("slider_mass", 0.2)}},
                  {"block", block},
                  {"arm", arm}};

  Joint bearing = joint("bearing", JointType::revolute, ground_name, "crank", origin, {0, 0, 1});
  bearing.drive = RampToSpeedDrive{write.variable("speed", 30.0), write.variable("ramp", 0.05)};
  scene.joints = {
      bearing,
      joint("pin", JointType::revolute, "crank", "rod", pin, {0, 0, 1}),
      joint("slider_pin", JointType::revolute, "rod", "slider", slider, {0, 0, 1}),
      joint("guide", JointType::point_on_line, ground_name, "slider", slider, {1, 0, 0}),
      joint("slide", JointType::prismatic, ground_name, "block", block_at, {1, 0.3, 0}),
      joint("weld", JointType::fixed, "block", "arm", arm_from, {0, 0, 1})};
  scene.joints[4].axis = {0.8, 0.6, 0.0};
  return write.sample;
}

SampleScene smooth_planar_sample() {
  SampleScene sample = planar_sample();
  std::erase_if(sample.scene.bodies,
                [](const Body& b) { return b.name == "block" || b.name == "arm"; });
  std::erase_if(sample.scene.joints,
                [](const Joint& j) { return j.name == "slide" || j.name == "weld"; });
  sample.scene.gravity = {0.0, 0.0, 0.0};
  for (Body& body : sample.scene.bodies) {
    if (auto* beam = std::get_if<BeamBody>(&body.shape)) {
      for (Segment& segment : beam->segments) segment.elements = 1;
    }
  }
  return sample;
}

SampleScene planar_sample_in_space() {
  SampleScene sample = planar_sample();
  sample.name = "PlanarForcedIntoSpace";
  sample.effects.spatial_motion = EffectChoice::on;
  return sample;
}

SampleScene spatial_sample() {
  SceneWriter write;
  write.sample.name = "Spatial";
  Scene& scene = write.scene();
  scene.gravity = {1.0, -9.81, 3.0};
  scene.materials.push_back({"steel", write.variable("young", 3e9), write.variable("poisson", 0.3),
                             write.variable("density", 2100.0)});
  const Number crank_x = write.variable("crank_x", 0.11);
  const Number crank_z = write.variable("crank_z", 0.06);
  const Number width = write.variable("width", 0.013);
  const Number outer = write.variable("diameter", 0.016), wall = write.variable("wall", 0.003);
  const Number damping = write.variable("stiffness_damping", 2e-4);
  const Point origin = {0.01, 0.02, 0.03}, elbow = {crank_x, 0.05, crank_z};
  const Point hand = {0.21, write.variable("hand_y", 0.16), 0.12};
  BeamBody crank =
      beam(origin, elbow, {{RectangleSection{width, 0.02}, 2, {}}}, ReferenceCondition::tangent);
  crank.damping = {1.0, damping};
  BeamBody forearm =
      beam(elbow, hand, {{TubeSection{outer, wall}, 1, {}}}, ReferenceCondition::chord);
  forearm.damping = {0.0, damping};
  const Number block_y = write.variable("block_y", 0.1);
  const Point block_at = {0.5, block_y, -0.05}, hinge = {0.52, 0.13, -0.04};
  RigidBody block;
  block.at = block_at;
  block.mass = write.variable("block_mass", 0.4);
  block.inertia = {0.01, 0.02, write.variable("block_inertia", 0.015), 0.001, -0.002, 0.003};
  const Point bead = {0.6, 0.2, 0.02};
  BeamBody arm = beam(hinge, bead, {{CircleSection{outer}, 1, {}}}, ReferenceCondition::tangent);
  arm.reference = std::array{0.2, 0.1, 1.0};
  BeamBody stub = beam(hand, {0.25, 0.2, 0.2}, {{RectangleSection{width, 0.01}, 1, {}}},
                       ReferenceCondition::tangent);
  scene.bodies = {{"crank", crank}, {"forearm", forearm},
                  {"stub", stub},   {"block", block},
                  {"arm", arm},     {"bead", PointMass{bead, write.variable("bead_mass", 0.05)}}};
  Joint bearing =
      joint("bearing", JointType::revolute, ground_name, "crank", origin, {0.1, 0.2, 1});
  bearing.drive = ConstantSpeedDrive{write.variable("speed", 7.0)};
  Joint wrist = joint("wrist", JointType::revolute, "crank", "forearm", elbow, {0.3, 1, -0.2});
  wrist.drive = RampToSpeedDrive{write.variable("wrist_speed", -9.0), write.variable("ramp", 0.04)};
  scene.joints = {
      bearing,
      wrist,
      joint("weld", JointType::fixed, "forearm", "stub", hand, {0, 0, 1}),
      joint("slide", JointType::prismatic, ground_name, "block", block_at, {0.48, 0.6, 0.64}),
      joint("hinge", JointType::revolute, "block", "arm", hinge, {0.1, 0.9, 0.1}),
      joint("wire", JointType::point_on_line, "arm", "bead", bead, {0.2, -0.3, 1})};
  return write.sample;
}

namespace {

RigidBody rigid_body(const Point& at, const Number& mass) {
  RigidBody body;
  body.at = at;
  body.mass = mass;
  body.inertia = {0.011, 0.017, 0.014, 0.002, -0.001, 0.0015};
  return body;
}

/// Symmetric about the x–y plane.
RigidBody planar_body(const Point& at, const Number& mass, const Number& inertia) {
  RigidBody body;
  body.at = at;
  body.mass = mass;
  body.inertia = {0.01, 0.012, inertia, 0.002, 0.0, 0.0};
  return body;
}

Joint driven(Joint joint, const TimeFunction& motion,
             DrivenCoordinate coordinate = DrivenCoordinate::angle) {
  joint.drive = Drive(motion, coordinate);
  return joint;
}

Joint universal(Joint joint, const std::array<double, 3>& second_axis) {
  joint.second_axis = second_axis;
  return joint;
}

Joint distance(Joint joint, const Point& to) {
  joint.to = to;
  return joint;
}

}  // namespace

SampleScene spatial_joints_sample() {
  SceneWriter write;
  write.sample.name = "SpatialJoints";
  Scene& scene = write.scene();
  scene.gravity = {-2.0, -9.81, 1.0};
  scene.materials.push_back({"steel", write.variable("young", 3e9), 0.3, 2100.0});
  const Number tip_x = write.variable("tip_x", 0.32), tip_y = write.variable("tip_y", 0.14);
  const Point root = {0.12, 0.04, 0.03}, tip = {tip_x, tip_y, 0.10};
  // A third of the way: in the first of the two elements.
  const Point between = {SceneWriter::shifted(0.08, tip_x, 1.0 / 3.0),
                         SceneWriter::shifted(0.08 / 3.0, tip_y, 1.0 / 3.0), 0.16 / 3.0};
  BeamBody boom = beam(root, tip, {{CircleSection{write.variable("diameter", 0.016)}, 2, {}}},
                       ReferenceCondition::chord);
  boom.damping = {2.0, 1e-4};
  const Number mass = write.variable("block_mass", 0.3);
  const Point block_at = {0.36, 0.2, 0.12}, stub_at = {0.2, 0.13, 0.09};
  const Point plate_at = {write.variable("plate_x", 0.5), 0.05, -0.1}, piston_at = {0.1, -0.2, 0.1};
  Body plate{"plate", rigid_body(plate_at, 0.5)};
  plate.velocity = {write.variable("plate_speed", 0.4), 0.1, -0.2};
  plate.angular_velocity = {0.3, write.variable("plate_spin", 1.2), -0.5};
  scene.bodies = {{"carrier", rigid_body({0.1, 0.02, 0.05}, 0.6)},
                  {"boom", boom},
                  {"block", rigid_body(block_at, mass)},
                  {"stub", rigid_body(stub_at, 0.08)},
                  plate,
                  {"piston", rigid_body(piston_at, 0.2)}};

  const auto moves = DrivenCoordinate::displacement;
  scene.joints = {
      driven(joint("sleeve", JointType::cylindrical, ground_name, "carrier", {0.1, 0.03, 0.02},
                   {0.48, 0.6, 0.64}),
             HarmonicFunction{write.variable("stroke", 0.03), write.variable("frequency", 15.0),
                              0.0, 0.0},
             moves),
      driven(
          universal(joint("cardan", JointType::universal, "carrier", "boom", root, {0.6, 0.0, 0.8}),
                    {0.8, 0.0, -0.6}),
          PolynomialFunction{{0.0, write.variable("turn", 2.0), -5.0}}),
      joint("ball", JointType::spherical, "boom", "block", tip, {0, 0, 1}),
      joint("pin", JointType::revolute, "boom", "stub", between, {0.2, 1.0, -0.4}),
      joint("floor", JointType::planar, ground_name, "plate", {0.48, 0.06, -0.12}, {0.1, 1.0, 0.2}),
      driven(distance(joint("tie", JointType::distance, "boom", "block",
                            {SceneWriter::shifted(0.04, tip_x, 2.0 / 3.0),
                             SceneWriter::shifted(0.04 / 3.0, tip_y, 2.0 / 3.0), 0.23 / 3.0},
                            {0, 0, 1}),
                      {0.38, write.variable("tie_y", 0.24), 0.15}),
             PolynomialFunction{{0.0, 0.1, write.variable("tie_growth", -1.5)}}, moves),
      joint("guide", JointType::prismatic, ground_name, "piston", piston_at, {1, 0.4, -0.2})};

  JointForce hinge_spring{"pin",
                          DrivenCoordinate::angle,
                          write.variable("pin_stiffness", 0.7),
                          write.variable("pin_damping", 0.01),
                          0.2,
                          {}};
  hinge_spring.motor = TableFunction{{0.0, 0.02, 0.05}, {0.1, write.variable("motor", 0.3), -0.2}};
  JointForce buffer{"guide", moves, 300.0, 2.0, write.variable("buffer_rest", 0.01), {}};
  buffer.motor = ConstantFunction{write.variable("push", 1.5)};
  // About the axis of a joint that is driven along it, and about that of a universal one.
  JointForce twist{"sleeve", DrivenCoordinate::angle, 0.5, 0.02, 0.0, {}};
  JointForce cardan_friction{"cardan", DrivenCoordinate::angle, 0.4, 0.05, 0.1, {}};
  PointForce wind{"boom", tip, {0.6, -0.8, 0.0}, {}, false};
  wind.value =
      HarmonicFunction{write.variable("wind", 2.0), 20.0, write.variable("phase", 0.4), 0.5};
  PointForce jet{"boom", between, {0.0, 0.6, 0.8}, {}, true};
  jet.value = RampToSpeedDrive{write.variable("jet", 30.0), 0.04};
  PointTorque couple{"boom", between, {0.6, 0.0, 0.8}, {}, false};
  couple.value = PolynomialFunction{{0.05, write.variable("couple", 1.0)}};
  PointTorque rotor{"block", block_at, {0.0, 1.0, 0.0}, {}, true};
  rotor.value = ConstantFunction{0.07};
  SpringDamper string{{"boom", "plate"},
                      {between, plate_at},
                      write.variable("string", 40.0),
                      write.variable("string_damping", 0.5),
                      write.variable("string_length", 0.3)};
  SpringDamper stay{{ground_name, "stub"}, {Point{0.3, 0.4, 0.2}, stub_at}, 25.0, 0.2, {}};
  scene.loads = {{"hinge spring", hinge_spring},
                 {"buffer", buffer},
                 {"twist", twist},
                 {"cardan friction", cardan_friction},
                 {"wind", wind},
                 {"jet", jet},
                 {"couple", couple},
                 {"rotor", rotor},
                 {"string", string},
                 {"stay", stay}};
  return write.sample;
}

SampleScene planar_joints_sample() {
  SceneWriter write;
  write.sample.name = "PlanarJoints";
  Scene& scene = write.scene();
  scene.gravity = {0.5, -9.81, 0.0};
  scene.materials.push_back({"steel", write.variable("young", 3e9), 0.3, 2100.0});
  const Number end_x = write.variable("end_x", 0.36), inertia = write.variable("inertia", 0.002);
  const Point start = {0.15, 0.1, 0.0}, end = {end_x, 0.13, 0.0};
  const Point between = {SceneWriter::shifted(0.105, end_x, 0.3), 0.109, 0.0};
  const Point ram_at = {0.3, write.variable("ram_y", 0.015), 0.0}, fork_at = {0.38, 0.16, 0.0};
  const Point puck_at = {0.42, 0.2, 0.0}, ball_at = {0.22, 0.17, 0.0};
  const Point sled_from = {0.5, 0.0, 0.0}, sled_to = {write.variable("sled_x", 0.6), 0.03, 0.0};
  BeamBody sled = beam(sled_from, sled_to, {{RectangleSection{0.01, 0.015}, 1, {}}},
                       ReferenceCondition::tangent_end);
  const Number drone_x = write.variable("drone_x", 0.3);
  const Point drone_at = {drone_x, 0.4, 0.0}, piston_at = {0.1, -0.2, 0.0};
  Body drone{"drone", planar_body(drone_at, 0.3, inertia)};
  drone.velocity = {0.2, write.variable("drone_speed", -0.3), 0.0};
  drone.angular_velocity = {0.0, 0.0, 0.7};
  Body flap{"flap", planar_body({0.55, 0.08, 0.0}, 0.05, 1e-4)};
  flap.angular_velocity = {0.0, 0.0, write.variable("flap_spin", 2.0)};
  scene.bodies = {{"wheel", planar_body({0.1, 0.05, 0.0}, 0.4, inertia)},
                  {"ram", planar_body(ram_at, write.variable("ram_mass", 0.3), 0.003)},
                  {"link", beam(start, end, {{RectangleSection{0.012, 0.014}, 2, {}}},
                                ReferenceCondition::chord)},
                  {"fork", planar_body(fork_at, 0.1, 5e-4)},
                  {"puck", planar_body(puck_at, 0.15, 7e-4)},
                  {"ball", planar_body(ball_at, 0.12, 3e-4)},
                  {"sled", sled},
                  {"bead", PointMass{sled_to, 0.05}},
                  drone,
                  {"piston", planar_body(piston_at, 0.2, 0.001)},
                  flap};

  const auto moves = DrivenCoordinate::displacement;
  scene.joints = {
      // The first axis, against +z, decides the normal of the plane.
      joint("flap hinge", JointType::revolute, "sled", "flap", sled_from, {0, 0, -1}),
      driven(
          joint("hub", JointType::cylindrical, ground_name, "wheel", {0.08, 0.05, 0.0}, {0, 0, 1}),
          HarmonicFunction{write.variable("swing", 0.5), 12.0, 0.0, 0.0}),
      driven(joint("ram guide", JointType::cylindrical, ground_name, "ram", {0.3, 0.02, 0.0},
                   {0.6, 0.8, 0}),
             PolynomialFunction{{0.0, 0.4, write.variable("ram_push", 3.0)}}, moves),
      universal(joint("link root", JointType::universal, "wheel", "link", start, {0, 0, 1}),
                {1, 0, 0}),
      universal(joint("link end", JointType::universal, "link", "fork", end, {1, 0, 0}), {0, 0, 1}),
      universal(joint("neck", JointType::universal, "fork", "puck", fork_at, {0.6, 0.8, 0.0}),
                {-0.8, 0.6, 0.0}),
      joint("socket", JointType::spherical, "link", "ball", between, {0, 0, 1}),
      driven(distance(joint("tie", JointType::distance, "ball", "ram", ball_at, {0, 0, 1}), ram_at),
             PolynomialFunction{{0.0, -0.1, 1.0}}, moves),
      joint("rail", JointType::planar, ground_name, "sled", sled_from, {0, 1, 0}),
      driven(joint("wire", JointType::point_on_line, "sled", "bead", sled_to, {0.96, 0.28, 0}),
             RampToSpeedDrive{write.variable("bead_speed", 0.5), 0.05}, moves),
      driven(joint("table", JointType::planar, ground_name, "drone", drone_at, {0, 0, 1}),
             TableFunction{{0.0, 0.02, 0.05}, {0.0, write.variable("drone_turn", 0.02), 0.05}}),
      joint("guide", JointType::prismatic, ground_name, "piston", piston_at, {0.8, -0.6, 0})};

  JointForce flap_spring{
      "flap hinge", DrivenCoordinate::angle, write.variable("flap_stiffness", 0.3), 0.002, 0.1, {}};
  flap_spring.motor = HarmonicFunction{write.variable("flap_motor", 0.05), 20.0, 0.3, 0.0};
  JointForce hub_friction{"hub", DrivenCoordinate::angle, 0.2, 0.03, 0.0, {}};
  JointForce buffer{"guide", moves, 300.0, 2.0, write.variable("buffer_rest", 0.01), {}};
  PointForce push{"link", between, {0.6, 0.8, 0.0}, {}, true};
  push.value = ConstantFunction{write.variable("push", 1.2)};
  PointForce lift{"drone", drone_at, {0.0, 1.0, 0.0}, {}, false};
  lift.value = HarmonicFunction{1.0, 10.0, 0.2, 3.0};
  PointTorque couple{"link", between, {0.0, 0.0, -1.0}, {}, false};
  couple.value = PolynomialFunction{{0.01, write.variable("couple", 0.5)}};
  SpringDamper string{
      {"link", "drone"}, {between, drone_at}, write.variable("string", 30.0), 0.3, {}};
  scene.loads = {{"flap spring", flap_spring},
                 {"hub friction", hub_friction},
                 {"buffer", buffer},
                 {"push", push},
                 {"lift", lift},
                 {"couple", couple},
                 {"string", string}};
  return write.sample;
}

SampleScene reduced_sample() {
  SceneWriter write;
  write.sample.name = "Reduced";
  Scene& scene = write.scene();
  scene.gravity = {0.0, -9.81, 0.0};
  scene.materials.push_back({"steel", write.variable("young", 3e9), write.variable("poisson", 0.3),
                             write.variable("density", 2100.0)});
  const Number diameter = write.variable("diameter", 0.014), width = write.variable("width", 0.011);
  const Number pin_x = write.variable("pin_x", 0.09), pin_y = write.variable("pin_y", 0.07);
  const Number reach = write.variable("slider_x", 0.32);
  const Number ratio = write.variable("damping_ratio", 0.03);
  const Point origin = {0.0, 0.0, 0.0}, pin = {pin_x, pin_y, 0.0}, slider_from = {reach, 0.0, 0.0};
  const Point slider_to = {SceneWriter::shifted(0.05, reach), 0.0, 0.0};
  const Point flag_to = {SceneWriter::shifted(0.05, reach), write.variable("flag_y", 0.12), 0.0};
  // 0.3 of the way along the rod: in the second of its four elements.
  Point between = pin;
  between[0] = Number::bound(pin_x.variable, 0.7);
  between[0].constant = 0.3 * 0.32;
  between[1] = SceneWriter::shifted(0.0, pin_y, 0.7);
  BeamBody crank =
      beam(origin, pin, {{CircleSection{diameter}, 3, {}}}, ReferenceCondition::tangent);
  crank.reduction = CraigBampton{3, {}};
  crank.damping.modal = ratio;
  BeamBody rod = beam(pin, slider_from, {{RectangleSection{width, 0.012}, 4, {}}},
                      ReferenceCondition::mean_axis);
  rod.reduction = CraigBampton{1, {}};
  rod.damping.modal = ratio;
  BeamBody slider = beam(slider_from, slider_to, {{RectangleSection{0.02, width}, 1, {}}},
                         ReferenceCondition::chord);
  slider.is_rigid = true;
  BeamBody flag =
      beam(slider_to, flag_to, {{CircleSection{diameter}, 2, {}}}, ReferenceCondition::tangent_end);
  flag.reduction = CraigBampton{{}, 2e4};
  flag.damping = {1.0, 1e-4};
  const Number arm_x = write.variable("arm_x", 0.3);
  const Point arm_from = {0.1, -0.15, 0.0}, arm_to = {arm_x, -0.1, 0.0};
  const Point arm_hinge = {SceneWriter::shifted(0.075, arm_x, 0.25), -0.1375, 0.0};
  BeamBody arm_beam =
      beam(arm_from, arm_to, {{CircleSection{diameter}, 2, {}}}, ReferenceCondition::mean_axis);
  arm_beam.damping = {0.0, 1e-4};
  Body arm{"arm", arm_beam};
  arm.angular_velocity = {0.0, 0.0, write.variable("arm_spin", 1.5)};
  scene.bodies = {{"crank", crank}, {"rod", rod}, {"slider", slider}, {"flag", flag}, arm};
  scene.joints = {
      driven(joint("bearing", JointType::revolute, ground_name, "crank", origin, {0, 0, 1}),
             RampToSpeedDrive{write.variable("speed", 30.0), 0.05}),
      // In space frames alone can close the loop: what the assembly does to elastic coordinates
      // depends on the basis.
      universal(joint("pin", JointType::universal, "crank", "rod", pin, {0, 0, 1}), {0, 1, 0}),
      joint("slider pin", JointType::spherical, "rod", "slider", slider_from, {0, 0, 1}),
      joint("guide", JointType::prismatic, ground_name, "slider", slider_from, {1, 0, 0}),
      joint("weld", JointType::fixed, "slider", "flag", slider_to, {0, 0, 1}),
      joint("hinge", JointType::revolute, ground_name, "arm", arm_hinge, {0, 0, 1})};
  PointForce wind{"flag", flag_to, {1.0, 0.0, 0.0}, {}, false};
  wind.value = HarmonicFunction{write.variable("wind", 1.0), 30.0, 0.2, 0.0};
  SpringDamper string{{"rod", "arm"}, {between, arm_to}, write.variable("string", 50.0), 0.4, {}};
  JointForce hinge_spring{"hinge", DrivenCoordinate::angle, 1.0, 0.01, 0.05, {}};
  scene.loads = {{"wind", wind}, {"string", string}, {"hinge spring", hinge_spring}};
  return write.sample;
}

SampleScene reduced_sample_in_space() {
  SampleScene sample = reduced_sample();
  sample.name = "ReducedForcedIntoSpace";
  sample.effects.spatial_motion = EffectChoice::on;
  return sample;
}

std::vector<SampleScene> all_samples() {
  return {planar_sample(),          planar_sample_in_space(), spatial_sample(),
          spatial_joints_sample(),  planar_joints_sample(),   reduced_sample(),
          reduced_sample_in_space()};
}

Scene swinging_beam(double length, const Section& section, int elements) {
  Scene scene;
  scene.gravity = {0.0, -9.81, 0.0};
  scene.materials.push_back({"steel", 2.1e11, 0.3, 7850.0});
  scene.bodies = {{"beam", beam({0.0, 0.0, 0.0}, {length, 0.0, 0.0}, {{section, elements, {}}},
                                ReferenceCondition::tangent)}};
  scene.joints = {
      joint("bearing", JointType::revolute, ground_name, "beam", {0.0, 0.0, 0.0}, {0, 0, 1})};
  return scene;
}
