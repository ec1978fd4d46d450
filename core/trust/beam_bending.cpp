#include "core/trust/beam_bending.hpp"

#include "core/base/find_named.hpp"
#include "core/beam/beam_shape.hpp"
#include "core/model/shear_area.hpp"
#include "core/trust/beam_state.hpp"

namespace pleuel {

BendingReader::BendingReader(const ProblemFile& problem, const Eigen::VectorXd& x,
                             const std::string& body)
    : design_(x.begin(), x.end()),
      beam_(&std::get<BeamBody>(find_named(problem.scene.bodies, body)->shape)) {}

BeamBending BendingReader::read(const BodyModel& body, const Eigen::MatrixXd& nodal,
                                int plane) const {
  BeamBending elements;
  for (std::size_t e = 0; e < body.beam.elements.size(); ++e) {
    const BeamElement<double>& element = body.beam.elements[e];
    const std::size_t segment = body.mesh.elements[e].segment;
    const double nu = element.young / (2.0 * element.shear) - 1.0;
    const ShearArea<double> area =
        shear_area(beam_->segments[segment].section, element.section, nu, design_);
    const ElementForm<double> form = form_of(element);
    Eigen::Matrix<double, 12, 1> q;
    q << nodal.col(e), nodal.col(e + 1);
    ElementBending bending;
    bending.length = element.length;
    bending.stiffness =
        element.young * (plane == 0 ? element.section.inertia_z : element.section.inertia_y);
    bending.shear_stiffness = element.shear * (plane == 0 ? area.along_y : area.along_z);
    for (std::size_t end = 0; end < 2; ++end) {
      const double xi = static_cast<double>(end);
      const auto row = plane == 0 ? deflection_y_row(xi, form, 2) : deflection_z_row(xi, form, 2);
      bending.curvature[end] = row.dot(q);
      bending.deflection[end] = nodal(1 + plane, e + static_cast<Eigen::Index>(end));
    }
    elements.push_back(bending);
  }
  return elements;
}

double BendingReader::shear_energy(const BodyModel& body, const State& state) const {
  const Eigen::MatrixXd nodal = nodal_displacements(body, state);
  double energy = 0.0;
  for (int plane = 0; plane < 2; ++plane) {
    for (const ElementBending& element : read(body, nodal, plane)) energy += element.shear_energy();
  }
  return energy;
}

}  // namespace pleuel
