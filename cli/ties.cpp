#include "cli/ties.hpp"

#include <fmt/format.h>

namespace pleuel {

std::string describe_tie(const Analysis& analysis, std::size_t response) {
  const PeakTie& tie = *analysis.reductions[response].tie;
  const Signal& signal = *analysis.responses[response].signal;
  return fmt::format("peaks within {:.2g} %: at {:.5g} s ({}) and at {:.5g} s ({})", 100 * tie.gap,
                     tie.time, signal.describe(tie.channel), tie.other_time,
                     signal.describe(tie.other_channel));
}

Json tie_document(const Analysis& analysis, std::size_t response) {
  const PeakTie& tie = *analysis.reductions[response].tie;
  const Signal& signal = *analysis.responses[response].signal;
  return {{"times", {tie.time, tie.other_time}},
          {"places", {signal.describe(tie.channel), signal.describe(tie.other_channel)}},
          {"gap", tie.gap}};
}

std::string ties_text(const Analysis& analysis) {
  std::string text;
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    if (!analysis.reductions[i].tie) continue;
    text += fmt::format("  {}: {}\n", analysis.responses[i].name, describe_tie(analysis, i));
  }
  if (text.empty()) return text;
  return "\nTies: two peaks of nearly the same height; the gradient is that of the higher one\n" +
         text;
}

}  // namespace pleuel
