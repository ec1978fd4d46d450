#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.hpp"

/// Everything that a problem file says, as plain structs.
namespace pleuel {

/// Whether an effect is built: by analysis of the scene, always, or never.
enum class EffectChoice { automatic, on, off };

struct EffectSettings {
  EffectChoice spatial_motion = EffectChoice::automatic;
  EffectChoice geometric_stiffening = EffectChoice::automatic;
};

struct SimulationSettings {
  double end_time = 0.0;         ///< [s]
  double step = 0.0;             ///< [s]
  double spectral_radius = 0.8;  ///< ρ∞ of generalized-α, in [0, 1]
  /// Newton's method ends when the error left, relative to the scale of each coordinate, is
  /// estimated to be below this.
  double newton_tolerance = 1e-10;
  int max_newton_iterations = 20;
};

struct DesignVariable {
  std::string name;
  double start = 0.0, lower = 0.0, upper = 0.0;  ///< SI
  std::string unit;  ///< as the user wrote it, for display; may be empty
};

enum class ResponseType { mass, stress, deflection, position, drive_torque };
enum class OverTime { max, min, max_abs, rms, mean, integral, final };

struct ResponseSettings {
  std::string name;
  ResponseType type = ResponseType::mass;
  std::vector<std::string> bodies;  ///< mass: those counted (empty = all); else the one body
  std::optional<int> segment;       ///< stress: only this segment, from 0
  double at = 0.0;                  ///< deflection, position: place along the beam, 0 … 1
  int direction = 1;  ///< deflection: 1 = local y, 2 = local z; position: 0 … 2 global
  std::string joint;  ///< drive torque
  OverTime over_time = OverTime::max;
};

struct Objective {
  std::string response;
  double scale = 0.0;  ///< 0 = chosen automatically from the start value
};

/// lower ≤ response ≤ upper, or lower ≤ Σ coefficient · variable ≤ upper; SI.
struct ConstraintSettings {
  std::string name;
  std::string response;                        ///< empty for a linear constraint
  std::vector<std::pair<int, double>> linear;  ///< (variable, coefficient)
  std::optional<double> lower, upper;
};

struct OptimizerSettings {
  std::string backend = "nlopt-slsqp";
  double tolerance = 1e-6;  ///< relative, on objective and scaled variables
  int max_iterations = 200;
};

/// ε-constraint study: the objective is minimized for a row of values of one limit.
struct ParetoSettings {
  std::string constraint;       ///< whose limit is varied
  double from = 0.0, to = 0.0;  ///< first and last limit, SI
  int points = 7;
};

/// Work–precision study: every step size with every number of elements, against a finer reference.
struct AccuracySettings {
  std::vector<double> steps;  ///< [s]
  std::vector<int> elements;  ///< per segment
  double error = 1e-3;        ///< relative error for which the cheapest setting is recommended
};

struct ProblemFile {
  std::string name, description;
  Scene scene;
  EffectSettings effects;
  SimulationSettings simulation;
  std::vector<DesignVariable> variables;
  std::vector<ResponseSettings> responses;
  std::optional<Objective> objective;
  std::vector<ConstraintSettings> constraints;
  OptimizerSettings optimizer;
  std::optional<ParetoSettings> pareto;
  std::optional<AccuracySettings> accuracy;
};

}  // namespace pleuel
