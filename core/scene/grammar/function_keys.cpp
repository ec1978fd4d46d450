#include "core/scene/grammar/tables.hpp"

namespace pleuel {

namespace {

constexpr Measure instant = {quantities::time};
constexpr Measure duration = {quantities::time, Range::positive};

}  // namespace

void describe(Keys& keys, ConstantFunction& s, const Quantity& value) {
  keys.about("The same value at all times.");
  keys.number("value", s.value, {value}, "");
}

void describe(Keys& keys, ConstantSpeedDrive& s, const Quantity& value) {
  keys.number("speed", s.speed, {per_time(value)}, "{}");
}

void describe(Keys& keys, RampToSpeedDrive& s, const Quantity& value) {
  keys.number("speed", s.speed, {per_time(value)}, "Speed W after the ramp {}.");
  keys.number("ramp", s.ramp, duration,
              "Duration T of the smooth ramp {}: the acceleration is (W/T)(1 - cos(2 pi t/T)).");
}

void describe(Keys& keys, HarmonicFunction& s, const Quantity& value) {
  keys.about("offset + amplitude * sin(frequency * t + phase)");
  keys.number("amplitude", s.amplitude, {value}, "");
  keys.number("frequency", s.frequency, {quantities::angular_frequency, Range::positive},
              "{}: a plain number is in rad/s; \"40 Hz\" is 40 cycles a second.");
  keys.number(optional_key("phase"), s.phase, {quantities::angle}, "{}.");
  keys.number(optional_key("offset"), s.offset, {value}, "");
}

void describe(Keys& keys, RampFunction& s, const Quantity& value) {
  keys.about("A straight line between two values; with rounding twice differentiable.");
  keys.number(optional_key("from"), s.from, {value}, "");
  keys.number("to", s.to, {value}, "");
  keys.fixed(optional_key("begin"), s.begin, instant, "{}.");
  keys.fixed("end", s.end, instant, "{}.");
  keys.must("end", s.end > s.begin, "must be later than \"begin\"", Shown::rule_and_value);
  keys.other(optional_key("rounding"), "quantity",
             "How long the rate rises behind the beginning, and falls before the end [s]; at most "
             "half of the duration; default 0; drives need it.");
}

void describe(Keys& keys, HalfSineFunction& s, const Quantity& value) {
  keys.about("offset + amplitude * sin(pi (t - begin)/duration) while it lasts, else offset.");
  keys.number("amplitude", s.amplitude, {value}, "");
  keys.number(optional_key("offset"), s.offset, {value}, "");
  keys.fixed(optional_key("begin"), s.begin, instant, "{}.");
  keys.fixed("duration", s.duration, duration, "{}.");
  keys.other(optional_key("period"), "quantity",
             "After which it is repeated [s], at least the duration; default: once.");
}

}  // namespace pleuel
