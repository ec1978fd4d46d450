#include "core/scene/reading/section_check.hpp"

#include "core/scene/body_rules.hpp"

namespace pleuel {
namespace {

/// Sizes that exceed their limit by less than this share of it are written numbers, rounded.
constexpr double rounding_tolerance = 1e-9;

}  // namespace

void check_section(const JsonNode& node, const Section& section, const Design<double>& start) {
  for (const SectionRule& rule : section_rules(section)) {
    const auto broken = complaint(rule, start, rounding_tolerance);
    if (broken) node.at(rule.key).fail(*broken);
  }
}

}  // namespace pleuel
