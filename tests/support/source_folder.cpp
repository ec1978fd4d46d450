#include "tests/support/files.hpp"

namespace pleuel {

std::string source_folder() {
  return PLEUEL_SOURCE_DIR;
}

}  // namespace pleuel
