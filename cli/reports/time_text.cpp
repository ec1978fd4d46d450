#include "cli/reports/time_text.hpp"

#include <cmath>

#include <fmt/format.h>

namespace pleuel {

bool is_same(const ComparedTime& time) {
  return time.change == 0.0 && time.spread == 0.0;
}

std::string percent_with_spread(const ComparedTime& time) {
  const std::string percents = fmt::format("{:.0f}", 100.0 * std::abs(time.change));
  if (time.spread == 0.0) return percents + " %";
  return fmt::format("{} ± {:.0f} %", percents, std::ceil(100.0 * time.spread));
}

std::string time_change_text(const ComparedTime& time) {
  if (is_same(time)) return "the same";
  if (!time.is_measurable()) return "not measurable";
  return (time.change < 0.0 ? "−" : "+") + percent_with_spread(time);
}

Json time_change_document(const ComparedTime& time) {
  return {{"change", time.change},
          {"spread", number_or_null(time.spread)},
          {"is_measurable", time.is_measurable()}};
}

}  // namespace pleuel
