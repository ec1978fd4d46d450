#pragma once

#include <vector>

#include "core/base/error.hpp"
#include "core/scene/reading/json_node.hpp"

namespace pleuel {

/// Several mistakes of a file, told at once.
class Mistakes : public InputError {
 public:
  /// @param texts  at least two, each as an InputError says it
  explicit Mistakes(std::vector<std::string> texts);

  const std::vector<std::string>& texts() const { return texts_; }

 private:
  std::vector<std::string> texts_;
};

/// Goes on reading after a mistake, so that a reader learns of all that do not follow from another:
///
///     MistakeCollector mistakes;
///     mistakes.collect([&] { scene = read_scene(root.at("scene")); });
///     mistakes.collect([&] { simulation = read_simulation(root.at("simulation")); });
///     mistakes.fail_if_any();
class MistakeCollector {
 public:
  template <class Read>
  void collect(const Read& read) {
    try {
      read();
    } catch (const InputError& error) {
      add(error);
    }
  }

  /// @throws InputError  if there was a mistake
  /// @throws Mistakes    if there were several
  void fail_if_any() const;

 private:
  void add(const InputError& error);

  std::vector<std::string> texts_;
};

/// Calls read(name, member) for each member of an object.
/// @throws InputError or Mistakes of all of them
template <class Read>
void read_each(const JsonNode& node, const Read& read) {
  MistakeCollector mistakes;
  for (const auto& member : node.members()) {
    mistakes.collect([&] { read(member.first, member.second); });
  }
  mistakes.fail_if_any();
}

/// Those of an error, one or several.
std::vector<std::string> mistakes_of(const InputError& error);

/// @param texts  at least one
/// @throws InputError or Mistakes
[[noreturn]] void fail_with(std::vector<std::string> texts);

// Limits of a problem file that several readers share.

/// Numbers of a file are written rounded: what is off by less than this share is meant to agree.
inline constexpr double rounding_tolerance = 1e-9;

/// Points may be off a beam by this share of its length, and off a point mass by this share of the
/// scene: far more than what rounding of written numbers costs, far less than what is meant.
inline constexpr double placement_tolerance = 1e-6;

inline constexpr int most_elements = 10000;  ///< of a segment

}  // namespace pleuel
