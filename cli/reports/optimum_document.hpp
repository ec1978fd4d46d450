#pragma once

#include "cli/text/json.hpp"
#include "core/response/effect_measurement.hpp"
#include "core/response/monitors.hpp"
#include "core/scene/shown_unit.hpp"
#include "optimization/design/multi_start.hpp"
#include "sensitivity/gradients.hpp"

namespace pleuel {

/// What the reports of an optimization are made from.
struct Optimum {
  const ProblemFile& problem;
  const Result& result;
  /// Values of all responses; empty if the start cannot be simulated.
  Eigen::VectorXd start_responses, responses;
  Monitors monitors;                  ///< of the last design; likewise
  std::vector<std::string> warnings;  ///< likewise: what speaks against its numbers
  int consequences =
      0;  ///< so many of the last warnings are not told, since they follow from others
  std::optional<GradientChoice> method;  ///< of the gradients; none if there was none
  /// Of the last design, by runs of twice the step; empty: not measured.
  std::vector<EffectInfluence> influences{};
  Eigen::MatrixXd gradients{};              ///< responses × variables [SI]; empty: not known
  const SizeChoiceReport* sizes = nullptr;  ///< where some are chosen from lists

  bool has_design() const { return result.evaluation.has_gradients(); }

  /// Where the search began: that of the file, unless another design was given.
  double start(std::size_t variable) const {
    return result.history.empty() ? problem.variables[variable].start
                                  : first_design(result.history).x(variable);
  }
};

/// What was checked of a verified answer, in words that need no theory: "every limit holds; no
/// design nearby is lighter; …". Empty of other answers, whose message says what is missing.
std::string plain_verdict(const Optimum& optimum);

/// "no design nearby that keeps them is lighter"; of sizes out of lists, what was tried of them.
std::string neighbours_text(const Optimum& optimum);

/// The document of `optimize`; see docs/reference/commands.md.
Json optimum_document(const Optimum& optimum);

/// What a search found, before anything is simulated at its last design. Refers to the search.
Optimum optimum_of(const WholeSearch& search);

/// Adds its starts, if there are several, and its choice of sizes to the document of the optimum.
void add_search(const WholeSearch& search, Json& document);

/// What the last design of a run is called: "optimum", or "end" where nothing is proven of it.
/// @param status  as in result.json
std::string name_of_end(const std::string& status);

/// The result of `optimize` for people: verdict, objective, dimensions, limits, what speaks against it.
/// @param document    the same as optimum_document() has it
/// @param is_verbose  with the audit and the prices of limits
std::string optimum_report(const Optimum& optimum, const Json& document, bool is_verbose);

}  // namespace pleuel
