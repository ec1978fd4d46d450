#include "tests/support/sample_scenes.hpp"

#include "tests/support/sample_parts.hpp"

using namespace sample_parts;

const std::vector<SampleScene>& all_samples() {
  static const std::vector<SampleScene> samples = {
      planar_sample(),           planar_sample_in_space(),  spatial_sample(),
      spatial_joints_sample(),   planar_joints_sample(),    reduced_sample(),
      reduced_sample_in_space(), sheared_sample_in_space(), sheared_reduced_sample()};
  return samples;
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
  // In the second of the four elements of the rod, too near its start for a node of its own.
  Point between = pin;
  between[0] = Number::bound(pin_x.variable, 0.7495);
  between[0].constant = 0.2505 * 0.32;
  between[1] = SceneWriter::shifted(0.0, pin_y, 0.7495);
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
  const Point arm_hinge = {SceneWriter::shifted(0.0502, arm_x, 0.498), -0.1251, 0.0};
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
  PointLoad wind{LoadKind::force, "flag", flag_to, {1.0, 0.0, 0.0}, {}, false};
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

namespace {

void shear_all(SampleScene& sample, const std::string& name) {
  sample.name = name;
  for (Body& body : sample.scene.bodies) {
    auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam != nullptr) beam->has_shear = !beam->is_rigid;
  }
}

}  // namespace

SampleScene sheared_sample_in_space() {
  SceneWriter write;
  write.sample = planar_sample_in_space();
  shear_all(write.sample, "PlanarWithShearInSpace");
  for (Body& body : write.scene().bodies) {
    if (body.name != "arm") continue;
    GeneralSection section{2e-4, 2e-9, 6e-9, 4e-9, {{0.01, 0.005, 1e7}, {-0.01, 0.005, 1e7}}};
    section.shear_area_y = write.variable("shear_area_y", 4e-5);
    section.shear_area_z = write.variable("shear_area_z", 6e-5);
    std::get<BeamBody>(body.shape).segments[0].section = section;
  }
  return write.sample;
}

SampleScene sheared_reduced_sample() {
  SampleScene sample = reduced_sample();
  shear_all(sample, "ReducedWithShear");
  return sample;
}
