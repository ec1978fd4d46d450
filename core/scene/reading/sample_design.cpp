#include "core/scene/reading/sample_design.hpp"

#include <fmt/format.h>

namespace pleuel {

std::vector<SampleDesign> sample_designs(const std::vector<DesignVariable>& variables) {
  SampleDesign start;
  for (const DesignVariable& variable : variables) start.design.push_back(variable.start);
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
