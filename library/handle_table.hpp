#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "library/call_error.hpp"

namespace pleuel {

/// What another program knows by numbers: none is used twice, and others name nothing, whatever they are.
template <class Thing>
class HandleTable {
 public:
  /// @param refusal  of numbers that name nothing: "the problem {} is not open"
  explicit HandleTable(const char* refusal) : refusal_(refusal) {}

  std::uint64_t add(std::shared_ptr<Thing> thing) {
    const std::lock_guard lock(mutex_);
    things_.emplace(++last_, std::move(thing));
    return last_;
  }

  /// @throws CallError if there is none of this number
  std::shared_ptr<Thing> find(std::uint64_t number) {
    const std::lock_guard lock(mutex_);
    return place_of(number)->second;
  }

  /// @throws CallError if there is none of this number
  std::shared_ptr<Thing> remove(std::uint64_t number) {
    const std::lock_guard lock(mutex_);
    const auto place = place_of(number);
    std::shared_ptr<Thing> removed = std::move(place->second);
    things_.erase(place);
    return removed;
  }

 private:
  auto place_of(std::uint64_t number) {
    const auto place = things_.find(number);
    if (place == things_.end()) throw CallError(fmt::format(fmt::runtime(refusal_), number));
    return place;
  }

  const char* refusal_;
  std::mutex mutex_;
  std::uint64_t last_ = 0;
  std::unordered_map<std::uint64_t, std::shared_ptr<Thing>> things_;
};

}  // namespace pleuel
