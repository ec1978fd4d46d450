#pragma once

#include <string>
#include <vector>

namespace pleuel {

/// A problem as it is written. The arguments of read_problem_text().
struct ProblemText {
  std::string text;
  std::string file;
  std::vector<std::string> overrides = {};
  std::string load_case = {};  ///< the one that is meant of a text with several
};

}  // namespace pleuel
