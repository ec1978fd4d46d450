#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/honesty/judged_values.hpp"

/// What bars are worth, over many values.
namespace pleuel::test {

/// Of values that have errors: masses and other exact numbers are left out.
struct Honesty {
  int values = 0;
  int unresolved = 0;          ///< said to be
  int missed = 0;              ///< resolved, and the error is beyond the bar
  std::vector<double> ratios;  ///< bar over error of resolved ones, ascending

  double unresolved_share() const;
  /// Covered or said to be unresolved, of all.
  double honest_share() const;
  /// Covered, of resolved ones.
  double covered_share() const;
  double ratio_at(double share) const;  ///< 0.5: the median
};

Honesty honesty_of(const std::vector<JudgedValue>& values);

/// Those for which something holds.
std::vector<JudgedValue> those(const std::vector<JudgedValue>& values,
                               const std::function<bool(const JudgedValue&)>& holds);

using Group = std::function<std::string(const JudgedValue&)>;

/// What a value is, in words: its type with what is made of it over time.
std::string kind_of(const JudgedValue& value);
/// Whether the step or the elements make most of its error.
std::string cause_of(const JudgedValue& value);
/// "step × 4, elements × 0.5"
std::string coarseness_of(const JudgedValue& value);

/// Prints a table in Markdown with a line a group, in alphabetic order, and one of all.
void print_table(const std::string& title, const std::vector<JudgedValue>& values,
                 const Group& group);

/// Prints the values that bars miss by most, relative to the bar.
void print_worst(const std::vector<JudgedValue>& values, std::size_t count);

}  // namespace pleuel::test
