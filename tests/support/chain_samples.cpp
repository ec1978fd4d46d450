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
