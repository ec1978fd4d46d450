#pragma once

#include "core/model/model.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel {

/// What other programs, or another problem, need of a body: its constants with their derivatives
/// at the design of the model, as they stand in a file of invariants.
/// Places of a beam are its nodes and wherever joints, loads and responses are, along it. A place has
/// the name of the first joint, load or response there, else "node 3".
/// @param problem  that the model was built of
/// @param units    SI units of the design variables, in their order
/// @throws InputError for a body without elastic coordinates
InvariantsFile export_body(const ProblemFile& problem, const Model& model, const std::string& body,
                           const std::vector<std::string>& units);

}  // namespace pleuel
