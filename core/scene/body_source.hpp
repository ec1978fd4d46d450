#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/scene/body_constants.hpp"

namespace pleuel {

/// Makes an elastic body for a design, with derivatives. What it makes for two designs has the same
/// coordinates, places, points and elements.
class BodySource {
 public:
  virtual ~BodySource() = default;

  /// @param values  of the variables [SI], in their order
  /// @returns       InvariantsFile::design has these variables in this order
  /// @throws SimulationError if no body can be made for this design
  virtual std::shared_ptr<const InvariantsFile> at(const Eigen::VectorXd& values) const = 0;

  /// What at() follows from besides the design: two sources with the same text make the same bodies.
  virtual std::string identity() const = 0;

  /// How far a design is from the nearest one that a body was made for, relative, if what at()
  /// returns in between is continued; 0: every body is made for its design.
  virtual double distance(const Eigen::VectorXd& /*values*/) const { return 0.0; }
};

}  // namespace pleuel
