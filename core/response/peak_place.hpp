#pragma once

#include <optional>
#include <string>

#include "core/response/analysis.hpp"

namespace pleuel {

/// Where along a beam something is, 0 … 1, of which a signal says the place in words: "node 2.5, y
/// = …" (elements are counted through all frames of the beam) or "at 0.25 of the length". Nothing
/// for other places and other bodies.
std::optional<double> share_of_place(const Model& model, const std::string& body,
                                     const std::string& place);

/// When and where a response has its peak.
struct Peak {
  double time = 0.0;              ///< of the instant next to it [s]
  std::string place;              ///< as its signal says it
  std::optional<double> share{};  ///< where along the beam it is, 0 … 1
};

/// Of a response that is a peak over time; nothing for others.
std::optional<Peak> find_peak(const ProblemFile& problem, const Analysis& analysis,
                              std::size_t response);

/// When and where the two peaks of a tie are: "at 0.08 s (node 0) and at 0.05 s (node 3)".
/// @param response  with a history
std::string describe_tie(const PeakTie& tie, const Response& response);

}  // namespace pleuel
