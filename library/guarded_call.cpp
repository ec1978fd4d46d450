#include "library/guarded_call.hpp"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>

#include <fmt/format.h>

#include "library/call_error.hpp"

namespace pleuel {

void require_pointer(const void* pointer, const char* name) {
  if (pointer == nullptr) throw CallError(fmt::format("{} must not be NULL", name));
}

void require_size(std::size_t size, std::size_t expected, const char* name) {
  if (size == expected) return;
  throw CallError(fmt::format("the problem has {} {}, got the size {}", expected, name, size));
}

Eigen::VectorXd checked_design(const OpenProblem& problem, const double* x, std::size_t variables) {
  const std::vector<std::string>& names = problem.names(PLEUEL_VARIABLES);
  require_size(variables, names.size(), "variables");
  if (variables > 0) require_pointer(x, "x");
  for (std::size_t i = 0; i < variables; ++i) {
    if (std::isfinite(x[i])) continue;
    throw CallError(
        fmt::format("x[{}], the variable \"{}\", must be finite, got {}", i, names[i], x[i]));
  }
  return Eigen::Map<const Eigen::VectorXd>(x, static_cast<Eigen::Index>(variables));
}

void require_index(std::size_t index, std::size_t count, const char* name) {
  if (index >= count) {
    throw CallError(fmt::format("{} must be less than {}, got {}", name, count, index));
  }
}

void copy_out(const Eigen::VectorXd& from, double* to) {
  if (to != nullptr) Eigen::Map<Eigen::VectorXd>(to, from.size()) = from;
}

void copy_out(const Eigen::MatrixXd& from, double* to) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  if (to != nullptr) Eigen::Map<Rows>(to, from.rows(), from.cols()) = from;
}

char* text_out(const std::string& text) {
  char* copy = static_cast<char*>(std::malloc(text.size() + 1));
  if (copy == nullptr) throw std::bad_alloc();
  std::memcpy(copy, text.c_str(), text.size() + 1);
  return copy;
}

}  // namespace pleuel
