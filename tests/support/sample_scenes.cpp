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
