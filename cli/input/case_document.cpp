#include "cli/input/case_document.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/scene/reading/document_reader.hpp"

namespace pleuel {

Json document_in_case(const Json& document, const std::string& load_case, const std::string& file) {
  for (const CaseChanges& changes : cases_of(document, file)) {
    if (changes.name == load_case) return lone_document(document, changes, file);
  }
  throw InputError(fmt::format("{}: /cases has no case \"{}\"", file, load_case));
}

}  // namespace pleuel
