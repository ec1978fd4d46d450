#include "cli/input/version_text.hpp"

#include <fmt/format.h>

#include "cli/commit.hpp"
#include "cli/versions.hpp"

namespace pleuel {

std::string version_text() {
  return fmt::format("pleuel {} (commit {}, {}, {}, {})", versions::pleuel, versions::commit,
                     versions::compiler, versions::build_type, versions::processor);
}

}  // namespace pleuel
