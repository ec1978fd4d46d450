#pragma once

#include <filesystem>

#include "core/response/analysis.hpp"

namespace pleuel {

/// One line an instant: time, then each response's history (of several channels, such as the
/// points of a stress, the largest) [SI].
void write_trajectory(const std::filesystem::path& path, const Analysis& analysis);

}  // namespace pleuel
