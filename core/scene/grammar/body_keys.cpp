#include <numbers>

#include "core/scene/grammar/tables.hpp"

namespace pleuel {

void describe(Keys& keys, Material& s) {
  constexpr Measure stress = {quantities::stress, Range::positive};
  keys.about("Linear elastic, isotropic.");
  keys.number("young", s.young, stress, "Young's modulus {}.");
  keys.number("poisson", s.poisson, {quantities::pure_number, Range::poisson},
              "Poisson's ratio, {}.");
  keys.number("density", s.density, {quantities::density, Range::positive}, "Density {}.");
  keys.number(optional_key("strength"), s.strength, stress,
              "Stress that it bears, of yield {}; for responses that compare with it.");
  keys.number(optional_key("ultimate_strength"), s.ultimate_strength, stress,
              "Stress at which it breaks {}; for fatigue.");
  keys.number(optional_key("endurance_limit"), s.endurance_limit, stress,
              "Amplitude of stress without mean that the part bears for ever {}: with its surface, "
              "size and reliability; for fatigue.");
  keys.number(optional_key("fatigue_strength"), s.fatigue_strength, stress,
              "s of Basquin's line, amplitude = s (2N)^(-1/k) of stress without mean {}; for "
              "fatigue-damage.");
  keys.fixed(optional_key("fatigue_exponent"), s.fatigue_exponent,
             {quantities::pure_number, Range::positive},
             "k of Basquin's line, at least 1, 5 to 15 for metals; for fatigue-damage.");
  keys.must("fatigue_exponent", s.fatigue_exponent.value_or(1.0) >= 1.0,
            "must be at least 1 (k of Basquin's line, 5 to 15 for metals; its slope b is -1/k)",
            Shown::rule_and_value);
  const std::optional<Number>& ultimate = s.ultimate_strength;
  for (const auto& [word, strength] :
       {std::pair("strength", &s.strength), std::pair("endurance_limit", &s.endurance_limit)}) {
    const bool are_numbers =
        *strength && ultimate && !(*strength)->is_bound() && !ultimate->is_bound();
    keys.must(word, !are_numbers || (*strength)->constant <= ultimate->constant,
              "must not be more than the \"ultimate_strength\"", Shown::rule_and_value);
  }
}

void describe(Keys& keys, Damping& s) {
  keys.about(
      "Rayleigh damping, D = mass * M + stiffness * K, or a ratio for all modes of a reduced "
      "beam.");
  keys.exclusive("modal", "mass");
  keys.exclusive("modal", "stiffness");
  keys.number(optional_key("mass"), s.mass, {quantities::rate, Range::not_negative}, "{}.");
  keys.number(optional_key("stiffness"), s.stiffness, {quantities::time, Range::not_negative},
              "{}.");
  keys.number(optional_key("modal"), s.modal, {quantities::pure_number, Range::below_one},
              "Damping ratio of every mode, {}; needs a reduction.");
}

void describe(Keys& keys, BeamBody& s, const std::vector<std::string>& materials) {
  constexpr const char* not_rigid = "is not for a rigid beam";
  keys.point("from", s.from, quantities::length, "");
  keys.point("to", s.to, quantities::length, "");
  keys.name("material", "material", materials, s.material, "");
  keys.choice(optional_key("frame"), s.frame, reference_conditions, "");
  keys.flag(optional_key("rigid"), s.is_rigid, "");
  keys.must("damping", !s.is_rigid, not_rigid);
  keys.must("reduction", !s.is_rigid, not_rigid);
  keys.object(optional_key("damping"), s.damping);
  keys.object(optional_key("reduction"), s.reduction);
  keys.flag(optional_key("shear"), s.has_shear, "");
  keys.must("shear", !s.is_rigid || !s.has_shear, not_rigid);
  keys.whole(optional_key("frames"), s.frames, {1, 1000}, "");
  keys.must("frames", !s.is_rigid || s.frames == 1, not_rigid);
  keys.direction(optional_key("reference"), s.reference, "");
}

void describe(Keys& keys, RigidBody& s) {
  keys.about("A rigid body.");
  keys.point("at", s.at, quantities::length, "Centre of mass at the start {}.");
  keys.number("mass", s.mass, {quantities::mass, Range::positive}, "{}.");
  keys.other("inertia", "inertia", "");
}

void describe(Keys& keys, PointMass& s) {
  keys.about("A mass without extent.");
  keys.point("at", s.at, quantities::length, "At the start {}.");
  keys.number("mass", s.mass, {quantities::mass, Range::positive}, "{}.");
}

void describe(Keys& keys, ImportedBody& s) {
  constexpr Choice<bool> elsewhere[] = {{"refuse", false}, {"linear", true}};
  keys.about(
      "A flexible body from any finite-element code, by its invariants (docs/invariants.md).");
  keys.one_at_least({"file", "generator"});
  keys.exclusive("file", "generator");
  keys.exclusive("generator", "other_designs");
  keys.other(optional_key("file"), "name", "From the folder of the problem file on.");
  keys.other(optional_key("generator"), "generator", "");
  keys.point("from", s.from, quantities::length, "Origin of the body frame at the start {}.");
  keys.point("to", s.to, quantities::length, "A point on its local x axis {}.");
  keys.direction(optional_key("reference"), s.reference,
                 "Local y is the part of this vector normal to local x; as of a beam.");
  keys.refused("frames",
               "is for beams: a body from a file has one frame; where it bends far, import it in "
               "several, joined by fixed joints");
  keys.choice(optional_key("other_designs"), s.is_linear, elsewhere,
              "At other designs than that of the file: an error, or its numbers continued "
              "linearly.");
}

void describe(Keys& keys, BodyGenerator& s) {
  constexpr Choice<bool> derivatives[] = {{"given", true}, {"differences", false}};
  keys.about(
      "A program that makes the body for each design, with --allow-programs only, in the folder of "
      "the problem file: it reads {\"body\", \"variables\": {name: SI value}} from standard input "
      "and writes a file of invariants to standard output (docs/invariants.md).");
  keys.other(optional_key("command"), "words",
             "The program and its arguments. A function that is registered in the library takes "
             "its place.");
  keys.other("variables", "units_of_variables",
             "The design variables that the body depends on, each with its SI unit.");
  keys.choice("derivatives", s.gives_derivatives, derivatives,
              "Whether the body has them with it, or they are forward differences, of one call "
              "more for each variable.");
  keys.fixed(optional_key("step"), s.step, {quantities::pure_number, Range::positive},
             "Of the differences, relative.");
  keys.fixed(optional_key("time_limit"), s.time_limit, {quantities::time, Range::positive},
             "Of a call {}.");
  keys.other(optional_key("files"), "words",
             "That the program reads, besides those that its command names: where one of them "
             "changes, what was made before is forgotten.");
  keys.must("step", s.step <= 0.1, "must be at most 0.1: it is relative", Shown::rule_and_value);
}

void describe(Keys& keys, InitialDeflection& s) {
  keys.point("at", s.at, quantities::length, "A place on the undeformed body at the start {}.");
  keys.unit_vector("direction", s.direction, "Of the displacement, global axes at the start.");
  keys.one_at_least({"displacement", "rate"});
  keys.number(optional_key("displacement"), s.displacement, {quantities::length},
              "At the start {}.");
  keys.number(optional_key("rate"), s.rate, {quantities::speed}, "At the start {}.");
}

void describe(Keys& keys, CraigBampton& s) {
  keys.about(
      "Craig-Bampton reduction of bending and torsion: the static modes of joints and loads, and "
      "fixed-interface modes, as many as \"modes\" says or all below a frequency.");
  keys.exclusive("modes", "frequency");
  keys.one_at_least({"modes", "frequency"});
  keys.whole(optional_key("modes"), s.modes, {0, 1000},
             "Number of fixed-interface modes of each family: bending in each of the two planes of "
             "the beam, torsion, axial vibration (without geometric stiffening, which keeps all "
             "axial displacements). So it means the same in a plane and in space.");
  std::optional<double> cycles;
  keys.fixed(optional_key("frequency"), cycles, {quantities::frequency, Range::positive},
             "{}: a plain number is in Hz.");
  if (cycles) s.frequency = 2.0 * std::numbers::pi * *cycles;
}

void describe(Keys& keys, Segment& s) {
  keys.about("A stretch of a beam with one section.");
  keys.other("section", "section", "");
  keys.whole("elements", s.elements, {1, 10000}, "Number of finite elements.");
  keys.fixed(optional_key("length_fraction"), s.fraction,
             {quantities::pure_number, Range::positive},
             "Share of the length, in all segments or in none; their sum is 1. By default in "
             "proportion to the elements.");
}

}  // namespace pleuel
