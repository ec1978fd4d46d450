#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/text/json.hpp"
#include "core/response/analysis.hpp"
#include "sensitivity/kinks.hpp"

/// Maxima that two peaks share. If the peaks move alike with the design that is no harm; if not,
/// the response has a kink there, and its gradient is that of the higher peak only.
namespace pleuel {

struct Tie {
  PeakTie peaks;
  std::optional<double> kink;  ///< relative difference of the two gradients, if they differ

  bool is_kink() const { return kink.has_value(); }
};

/// The tie of each response, if it has one; a kink before a harmless one.
using Ties = std::vector<std::optional<Tie>>;

/// Costs one run of direct differentiation if there is any tie.
Ties find_ties(Analysis& analysis, const std::vector<DesignVariable>& variables);
/// The same with kinks that are known.
Ties make_ties(const Analysis& analysis, const std::vector<Kink>& kinks);

/// {"times": [s, s], "places": ["…", "…"], "gap", "is_kink"}
Json tie_document(const Tie& tie, const Response& response);

/// A line for each kink, and one for all harmless ties; or nothing.
std::string ties_text(const Ties& ties, const Analysis& analysis);

}  // namespace pleuel
