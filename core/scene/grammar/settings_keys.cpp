#include <fmt/format.h>

#include "core/scene/grammar/tables.hpp"

namespace pleuel {

namespace {

constexpr Choice<SchemeType> schemes[] = {{"generalized-alpha", SchemeType::generalized_alpha},
                                          {"newmark", SchemeType::newmark},
                                          {"implicit-euler", SchemeType::implicit_euler}};
constexpr Choice<ConstraintForm> constraint_forms[] = {
    {"index-3", ConstraintForm::index_3},
    {"stabilized-index-2", ConstraintForm::stabilized_index_2},
    {"index-1", ConstraintForm::index_1}};
constexpr Choice<EffectChoice> effect_choices[] = {
    {"auto", EffectChoice::automatic}, {"on", EffectChoice::on}, {"off", EffectChoice::off}};
constexpr Measure time_span = {quantities::time, Range::positive};
constexpr double most_steps = 1e9;
constexpr double most_parts = 1e6;
constexpr WholeRange iterations = {1, 1000000};

void describe_formulation(Keys& keys, Formulation& s) {
  keys.choice(optional_key("formulation"), s.constraints, constraint_forms,
              "How constraints hold: as they stand, with their rates, or by their second "
              "derivatives, which lets them drift.");
  const bool is_index_1 = s.constraints == ConstraintForm::index_1;
  keys.must("baumgarte", is_index_1, "is for the formulation \"index-1\" only");
  keys.fixed(optional_key("baumgarte"), s.baumgarte, {quantities::rate, Range::positive},
             "b {}: index-1 with d2Phi/dt2 + 2 b dPhi/dt + b^2 Phi = 0 against the drift; by "
             "default without.");
  keys.flag(optional_key("projection"), s.is_projected,
            "Of index-1: each step ends with a projection of positions and velocities back to the "
            "constraints, so that nothing drifts.");
  keys.must("projection", is_index_1 || !s.is_projected, "is for the formulation \"index-1\" only");
}

void describe_step_control(Keys& keys, SimulationSettings& s) {
  keys.must("local_error", s.scheme == SchemeType::generalized_alpha,
            "is for the scheme \"generalized-alpha\" only");
  keys.must("local_error", s.formulation.constraints != ConstraintForm::index_3,
            "is for the formulations \"stabilized-index-2\" and \"index-1\" only");
  keys.plain(optional_key("local_error"), s.local_error, Range::tolerance,
             "Of generalized-alpha with stabilized-index-2 or index-1: what the local errors "
             "of each coordinate within one step may add up to, relative to its scale. Steps "
             "are halved until that holds; by default all steps are equal.");
  keys.must("smallest_step", s.local_error > 0.0, "is for a simulation with \"local_error\" only");
  keys.fixed(optional_key("smallest_step"), s.smallest_step, time_span,
             "To which halving with local_error may lead {}; default a 1024th of the step.");
  keys.must("smallest_step", s.smallest_step <= s.step, "must not be above the step",
            Shown::rule_and_value);
  keys.must("smallest_step", s.step <= most_parts * s.smallest_step,
            fmt::format("must not be below the step by more than {:g}", most_parts),
            Shown::rule_and_value);
}

}  // namespace

void describe(Keys& keys, SimulationSettings& s) {
  keys.about("Time integration.");
  keys.fixed("end_time", s.end_time, time_span, "{}.");
  keys.fixed("step", s.step, time_span, "{}.");
  keys.must("step", s.step <= s.end_time, "must not be longer than the simulation",
            Shown::rule_and_value);
  keys.must("step", s.end_time <= most_steps * s.step,
            fmt::format("must not make more than {:g} steps", most_steps), Shown::rule_and_value);
  keys.choice(optional_key("scheme"), s.scheme, schemes, "");
  describe_formulation(keys, s.formulation);
  describe_step_control(keys, s);
  keys.fixed(optional_key("spectral_radius"), s.spectral_radius,
             {quantities::pure_number, Range::fraction},
             "Of the scheme at infinite frequency (not of implicit-euler, whose is 0), {}: 1 keeps "
             "all vibrations, 0 kills the fast ones.");
  keys.plain(optional_key("newton_tolerance"), s.newton_tolerance, Range::tolerance,
             "A Newton iteration is the last one when the error left, relative to the scale of "
             "each coordinate, is estimated to be below this.");
  keys.whole(optional_key("max_newton_iterations"), s.max_newton_iterations, iterations, "");
  keys.other(optional_key("initial_state"), "initial_state", "");
  keys.flag(optional_key("moves_by_bending"), s.moves_by_bending,
            "Whether bodies are meant to bend where rigid ones cannot follow the drives to the "
            "end; else such a lock is an error.");
  keys.flag(optional_key("resolution_check"), s.checks_resolution,
            "Whether responses are compared with runs of other steps and elements, so that a "
            "warning names those that are not resolved. It costs about as much as the simulation.");
}

void describe(Keys& keys, SensitivitySettings& s) {
  keys.about("How gradients are computed.");
  keys.choice(optional_key("method"), s.method, gradient_methods,
              "auto: direct differentiation or the adjoint, whichever is faster.");
  keys.plain(optional_key("difference_step"), s.difference_step, Range::tolerance,
             "Relative step of the differences of simulations.");
  keys.choice(optional_key("invariant_derivatives"), s.invariants.derivatives,
              invariant_derivatives,
              "How the derivatives of the inertia integrals and stiffness of rigid bodies and "
              "beams come about.");
  const InvariantDerivatives made = s.invariants.derivatives;
  keys.must("invariant_step",
            made == InvariantDerivatives::central || made == InvariantDerivatives::forward,
            "is for the invariant derivatives \"central\" and \"forward\" only");
  keys.plain(optional_key("invariant_step"), s.invariants.step, Range::tolerance,
             "Relative step of central and forward. Default 6e-6 and 1.5e-8.");
  keys.fixed(optional_key("memory"), s.memory, {quantities::data, Range::positive},
             "What the states of a trajectory may take {}, such as \"512 MB\"; beyond that, "
             "stretches are simulated again. Default 4 GB, or a quarter of the memory of the "
             "machine if that is less.");
}

void describe(Keys& keys, EffectSettings& s) {
  keys.about("Which physical ideas take part: auto (by analysis of the scene), on or off.");
  const auto effect = [&](const char* word, EffectChoice& choice, const char* sentence) {
    keys.choice(optional_key(word), choice, effect_choices, sentence);
  };
  effect("spatial_motion", s.spatial_motion, "Motion out of the plane of a planar mechanism.");
  effect("geometric_stiffening", s.geometric_stiffening,
         "A tensile force makes a member stiffer in bending, a compressive one softer.");
  effect("rotary_inertia", s.rotary_inertia, "Of the cross-sections when a beam bends.");
  effect("elasticity", s.elasticity, "Of all beams: off makes them rigid.");
  effect("axial_elasticity", s.axial_elasticity, "Stretching of beams.");
  effect("torsional_elasticity", s.torsional_elasticity, "Twisting of beams.");
  keys.plain(optional_key("tolerance"), s.tolerance, Range::below_one,
             "Relative change of any response that dropping an effect may cause, {}. With 0 "
             "nothing is dropped.");
}

void describe(Keys& keys, OptimizerSettings& s) {
  keys.about("Who searches, and when it may stop.");
  keys.text(optional_key("backend"), s.backend,
            "nlopt-slsqp, nlopt-mma, nlopt-ccsaq, ipopt: this one alone. Default: nlopt-slsqp, and "
            "the others where it leads nowhere.");
  keys.other(optional_key("starts"), "starts", "");
  keys.plain(optional_key("tolerance"), s.tolerance, Range::tolerance,
             "Relative, on the objective and the scaled variables.");
  keys.whole(optional_key("max_iterations"), s.max_iterations, iterations, "");
}

}  // namespace pleuel
