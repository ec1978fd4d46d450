#include "cli/commands.hpp"
#include "optimization/optimizer.hpp"

namespace pleuel {

Outcome run_backends(const Arguments&) {
  Outcome outcome;
  outcome.document["backends"] = optimizer_names();
  for (const std::string& name : optimizer_names()) outcome.text += name + "\n";
  return outcome;
}

}  // namespace pleuel
