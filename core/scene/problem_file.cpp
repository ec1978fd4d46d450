#include "core/scene/problem_file.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"

namespace pleuel {

std::string to_string(GradientMethod method) {
  return word_of(gradient_methods, method);
}

GradientMethod gradient_method(const std::string& name) {
  std::string known;
  for (const auto& [word, method] : gradient_methods) {
    if (word == name) return method;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", word);
  }
  throw InputError(fmt::format("there is no gradient method \"{}\"; known are {}", name, known));
}

}  // namespace pleuel
