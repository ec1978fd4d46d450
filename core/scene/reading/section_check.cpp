#include "core/scene/reading/section_check.hpp"

#include "core/scene/body_rules.hpp"
#include "core/scene/reading/limits.hpp"

namespace pleuel {

void check_section(const JsonNode& node, const Section& section, const Design<double>& start) {
  for (const SectionRule& rule : section_rules(section)) {
    const auto broken = complaint(rule, start, rounding_tolerance);
    if (broken) node.at(rule.key).fail(*broken);
  }
}

}  // namespace pleuel
