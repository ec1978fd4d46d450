#include "cli/reports/ties.hpp"

#include <fmt/format.h>

#include "cli/text/wrapped_text.hpp"
#include "core/response/describe_tie.hpp"
#include "sensitivity/kinks.hpp"

namespace pleuel {

namespace {

std::string describe(const Tie& tie, const Response& response) {
  const PeakTie& peaks = tie.peaks;
  return fmt::format("{}: peaks within {:.2g} %, {}; gradients differ by {:.3g} %", response.name,
                     100 * peaks.gap, describe_tie(peaks, response), 100 * *tie.kink);
}

}  // namespace

Ties find_ties(Analysis& analysis, const std::vector<DesignVariable>& variables) {
  return make_ties(analysis, find_kinks(analysis, variables));
}

Ties make_ties(const Analysis& analysis, const std::vector<Kink>& kinks) {
  Ties ties(analysis.responses.size());
  for (std::size_t i = 0; i < ties.size(); ++i) {
    const std::vector<PeakTie>& all = analysis.reductions[i].ties;
    if (!all.empty()) ties[i] = Tie{all.front(), std::nullopt};
  }
  for (const Kink& kink : kinks) {
    std::optional<Tie>& tie = ties[kink.response];
    if (!tie || !tie->is_kink()) tie = Tie{kink.tie, kink.difference};
  }
  return ties;
}

Json tie_document(const Tie& tie, const Response& response) {
  const Signal& signal = *response.history()->signal;
  return {
      {"times", {tie.peaks.time, tie.peaks.other_time}},
      {"places", {signal.describe(tie.peaks.channel), signal.describe(tie.peaks.other_channel)}},
      {"gap", tie.peaks.gap},
      {"is_kink", tie.is_kink()}};
}

std::string ties_text(const Ties& ties, const Analysis& analysis) {
  std::string kinks;
  std::vector<std::string> harmless;
  for (std::size_t i = 0; i < ties.size(); ++i) {
    if (!ties[i]) continue;
    const Response& response = analysis.responses[i];
    if (ties[i]->is_kink()) {
      kinks += fmt::format("  {}\n", describe(*ties[i], response));
    } else {
      harmless.push_back(response.name);
    }
  }
  std::string text;
  if (!kinks.empty()) {
    text += "\nKinks: two peaks tie, and the gradient is that of the higher one only\n" + kinks;
  }
  if (!harmless.empty()) {
    text += fmt::format("\nHarmless ties (equal peaks that move alike with the design): {}\n",
                        fmt::join(harmless, ", "));
  }
  return wrapped(text, "    ");
}

}  // namespace pleuel
