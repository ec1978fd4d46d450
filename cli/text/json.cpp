#include "cli/text/json.hpp"

namespace pleuel {

std::string to_text(const Json& document) {
  // A file name need not be UTF-8; a result must be written nevertheless.
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace pleuel
