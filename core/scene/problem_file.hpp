#pragma once

/// Everything that a problem file says, as plain structs.

#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/time_integration.hpp"
#include "core/scene/kind_table.hpp"
#include "core/scene/response_settings.hpp"

namespace pleuel {

enum class GradientMethod {
  automatic,  ///< direct or adjoint, whichever is cheaper (sensitivity/method_choice.hpp)
  direct,
  adjoint,
  forward_difference,
  central_difference
};

inline constexpr Choice<GradientMethod> gradient_methods[] = {
    {"auto", GradientMethod::automatic},
    {"direct", GradientMethod::direct},
    {"adjoint", GradientMethod::adjoint},
    {"forward-difference", GradientMethod::forward_difference},
    {"central-difference", GradientMethod::central_difference}};

std::string to_string(GradientMethod method);

/// @throws InputError for an unknown name; the message lists the names there are.
GradientMethod gradient_method(const std::string& name);

/// How the derivatives of a body's invariants with respect to the design come about.
enum class InvariantDerivatives {
  exact,         ///< dual numbers
  complex_step,  ///< the same arithmetic as that of dual numbers
  central,       ///< differences of the invariants of two changed designs
  forward        ///< of one changed design and this one
};
inline constexpr Choice<InvariantDerivatives> invariant_derivatives[] = {
    {"exact", InvariantDerivatives::exact},
    {"complex-step", InvariantDerivatives::complex_step},
    {"central", InvariantDerivatives::central},
    {"forward", InvariantDerivatives::forward}};

struct InvariantDifferentiation {
  InvariantDerivatives derivatives = InvariantDerivatives::exact;
  /// Of differences, relative: Δx = step · |x|. 0: as large as balances truncation and round-off.
  double step = 0.0;
};

/// How the derivatives of the invariants of rigid bodies and beams come about, and with them all
/// other derivatives; without it a model has none, and is otherwise the same.
using Differentiation = std::optional<InvariantDifferentiation>;

struct SensitivitySettings {
  GradientMethod method = GradientMethod::automatic;
  /// Of gradients by differences of simulations, relative: Δx = step · |x|.
  double difference_step = 1e-5;
  InvariantDifferentiation invariants;
  /// What the states of a trajectory may take [byte]; where they do not fit, stretches of it are
  /// simulated again when they are needed.
  double memory = 4e9;
};

/// Whether an effect is built: by analysis of the scene, always, or never.
enum class EffectChoice { automatic, on, off };

/// Relative changes of responses that leaving an effect out of a beam may cause, by estimate.
struct BeamEstimates {
  double elasticity = 0.0, axial_elasticity = 0.0, torsional_elasticity = 0.0;
  double geometric_stiffening = 0.0, rotary_inertia = 0.0;
};

/// What leaving an effect out of a beam was measured to change.
struct MeasuredEffect {
  bool is_needed = true;
  double change = 0.0;   ///< relative, of the response that changes most
  std::string response;  ///< its name
};

/// What a tolerance leaves out, decided before a design is simulated (decide_effects()), so that the
/// model is the same at all designs. Without entries nothing is left out.
struct EffectDecisions {
  /// By body. Without an entry an effect is built.
  std::map<std::string, BeamEstimates> estimates;
  /// By body and name of the effect; where estimates would leave it out.
  std::map<std::pair<std::string, std::string>, MeasuredEffect> measured;
};

struct EffectSettings {
  // Exact decisions:
  EffectChoice spatial_motion = EffectChoice::automatic;
  // Approximate ones, by the tolerance; without one `automatic` builds them:
  EffectChoice geometric_stiffening = EffectChoice::automatic;
  EffectChoice rotary_inertia = EffectChoice::automatic;
  EffectChoice elasticity = EffectChoice::automatic;  ///< all of it
  EffectChoice axial_elasticity = EffectChoice::automatic;
  EffectChoice torsional_elasticity = EffectChoice::automatic;
  /// Relative change of any response that dropping an effect may cause; 0: nothing is dropped. What
  /// is dropped the decisions say, which are made for it.
  double tolerance = 0.0;
  EffectDecisions decisions = {};
};

struct SimulationSettings : TimeIntegration {
  /// Starts from elastic equilibrium under the initial accelerations, without vibration.
  bool quasi_static_start = false;
  /// Whether bodies are meant to bend where rigid ones could not follow the drives.
  bool moves_by_bending = false;
  /// Whether runs with other steps and elements judge what is resolved (core/trust/resolution.hpp).
  bool checks_resolution = true;
};

/// A size that there is.
struct SizeChoice {
  double value = 0.0;  ///< [SI]; of a section its place in the list, from 0
  std::string text;    ///< "25 mm", or the name of a section: as the user wrote it
  bool operator==(const SizeChoice&) const = default;
};

struct DesignVariable {
  std::string name;
  double start = 0.0, lower = 0.0, upper = 0.0;  ///< SI
  std::string unit;                             ///< as the user wrote it, for display; may be empty
  Quantity quantity = quantities::pure_number;  ///< what it measures
  /// What it is to be chosen from, in ascending order; empty: any number between the bounds. Sections
  /// ascend by area.
  std::vector<SizeChoice> choices = {};

  bool has_choices() const { return !choices.empty(); }
};

/// Whether the objective is to be small or large.
enum class Aim { minimize, maximize };

/// How the numbers that a response has in several load cases make one objective.
enum class OverCases {
  same,     ///< there is one number only: no cases, or the same in all
  worst,    ///< the largest of what is minimized, the smallest of what is maximized
  weighted  ///< a sum with weights
};

struct Objective {
  std::string response;
  Aim aim = Aim::minimize;
  OverCases over_cases = OverCases::same;
  /// Of `weighted`, by case or range of cases; empty: a plain sum.
  std::vector<std::pair<std::string, double>> weights = {};

  /// What is minimized is this times the response: a problem of optimization knows minima only.
  double sign() const { return aim == Aim::maximize ? -1.0 : 1.0; }
};

/// lower ≤ response ≤ upper, or lower ≤ Σ coefficient · variable ≤ upper; SI.
struct ConstraintSettings {
  std::string name;
  std::string response;                        ///< empty for a linear constraint
  std::vector<std::pair<int, double>> linear;  ///< (variable, coefficient)
  std::optional<double> lower, upper;
  /// k: standard deviations of its value (see UncertaintySettings) that are kept free of the limit.
  double deviations = 0.0;
  /// Load cases, or ranges of them, that it holds in; empty: in all.
  std::vector<std::string> cases = {};
};

struct OptimizerSettings {
  std::string backend = "nlopt-slsqp";
  bool names_backend = false;  ///< the file does: no other one is tried
  double tolerance = 1e-6;     ///< relative, on objective and scaled variables
  int max_iterations = 200;
  /// Designs that the search begins at, that of the variables included.
  int starts = 1;
  /// In place of designs between the bounds: so many more [SI], one number a variable.
  std::vector<std::vector<double>> given_starts = {};
};

/// ε-constraint study: the objective is minimized for a row of values of one limit.
struct ParetoSettings {
  std::string constraint;       ///< whose limit is varied; empty between two responses
  double from = 0.0, to = 0.0;  ///< first and last limit, SI
  int points = 7;               ///< at equal steps of the limit
  /// The largest distance of neighbours that is left, both goals over their ranges: more points come
  /// between those of larger ones (front_gaps.hpp). 0: none come.
  double gap = 0.0;
  int most_points = 100;  ///< with a gap; those at equal steps among them
  /// Two of them: the front is that between these responses, from the best of one to the best of
  /// the other. None: between objective and constraint.
  std::vector<Objective> goals = {};
};

/// How accurate answers must be, and the grid of the work–precision study: every step size with
/// every number of elements, against a finer reference; empty lists are filled by the study.
struct AccuracySettings {
  std::vector<double> steps;  ///< [s]
  std::vector<int> elements;  ///< per segment
  /// Relative error that what is minimized or limited may have.
  double target = 1e-2;
  /// Whether the file names the target: steps, elements and effects are chosen for it then.
  bool chooses_setting = false;
  /// Responses whose accuracy is asked for besides those that are minimized or limited.
  std::vector<std::string> responses;
};

/// A variable that is not exactly what it is said to be; of a fixed one (lower == upper) just as of
/// one that is designed. Either a deviation or an interval is positive.
struct UncertainParameter {
  int variable;
  double deviation = 0.0;  ///< standard deviation of a normal distribution [SI]
  double interval = 0.0;   ///< half width of a uniform distribution [SI]

  double standard_deviation() const {
    return deviation > 0.0 ? deviation : interval / std::sqrt(3.0);
  }
  /// Three deviations of a normal distribution.
  double half_width() const { return interval > 0.0 ? interval : 3.0 * deviation; }
};

struct UncertaintySettings {
  std::vector<UncertainParameter> parameters;
  int samples = 0;  ///< of Monte Carlo
  unsigned seed = 1;
};

/// Which number of which load case.
struct OfCase {
  std::size_t load_case = 0;  ///< index in ProblemFile::cases
  std::size_t index = 0;      ///< of the response or the constraint in the problem of that case
};

/// A file without load cases, or one case of a file as if it had no other. Of a file with cases what
/// all of them share: the variables, and responses and constraints of all cases, each with its case
/// in its name (load_cases.hpp); its scene and settings are those of the first case, and only the
/// problems of the cases can be simulated.
struct ProblemFile {
  std::string name, description;
  Scene scene;
  EffectSettings effects;
  SimulationSettings simulation;
  SensitivitySettings sensitivity;
  std::vector<DesignVariable> variables;
  std::vector<ResponseSettings> responses;
  std::optional<Objective> objective;
  std::vector<ConstraintSettings> constraints;
  OptimizerSettings optimizer;
  std::optional<ParetoSettings> pareto;
  AccuracySettings accuracy;
  std::optional<UncertaintySettings> uncertainty;

  std::string load_case = {};   ///< its name, of the problem of a case
  std::string case_range = {};  ///< that it is one of; empty: it stands for itself
  std::vector<ProblemFile> cases = {};
  std::vector<OfCase> case_responses = {}, case_constraints = {};  ///< one a response, a constraint
  std::vector<double> case_weights = {};  ///< one a case, where the objective is a weighted sum

  bool has_cases() const { return !cases.empty(); }
};

/// No sample of an uncertain parameter is farther from its value than this: six deviations of a
/// normal distribution, the interval of a uniform one.
inline double sample_extent(const UncertainParameter& parameter) {
  return parameter.interval > 0.0 ? parameter.interval : 6.0 * parameter.deviation;
}

}  // namespace pleuel
