#pragma once

#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

/// The name of a test whose parameter is the place of its sample among all_samples().
inline std::string sample_name(const testing::TestParamInfo<int>& info) {
  return all_samples()[info.param].name;
}
