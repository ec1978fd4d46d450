/// A program that needs all instructions there are, with the check of the program (library/
/// processor_check.cpp) in front of it, on a processor without those that LACKING names.

#include "tests/cli/old_processor.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "library/processor_needs.hpp"

namespace pleuel {

constinit const ProcessorNeeds processor_needs = {true, true, true, true, true, true, true};

}  // namespace pleuel

int old_processor_supports(const char* instructions) {
  const char* lacking = std::getenv("LACKING");
  return lacking == nullptr || std::strcmp(lacking, instructions) != 0 ? 1 : 0;
}

int main() {
  std::puts("runs");
  return 0;
}
