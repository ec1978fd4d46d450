#include "core/scene/time_function.hpp"

#include <algorithm>

namespace pleuel {

bool depends_on_state(const TimeFunction& function) {
  if (const auto* table = std::get_if<TableFunction>(&function)) {
    return table->argument != LawArgument::time;
  }
  if (const auto* formula = std::get_if<ExpressionFunction>(&function)) {
    const std::vector<ExpressionArgument>& all = formula->expression->arguments;
    return std::ranges::any_of(all, [](const ExpressionArgument& one) {
      return one.kind == ExpressionArgument::Kind::coordinate ||
             one.kind == ExpressionArgument::Kind::rate;
    });
  }
  return std::holds_alternative<FrictionLaw>(function) ||
         std::holds_alternative<ClearanceLaw>(function);
}

}  // namespace pleuel
