#include "optimization/backends.hpp"

#include <fmt/format.h>

#include "optimization/ipopt_optimizer.hpp"
#include "optimization/nlopt_optimizer.hpp"

namespace pleuel {

namespace {

struct Backend {
  std::string name;
  std::unique_ptr<Optimizer> (*make)(const BackendOptions& options);
};

const std::vector<Backend>& backends() {
  static const std::vector<Backend> list = {{"nlopt-mma", make_nlopt_mma},
                                            {"nlopt-ccsaq", make_nlopt_ccsaq},
                                            {"nlopt-slsqp", make_nlopt_slsqp},
                                            {"ipopt", make_ipopt}};
  return list;
}

}  // namespace

std::vector<std::string> optimizer_names() {
  std::vector<std::string> names;
  for (const Backend& backend : backends()) names.push_back(backend.name);
  return names;
}

std::unique_ptr<Optimizer> make_optimizer(const std::string& name, const BackendOptions& options) {
  for (const Backend& backend : backends()) {
    if (backend.name == name) return backend.make(options);
  }
  throw InputError(fmt::format("there is no optimizer backend \"{}\"; known are {}", name,
                               fmt::join(optimizer_names(), ", ")));
}

}  // namespace pleuel
