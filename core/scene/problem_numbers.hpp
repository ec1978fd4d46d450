#pragma once

#include <string>
#include <vector>

#include "core/scene/problem_file.hpp"
#include "core/scene/problem_text.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/units.hpp"

/// The fixed numbers of a problem file that design variables could stand for: what a price or an
/// influence can be asked of although the file does not vary it.
namespace pleuel {

/// A fixed number of the scene.
struct SceneNumber {
  std::string pointer;  ///< JSON pointer into the file, with sections of a catalogue written out
  double value = 0.0;   ///< [SI]
  Quantity quantity;
  std::string unit;  ///< as the user wrote it; may be empty
};

/// Those that could be bound to a variable, in the order of reading; constants of materials of the
/// library that the scene uses are among them, as if the file declared these.
/// @throws InputError as read_problem_text()
std::vector<SceneNumber> scene_numbers(const ProblemText& text);

/// Numbers that move together, as the coordinates of a point that several bodies and joints share.
struct NumberGroup {
  std::string name;                   ///< of the variable that stands for them
  std::vector<std::string> pointers;  ///< of SceneNumbers with one value and quantity, at least one
};

/// The problem with a further variable for each group, in their order after those of the file and
/// fixed at the value that the numbers have. Everything it decides at its start stays as it was,
/// unless a number is bound that is decided upon (a coordinate that may leave the plane).
/// @throws InputError as read_problem_text(); if a number would move a point along an elastic beam
ProblemFile bind_numbers(const ProblemText& text, const std::vector<NumberGroup>& groups);

}  // namespace pleuel
