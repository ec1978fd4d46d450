#pragma once

#include "tests/support/test.hpp"

namespace pleuel::test {

/// "nlopt-mma" as the name of a test: letters and digits only.
inline std::string name_of_backend(const testing::TestParamInfo<std::string>& tested) {
  std::string name = tested.param;
  std::erase(name, '-');
  return name;
}

}  // namespace pleuel::test
