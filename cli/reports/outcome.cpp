#include "cli/reports/outcome.hpp"

#include <fmt/format.h>

namespace pleuel {

std::string study_status(bool is_whole) {
  return is_whole ? "done" : "interrupted";
}

std::string interrupted_text(std::size_t done, std::size_t all, const std::string& what) {
  return fmt::format("INTERRUPTED: {} of {} {} were done\n\n", done, all, what);
}

}  // namespace pleuel
