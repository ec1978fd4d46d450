#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/model/model.hpp"

/// How a beam bends in a state, and what shear would store in it, by its section forces.
namespace pleuel {

/// A plane of bending of one element.
struct ElementBending {
  double length = 0.0, stiffness = 0.0;  ///< ℓ [m], EI [N m²]
  double shear_stiffness = 0.0;          ///< κ G A [N]
  std::array<double, 2> curvature{};     ///< at both ends [1/m]
  std::array<double, 2> deflection{};    ///< at both ends [m]

  double force() const { return stiffness * (curvature[1] - curvature[0]) / length; }
  double bending_energy() const {
    const auto [a, b] = curvature;
    return stiffness * length * (a * a + a * b + b * b) / 6.0;
  }
  double shear_energy() const { return 0.5 * force() * force() / shear_stiffness * length; }
};

using BeamBending = std::vector<ElementBending>;

/// Reads one beam of a problem, whose sections say how stiff in shear it is.
class BendingReader {
 public:
  /// @param x     design variables [SI]
  /// @param body  the name of a beam
  BendingReader(const ProblemFile& problem, const Eigen::VectorXd& x, const std::string& body);

  /// @param body   a body of the model that is the beam, or one of its frames
  /// @param nodal  its nodal displacements, 6 × nodes
  /// @param plane  0: along y, 1: along z
  BeamBending read(const BodyModel& body, const Eigen::MatrixXd& nodal, int plane) const;

  /// What shear stores in a body that is deformed as in a state, in both planes [J].
  double shear_energy(const BodyModel& body, const State& state) const;

 private:
  Design<double> design_;
  const BeamBody* beam_;
};

}  // namespace pleuel
