#include "core/scene/sensitivity_settings.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"

namespace pleuel {

std::string to_string(GradientMethod method) {
  switch (method) {
    case GradientMethod::automatic:
      return "auto";
    case GradientMethod::direct:
      return "direct";
    case GradientMethod::adjoint:
      return "adjoint";
    case GradientMethod::forward_difference:
      return "forward-difference";
    default:
      return "central-difference";
  }
}

GradientMethod gradient_method(const std::string& name) {
  std::string known;
  for (auto method : {GradientMethod::automatic, GradientMethod::direct, GradientMethod::adjoint,
                      GradientMethod::forward_difference, GradientMethod::central_difference}) {
    if (to_string(method) == name) return method;
    known += (known.empty() ? "" : ", ") + to_string(method);
  }
  throw InputError(fmt::format("there is no gradient method \"{}\"; known are {}", name, known));
}

std::string to_string(InvariantDerivatives derivatives) {
  switch (derivatives) {
    case InvariantDerivatives::exact:
      return "exact";
    case InvariantDerivatives::complex_step:
      return "complex-step";
    case InvariantDerivatives::central:
      return "central";
    default:
      return "forward";
  }
}

}  // namespace pleuel
