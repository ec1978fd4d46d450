#pragma once

#include <string>

#include <gtest/gtest.h>

#include "tests/support/sample_scenes.hpp"

/// The name of a test whose parameter is the place of its sample among all_samples().
inline std::string sample_name(const testing::TestParamInfo<int>& info) {
  return all_samples()[info.param].name;
}
