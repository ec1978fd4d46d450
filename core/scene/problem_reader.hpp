#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// A problem as its file says it. Where the file has a tolerance of effects, simulations decide what
/// that leaves out; nobody has asked them yet, so that it has to be said which model is meant:
/// complete(), or decided() (core/response/effect_measurement.hpp).
class UndecidedProblem {
 public:
  explicit UndecidedProblem(ProblemFile complete) : complete_(std::move(complete)) {}

  /// With all effects that the file does not forbid, whatever its tolerance. Names, units and limits
  /// are the same in both.
  const ProblemFile& complete() const& { return complete_; }
  ProblemFile complete() && { return std::move(complete_); }

 private:
  ProblemFile complete_;
};

/// Reads and checks a problem file: syntax, keys, types, names, and what can be said of the
/// values without mechanics. What it returns has all defaults and is in SI units.
/// @param overrides  each "/json/pointer=value", applied in this order before anything is checked;
///                   a value that is not JSON is a text: /simulation/step=0.1 ms
/// @throws InputError  "file: pointer rule, got value".
UndecidedProblem read_problem(const std::filesystem::path& path,
                              const std::vector<std::string>& overrides = {});

/// The same for a text.
/// @param file  how messages name it; a catalogue of sections is looked for in its folder (the
///              current one if the name has none).
UndecidedProblem read_problem_text(const std::string& text, const std::string& file,
                                   const std::vector<std::string>& overrides = {});

}  // namespace pleuel
