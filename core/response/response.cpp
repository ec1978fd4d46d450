#include "core/response/response.hpp"

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"

namespace pleuel {

bool Response::holds_steps(const Eigen::VectorXd& time) const {
  return !history() || steps_between(time, history()->from, history()->to).steps() >= 2;
}

StepRange Response::steps(const Eigen::VectorXd& time) const {
  if (!history()) return whole_range(time);
  if (holds_steps(time)) return steps_between(time, history()->from, history()->to);
  throw InputError(
      fmt::format("/responses/{} is reduced over a window of time with less than two steps; widen "
                  "it or shorten the steps",
                  name));
}

std::string refused_response(const std::string& name, const std::string& why) {
  return fmt::format("the response \"{}\" cannot be computed: {}", name, why);
}

void refuse_response(const std::string& name, const std::string& why) {
  throw InputError(refused_response(name, why));
}

}  // namespace pleuel
