#include "core/response/value_over_cases.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/scene/load_cases.hpp"

namespace pleuel {

namespace {

using Kind = ExpressionArgument::Kind;

class OverCasesValue {
 public:
  OverCasesValue(const ProblemFile& joined, const Eigen::VectorXd& x, const ValueInCase& value_of)
      : joined_(joined), x_(x), value_of_(value_of) {}

  double value(std::size_t response) const {
    return is_over_cases(joined_, response) ? evaluated(response).value : value_of_(response);
  }

  LinearizedResponse linearized(std::size_t response) const {
    return ChainedResponse(
               x_.size(),
               [this](std::size_t one) {
                 return is_over_cases(joined_, one) ? joined_.responses[one].expression.get()
                                                    : nullptr;
               },
               [this](std::size_t one, const Expression&) {
                 ExpressionValue at = evaluated(one);
                 for (const double derivative : at.derivatives) {
                   if (!std::isfinite(derivative)) refuse(one, "derivative");
                 }
                 return at;
               })
        .linearized(response);
  }

 private:
  ExpressionValue evaluated(std::size_t response) const {
    const Expression& expression = *joined_.responses[response].expression;
    std::vector<double> arguments;
    for (const ExpressionArgument& argument : expression.arguments) {
      arguments.push_back(argument.kind == Kind::response ? value(argument.index)
                                                          : x_(argument.index));
    }
    ExpressionValue found = evaluate(expression, arguments);
    if (!std::isfinite(found.value)) refuse(response, "value");
    return found;
  }

  [[noreturn]] void refuse(std::size_t response, const char* what) const {
    const Expression& expression = *joined_.responses[response].expression;
    std::string text;
    for (const ExpressionArgument& argument : expression.arguments) {
      if (argument.kind != Kind::response) continue;
      text += fmt::format("{}{} = {:.6g}", text.empty() ? ", with " : ", ",
                          joined_.responses[argument.index].name, value(argument.index));
    }
    throw SimulationError(fmt::format("the response \"{}\" has no finite {} there: \"{}\"{}",
                                      joined_.responses[response].name, what, expression.text,
                                      text));
  }

  const ProblemFile& joined_;
  const Eigen::VectorXd& x_;
  const ValueInCase& value_of_;
};

}  // namespace

double value_over_cases(const ProblemFile& joined, std::size_t response, const Eigen::VectorXd& x,
                        const ValueInCase& value_of) {
  return OverCasesValue(joined, x, value_of).value(response);
}

LinearizedResponse linearized_over_cases(const ProblemFile& joined, std::size_t response,
                                         const Eigen::VectorXd& x, const ValueInCase& value_of) {
  return OverCasesValue(joined, x, value_of).linearized(response);
}

}  // namespace pleuel
