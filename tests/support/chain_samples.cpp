#include "tests/support/sample_parts.hpp"

using namespace sample_parts;

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
  RigidBody body{.at = at, .mass = mass, .inertia = {0.011, 0.017, 0.014, 0.002, -0.001, 0.0015}};
  return body;
}

/// Symmetric about the x–y plane.
RigidBody planar_body(const Point& at, const Number& mass, const Number& inertia) {
  RigidBody body{.at = at, .mass = mass, .inertia = {0.012, 0.012, inertia, 4e-5, 0.0, 0.0}};
  return body;
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
  // A third of the way: there the first of the two elements is divided.
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
  PointLoad wind{LoadKind::force, "boom", tip, {0.6, -0.8, 0.0}, {}, false};
  wind.value =
      HarmonicFunction{write.variable("wind", 2.0), 20.0, write.variable("phase", 0.4), 0.5};
  PointLoad jet{LoadKind::force, "boom", between, {0.0, 0.6, 0.8}, {}, true};
  jet.value = RampToSpeedDrive{write.variable("jet", 30.0), 0.04};
  PointLoad couple{LoadKind::torque, "boom", between, {0.6, 0.0, 0.8}, {}, false};
  couple.value = PolynomialFunction{{0.05, write.variable("couple", 1.0)}};
  PointLoad rotor{LoadKind::torque, "block", block_at, {0.0, 1.0, 0.0}, {}, true};
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
  // In the first of the two elements, too near its end for a node of its own.
  const Point between = {SceneWriter::shifted(0.07515, end_x, 0.499), 0.11497, 0.0};
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
  PointLoad push{LoadKind::force, "link", between, {0.6, 0.8, 0.0}, {}, true};
  push.value = ConstantFunction{write.variable("push", 1.2)};
  PointLoad lift{LoadKind::force, "drone", drone_at, {0.0, 1.0, 0.0}, {}, false};
  lift.value = HarmonicFunction{1.0, 10.0, 0.2, 3.0};
  PointLoad couple{LoadKind::torque, "link", between, {0.0, 0.0, -1.0}, {}, false};
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
