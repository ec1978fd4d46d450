#include "core/scene/grammar/response_table.hpp"

namespace pleuel::response_tables {

namespace {

constexpr Choice<DriftLevel> levels[] = {{"position", DriftLevel::position},
                                         {"velocity", DriftLevel::velocity}};
constexpr WholeRange mode_numbers = {1, 1000};

/// The axis that a mode has to be along.
void mode_axis(Keys& keys, ModeChoice& mode, std::string_view sentence) {
  int axis = -1;
  keys.choice_or_vector(optional_key("direction"), axis, axes, mode.axis, sentence);
  if (axis < 0) return;
  mode.axis.emplace();
  (*mode.axis)[axis] = 1.0;
}

void frequency(Keys& keys, ModeResponse& r, const Scope& scope) {
  keys.about(
      "Natural frequency [rad/s], in space whatever the motion has: of an elastic beam in its "
      "frame, or without a body of the whole mechanism at its initial configuration; a mode that "
      "grows as exp(g t) is -g.");
  keys.refused("over_time", "is not for a frequency, which does not change in time");
  const Body* one = body(keys, optional_key("body"), r.body, scope, "An elastic beam.");
  if (shape_of<ImportedBody>(one) == nullptr) elastic_beam(keys, one);
  int mode = r.mode.number + 1;
  keys.whole(optional_key("mode"), mode, mode_numbers, "Counted from 1, the lowest.");
  r.mode.number = mode - 1;
  mode_axis(keys, r.mode,
            "Only modes that are motion along this axis, or this vector, count: more than half of "
            "their kinetic energy. Of a body in its own axes, else in global ones.");
}

void damped_mode(Keys& keys, ModeChoice& choice) {
  const bool is_ratio = choice.of == ModeNumber::damping_ratio;
  keys.about(
      "Of small vibrations of the whole mechanism about its initial configuration, exp(s t): "
      "damping-ratio is -Re s/|s|, growth-rate is Re s [1/s]. Of the mode that is damped least, or "
      "grows fastest.");
  keys.refused("over_time", "is not for a number of a mode, which does not change in time");
  std::optional<int> mode;
  if (is_ratio) {
    keys.whole(optional_key("mode"), mode, mode_numbers,
               "That of this vibration, counted from 1, the slowest.");
  }
  choice.number = mode ? *mode - 1 : ModeChoice::worst;
  mode_axis(keys, choice,
            "Only modes that are motion along this global axis, or this vector, count: more than "
            "half of their kinetic energy.");
}

}  // namespace

void describe(Keys& keys, MassResponse& mass, R&, const Scope& scope) {
  keys.about("Mass [kg] of the bodies named, or of all.");
  keys.refused("over_time", "is not for a mass, which does not change in time");
  keys.exclusive("body", "bodies");
  body(keys, optional_key("body"), mass.bodies, scope);
  keys.names(optional_key("bodies"), "body", names_of(scope.scene.bodies), mass.bodies, "");
}

void describe(Keys& keys, ModeResponse& r, R&, const Scope& scope) {
  r.mode.counts_damping() ? damped_mode(keys, r.mode) : frequency(keys, r, scope);
}

void describe(Keys& keys, EnergyResponse& energy, R& r, const Scope& scope) {
  keys.about("Energy [J] of one body or, by default, of all.");
  const Body* one = body(keys, optional_key("body"), energy.body, scope,
                         "For an elastic energy an elastic beam.");
  const bool is_elastic = energy.kind == EnergyKind::elastic;
  if (is_elastic && shape_of<ImportedBody>(one) == nullptr) elastic_beam(keys, one);
  history(keys, r, scope);
}

void describe(Keys& keys, EnergyBalanceResponse&, R& r, const Scope& scope) {
  keys.about(
      "What is missing in the balance of energy and work [J] between the ends of the simulation or "
      "of the window: an error of the time integration.");
  keys.refused("over_time", "is not for an energy-balance, which compares two times");
  r.over_time = OverTime::final;
  window(keys, r, scope);
}

void describe(Keys& keys, DriftResponse& drift, R& r, const Scope& scope) {
  keys.about(
      "Error of the equations of joints and drives [m, rad or a cosine], or of their rates; "
      "max-abs "
      "is that of the worst equation.");
  keys.choice(optional_key("level"), drift.level, levels, "Of the equations or of their rates.");
  history(keys, r, scope);
}

void describe(Keys& keys, ExpressionResponse&, R& r, const Scope&) {
  keys.about("A formula of other responses, design variables and constants.");
  std::string value;
  keys.text("value", value,
            "Such as \"x_max - x_min\" or \"'tip deflection'/(2 mm) + mass/(1 kg)\".");
  keys.text(optional_key("unit"), r.unit, "In which reports show it; it must fit the formula.");
}

}  // namespace pleuel::response_tables

namespace pleuel {

void describe(Keys& keys, ResponseSettings& response, const ResponseScope& scope) {
  std::visit([&](auto& one) { response_tables::describe(keys, one, response, scope); },
             response.what);
}

}  // namespace pleuel
