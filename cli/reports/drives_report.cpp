#include "cli/reports/drives_report.hpp"

#include <cmath>

#include <fmt/format.h>

#include "cli/text/wrapped_text.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/shown_unit.hpp"
#include "picture/companions.hpp"

namespace pleuel {

namespace {

const char* word_of(ResponseType type) {
  if (type == ResponseType::drive_torque) return "torque";
  return type == ResponseType::drive_force ? "force" : "power";
}

/// " (−57.1 %)"; nothing where there was nothing before.
std::string change_text(double before, double after) {
  if (before == 0.0) return "";
  const double percents = 100.0 * (after / before - 1.0);
  if (std::abs(percents) < 0.05) return " (the same)";
  return fmt::format(" ({}{:.1f} %)", percents < 0.0 ? "−" : "+", std::abs(percents));
}

}  // namespace

std::string drives_text(const ProblemFile& problem, const Analysis& start,
                        const Analysis& optimum) {
  const Companions before = find_drive_efforts(problem, start),
                   after = find_drive_efforts(problem, optimum);
  std::string text, line;
  for (std::size_t i = 0; i < after.all.size(); ++i) {
    const ResponseSettings& settings = after.all[i].settings;
    const ShownUnit unit = unit_of(settings);
    const double from = before.all[i].value, to = after.all[i].value;
    const bool is_power = settings.type == ResponseType::drive_power;
    line += fmt::format("{} {} → {} {}{}", word_of(settings.type), significant(unit.shown(from)),
                        significant(unit.shown(to)), unit.name, change_text(from, to));
    if (!is_power) {
      line += ", ";
      continue;
    }
    text += wrapped(fmt::format("Drive {}: {}\n", settings.joint, line), "  ");
    line.clear();
  }
  return text;
}

}  // namespace pleuel
