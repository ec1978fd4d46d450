#include "cli/reports/gaps_report.hpp"

#include <array>

#include <fmt/format.h>

#include "core/base/number_text.hpp"
#include "core/scene/shown_unit.hpp"
#include "studies/varied_limit.hpp"

namespace pleuel {

namespace {

const char* cause_text(FrontGap::Cause cause) {
  static constexpr std::array<const char*, 4> names = {"open", "jump", "failure", "narrow"};
  return names[static_cast<std::size_t>(cause)];
}

/// Of a gap that more points do not close.
const char* reason(FrontGap::Cause cause) {
  if (cause == FrontGap::Cause::jump) return "the front jumps: searches found no design there";
  if (cause == FrontGap::Cause::narrow) {
    return "nothing was looked for: limits there are too near to each other, and the objective "
           "cannot be limited in their place";
  }
  return "searches failed, or came to designs that others dominate";
}

bool is_of_gap(const ProblemFile& problem, const ParetoFront& front) {
  return problem.pareto->gap > 0.0 && front.is_whole && !front.choices;
}

}  // namespace

std::string gaps_message(const ProblemFile& problem, const ParetoFront& front,
                         const std::string& limited) {
  if (!is_of_gap(problem, front)) return "";
  const double asked = problem.pareto->gap;
  if (!front.gaps.largest && front.gaps.gaps.empty()) {
    return "there are no neighbours: fewer than two points keep the limits and are not dominated";
  }
  std::string text = fmt::format("neighbours are at most {} apart, both goals over their ranges",
                                 percent(front.gaps.largest.value_or(0.0)));
  if (front.gaps.gaps.empty()) return fmt::format("{} ({} asked)", text, percent(asked));
  text += fmt::format("; asked was {}", percent(asked));
  const ShownUnit unit = unit_of(problem, problem.constraints[varied_rows(problem).front()]);
  bool is_open = false;
  for (const FrontGap& gap : front.gaps.gaps) {
    is_open = is_open || gap.cause == FrontGap::Cause::open;
    if (gap.cause == FrontGap::Cause::open) continue;
    const auto value = [&](std::size_t i) {
      return significant(unit.shown(front.points[i].limited_value));
    };
    text += fmt::format("; between {} = {} and {}{} ({}) {}", limited, value(gap.tight),
                        value(gap.loose), unit.suffix(), percent(gap.size), reason(gap.cause));
  }
  if (is_open) {
    text += fmt::format("; no more than {} points were allowed (\"most_points\")",
                        problem.pareto->most_points);
  }
  return text;
}

Json gaps_document(const ProblemFile& problem, const ParetoFront& front) {
  if (!is_of_gap(problem, front)) return nullptr;
  Json document = {{"asked", problem.pareto->gap}, {"largest", nullptr}};
  if (front.gaps.largest) document["largest"] = *front.gaps.largest;
  const auto limited = [&](std::size_t i) {
    const ParetoPoint& point = front.points[i];
    return point.has_design() && point.keeps_limits() ? Json(point.limited_value) : Json(nullptr);
  };
  document["left"] = list_of(front.gaps.gaps, [&](const FrontGap& gap) {
    return Json{{"points", {gap.tight + 1, gap.loose + 1}},
                {"limited", {limited(gap.tight), limited(gap.loose)}},
                {"size", gap.size},
                {"cause", cause_text(gap.cause)}};
  });
  return document;
}

}  // namespace pleuel
