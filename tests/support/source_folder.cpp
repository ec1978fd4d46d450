#include "tests/support/source_folder.hpp"

namespace pleuel {

std::string source_folder() {
  return PLEUEL_SOURCE_DIR;
}

}  // namespace pleuel
