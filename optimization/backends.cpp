#include "optimization/backends.hpp"

#include <algorithm>
#include <cctype>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "core/base/quoted.hpp"

namespace pleuel {

namespace {

using Makers = std::vector<std::pair<std::string, OptimizerMaker>>;

const Makers& own_makers() {
  static const Makers list = {{"nlopt-mma", make_nlopt_mma},
                              {"nlopt-ccsaq", make_nlopt_ccsaq},
                              {"nlopt-slsqp", make_nlopt_slsqp},
                              {"ipopt", make_ipopt}};
  return list;
}

/// Those of programs that call the library.
struct CallersBackends {
  std::mutex mutex;
  Makers makers;
};

/// Never destroyed: threads of the caller may outlive what the program ends with.
CallersBackends& callers_backends() {
  static CallersBackends& one = *new CallersBackends;
  return one;
}

auto with_name(const std::string& name) {
  return [&name](const auto& maker) { return maker.first == name; };
}

Makers all_makers() {
  Makers all = own_makers();
  const std::lock_guard lock(callers_backends().mutex);
  all.insert(all.end(), callers_backends().makers.begin(), callers_backends().makers.end());
  return all;
}

void check_name(const std::string& name) {
  const auto is_of_word = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  };
  if (name.empty() || !std::all_of(name.begin(), name.end(), is_of_word)) {
    throw InputError(
        fmt::format("the name of a backend must be letters, digits, '-' and '_', got \"{}\"",
                    excerpt(name, 60)));
  }
  if (std::any_of(own_makers().begin(), own_makers().end(), with_name(name))) {
    throw InputError(fmt::format("the backend \"{}\" is one of Pleuel: take another name", name));
  }
}

}  // namespace

std::vector<std::string> optimizer_names() {
  std::vector<std::string> names;
  for (const auto& [name, make] : all_makers()) names.push_back(name);
  return names;
}

void add_optimizer(const std::string& name, OptimizerMaker make) {
  check_name(name);
  const std::lock_guard lock(callers_backends().mutex);
  std::erase_if(callers_backends().makers, with_name(name));
  callers_backends().makers.emplace_back(name, std::move(make));
}

void remove_optimizer(const std::string& name) {
  const std::lock_guard lock(callers_backends().mutex);
  if (std::erase_if(callers_backends().makers, with_name(name)) == 0) {
    throw InputError(fmt::format("no backend \"{}\" was added", excerpt(name, 60)));
  }
}

std::unique_ptr<Optimizer> make_optimizer(const std::string& name, const BackendOptions& options) {
  for (const auto& [known, make] : all_makers()) {
    if (known == name) return make(options);
  }
  throw InputError(fmt::format("there is no optimizer backend \"{}\"; known are {}", name,
                               fmt::join(optimizer_names(), ", ")));
}

BackendEnd run_backend(EvaluationCache& cache, const EvaluatedDesign& from, const std::string& name,
                       double tolerance, const ScaledProblem::Budget& budget,
                       const Eigen::VectorXd& factors) {
  BackendEnd end{from.x};
  ScaledProblem scaled(cache, from, budget, factors);
  if (scaled.variables() == 0) return end;
  const BackendResult result = make_optimizer(name, {tolerance})->minimize(scaled);
  scaled.rethrow();
  end.has_left_numbers = scaled.has_left_numbers();
  end.reason = end.has_left_numbers ? "it asked for a design that is not a number" : result.reason;
  if (result.y.allFinite()) end.x = scaled.to_design(result.y);
  return end;
}

}  // namespace pleuel
