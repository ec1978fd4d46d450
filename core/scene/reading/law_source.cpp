#include "core/scene/reading/law_source.hpp"

namespace pleuel {

void LawSource::allow_keys(std::vector<std::string_view> keys) const {
  keys.insert(keys.begin(), "type");
  keys.insert(keys.end(), other_keys.begin(), other_keys.end());
  node.allow_keys(keys);
}

}  // namespace pleuel
