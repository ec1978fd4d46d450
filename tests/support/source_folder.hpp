#pragma once

#include <string>

namespace pleuel {

/// The root of the checkout that the tests were built from. A function of one file, so that all other
/// files of tests are compiled alike wherever the checkout stands (ccache).
std::string source_folder();

}  // namespace pleuel
