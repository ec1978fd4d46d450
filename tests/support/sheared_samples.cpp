#include "tests/support/sample_parts.hpp"

using namespace sample_parts;

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
