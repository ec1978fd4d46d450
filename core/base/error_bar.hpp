#pragma once

#include <map>
#include <optional>
#include <string>

/// How far a computed number may be from the one that is meant.
namespace pleuel {

/// What a number lacks by one cause [its unit].
struct ErrorPart {
  double change = 0.0;      ///< estimate of (limit of a fine division − value), signed
  double bound = 0.0;       ///< what |limit − value| is expected to stay within
  bool is_resolved = true;  ///< false: runs disagree; the bound is what they differ by, if known

  /// That of `factor` times the number on top.
  void add(const ErrorPart& part, double factor = 1.0) {
    if (factor == 0.0) return;
    change += factor * part.change;
    bound += (factor < 0.0 ? -factor : factor) * part.bound;
    is_resolved = is_resolved && part.is_resolved;
  }
};

/// The error of a number, by cause.
struct ErrorBar {
  ErrorPart step;
  ErrorPart elements;           ///< with the modes of reduced beams
  ErrorPart newton;             ///< by the tolerance of Newton's method
  ErrorPart effects;            ///< that were left out by a tolerance
  std::optional<double> order;  ///< observed, in the step; of a single response
  bool is_modelled =
      true;  ///< false: what it is about is not in the equations, and no bar says how far it is off
  /// What the model leaves out would change, by its name (core/trust/model_variants.cpp): beside the bound.
  std::map<std::string, double> left_out;

  double change() const { return step.change + elements.change + newton.change + effects.change; }
  double bound() const { return step.bound + elements.bound + newton.bound + effects.bound; }
  bool is_resolved() const {
    return is_modelled && step.is_resolved && elements.is_resolved && newton.is_resolved &&
           effects.is_resolved;
  }

  void add_left_out(const ErrorBar& bar, double factor) {
    for (const auto& [name, change] : bar.left_out) left_out[name] += factor * change;
  }

  /// That of `factor` times the number on top.
  void add(const ErrorBar& bar, double factor = 1.0) {
    step.add(bar.step, factor);
    elements.add(bar.elements, factor);
    newton.add(bar.newton, factor);
    effects.add(bar.effects, factor);
    add_left_out(bar, factor);
    is_modelled = is_modelled && bar.is_modelled;
    order.reset();
  }
};

}  // namespace pleuel
