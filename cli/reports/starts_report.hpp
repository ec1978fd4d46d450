#pragma once

#include "cli/text/json.hpp"
#include "optimization/design/multi_start.hpp"

namespace pleuel {

/// The local optima that were found from several starts, and how often; empty for one start.
std::string starts_text(const ProblemFile& problem, const MultiStart& all);

/// {"optima": [{"objective", "found", "variables"}], "runs": [{"start", "status", …}]}
Json starts_document(const ProblemFile& problem, const MultiStart& all);

/// "25 mm", or the name of the section: what a variable with choices has at this value. None if it has
/// no choices, or another value.
std::optional<std::string> size_text(const DesignVariable& variable, double value);

/// {NAME: text} of the variables with choices that have one of theirs.
Json sizes_of(const ProblemFile& problem, const Eigen::VectorXd& x);

/// Whether the value alone means nothing to people: the place of a section in its list.
bool is_section(const DesignVariable& variable);

/// What was chosen, beside the optimum between the sizes.
std::string sizes_text(const ProblemFile& problem, const SizeChoiceReport& sizes,
                       const Result& result);
Json sizes_document(const ProblemFile& problem, const SizeChoiceReport& sizes,
                    const Result& result);

}  // namespace pleuel
