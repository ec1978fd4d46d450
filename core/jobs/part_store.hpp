#pragma once

#include <optional>
#include <string>

#include "core/base/packed.hpp"

namespace pleuel {

/// Parts of a study that are kept, so that none has to be computed twice.
class PartStore {
 public:
  virtual ~PartStore() = default;
  virtual std::optional<std::string> find_part(const std::string& name) = 0;
  virtual void keep_part(const std::string& name, const std::string& content) = 0;
};

/// The part of this name: what is known of it, or what make() returns, which is kept then.
/// @param parts  may be null: nothing is known or kept
template <class Make>
auto kept_part(PartStore* parts, const std::string& name, const Make& make) {
  using Part = decltype(make());
  if (parts != nullptr) {
    if (const auto content = parts->find_part(name)) return unpacked<Part>(*content);
  }
  Part part = make();
  if (parts != nullptr) parts->keep_part(name, packed(part));
  return part;
}

}  // namespace pleuel
