#include "core/response/response.hpp"

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"

namespace pleuel {

StepRange Response::steps(const Eigen::VectorXd& time) const {
  if (!history()) return whole_range(time);
  const StepRange range = steps_between(time, history()->from, history()->to);
  if (range.steps() >= 2) return range;
  throw InputError(
      fmt::format("/responses/{} is reduced over a window of time with less than two steps; widen "
                  "it or shorten the steps",
                  name));
}

void refuse_response(const std::string& name, const std::string& why) {
  throw InputError(fmt::format("the response \"{}\" cannot be computed: {}", name, why));
}

}  // namespace pleuel
