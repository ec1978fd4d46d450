#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "cli/text/json.hpp"
#include "core/scene/problem_file.hpp"

/// What an earlier run simulated, from its documents.
namespace pleuel {

/// The load case whose mechanism a page shows first; empty without cases.
std::string shown_case(const Json& result);

/// The problem as it ran: with the steps and elements that were chosen for an accuracy, and the
/// effects that were built at the end.
ProblemFile problem_of(const Json& card, const Json& result);

/// The same of one of its load cases; of all if it is empty.
ProblemFile problem_of(const Json& card, const Json& result, const std::string& load_case);

/// The values of a document's variables; nothing if it does not have all of them.
/// @param key  of {NAME: {key: number}}; empty for {NAME: number}
std::optional<Eigen::VectorXd> design_in(const Json& document, const ProblemFile& problem,
                                         const std::string& key);

}  // namespace pleuel
