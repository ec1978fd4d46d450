#pragma once

#include <string>
#include <vector>

#include "core/beam/beam_place.hpp"
#include "core/model/model.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel {

struct NamedPlace {
  std::string name;
  BeamPlace place;
  double x = 0.0;  ///< along the beam [m]
};

/// The nodes of a beam and wherever joints, loads and responses are, along the beam. A place has
/// the name of the first joint, load or response there, else "node 3".
std::vector<NamedPlace> named_places(const ProblemFile& problem, const BodyModel& body);

}  // namespace pleuel
