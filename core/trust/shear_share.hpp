#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "core/model/model.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel {

/// Deflection by shear, which beams leave out that are not asked to have it, over that by bending,
/// for bending along local y and z. From the section forces of a state, so for the ends and loads that the beam
/// has there: the slope by shear is V/(κ G A); 3EI/(κ G A L²) of a cantilever with a force at its
/// tip, 12EI/(κ G A L²) of a beam on two pins with one in the middle. Of a divided beam, and of
/// modes, it is the ratio of the energies. [–]
struct ShearShare {
  double along_y = 0.0, along_z = 0.0;
  double displacement = 0.0;  ///< largest deflection by bending [m]

  double largest() const { return along_y > along_z ? along_y : along_z; }
};

/// @param problem  knows the sections
/// @param x        design variables [SI]
/// @param place    along a beam that is not divided, 0 … 1: of the deflection there instead of the
///                 largest
ShearShare shear_share(const ProblemFile& problem, const Eigen::VectorXd& x, const Model& model,
                       const std::string& body, const State& state,
                       std::optional<double> place = std::nullopt);

}  // namespace pleuel
