#include "cli/reports/plain_verdict.hpp"

#include <cmath>

#include <fmt/format.h>

#include "core/base/number_text.hpp"
#include "core/scene/response_quantity.hpp"

namespace pleuel {

namespace {

/// "is lighter", "has a smaller rod_bow"
std::string better_text(const ProblemFile& problem) {
  const ResponseSettings& response = find_response(problem, problem.objective->response);
  const bool is_minimized = problem.objective->sign() > 0.0;
  if (quantity_of(response).unit == "kg") return is_minimized ? "is lighter" : "is heavier";
  return fmt::format("has a {} {}", is_minimized ? "smaller" : "larger", response.name);
}

std::string accuracy_text(const Optimum& optimum) {
  const std::string& name = optimum.problem.objective->response;
  const double value = optimum.result.evaluation.objective;
  if (!optimum.result.error || !optimum.result.error->is_resolved() || value == 0.0) {
    return "how exact the simulation is was not looked at";
  }
  const double bound = optimum.result.error->bound();
  if (bound == 0.0) return fmt::format("{} is exact", name);
  return fmt::format("steps and elements change {} by {} % at most", name,
                     significant(100.0 * bound / std::abs(value), 2));
}

}  // namespace

std::string neighbours_text(const Optimum& optimum) {
  const std::string better = better_text(optimum.problem);
  if (optimum.sizes == nullptr || !optimum.sizes->is_choice) {
    return fmt::format("no design nearby that keeps them {}", better);
  }
  const SizeChoiceReport& sizes = *optimum.sizes;
  if (sizes.is_exhaustive) {
    return fmt::format(
        "of all {:.0f} choices of sizes, which were all tried, none that keeps them {}",
        sizes.combinations, better);
  }
  return fmt::format(
      "of the {} choices of sizes that were tried none that keeps them {}, also with any one size "
      "exchanged for {}; the others were not tried",
      sizes.tried, better, sizes.are_lists_tried ? "another" : "the next");
}

std::string plain_verdict(const Optimum& optimum) {
  if (optimum.result.status != Status::verified) return "";
  return fmt::format(
      "every limit holds; {}; the gradients agree with differences of simulations; {}",
      neighbours_text(optimum), accuracy_text(optimum));
}

}  // namespace pleuel
