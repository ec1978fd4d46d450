#include "core/scene/reading/sample_design.hpp"

#include <fmt/format.h>

namespace pleuel {

Design<double> start_values(const std::vector<DesignVariable>& variables) {
  Design<double> start;
  for (const DesignVariable& variable : variables) start.push_back(variable.start);
  return start;
}

std::vector<SampleDesign> sample_designs(const std::vector<DesignVariable>& variables) {
  const SampleDesign start{start_values(variables), ""};
  std::vector<SampleDesign> samples = {start};
  for (std::size_t i = 0; i < variables.size(); ++i) {
    for (const auto& [bound, word] :
         {std::pair(variables[i].lower, "lower"), std::pair(variables[i].upper, "upper")}) {
      SampleDesign sample = start;
      sample.design[i] = bound;
      sample.where =
          fmt::format(", with the variable \"{}\" at its {} bound", variables[i].name, word);
      samples.push_back(sample);
    }
  }
  return samples;
}

}  // namespace pleuel
