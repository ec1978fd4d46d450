#include "core/scene/reading/pulse_reader.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace pleuel {
namespace {

Number number_or(const LawSource& source, const char* key, double otherwise,
                 NumberReader& numbers) {
  const auto node = source.node.find(key);
  return node ? numbers.designable(*node, source.value) : Number(otherwise);
}

/// A fixed time [s].
double time_or(const LawSource& source, const char* key, double otherwise, Range range,
               const NumberReader& numbers) {
  const auto node = source.node.find(key);
  return node ? numbers.fixed(*node, quantities::time, range) : otherwise;
}

/// A duration that a drive must have: it cannot move in no time.
double duration_of_drive(const LawSource& source, const char* key, const NumberReader& numbers) {
  if (source.purpose == LawPurpose::drive) {
    return numbers.fixed(source.node.at(key), quantities::time, Range::positive);
  }
  return time_or(source, key, 0.0, Range::not_negative, numbers);
}

/// @param longest  what it must be at least [s]
double read_period(const LawSource& source, double longest, const NumberReader& numbers) {
  const auto node = source.node.find("period");
  if (!node) return 0.0;
  const double period = numbers.fixed(*node, quantities::time, Range::positive);
  if (period < longest * (1.0 - 1e-9)) {
    node->fail_with_value(
        fmt::format("must be at least as long as what is repeated, {:g} s", longest));
  }
  return period;
}

}  // namespace

TableFunction read_step(const LawSource& source, NumberReader& numbers) {
  source.allow_keys({"from", "to", "time", "rise"});
  TableFunction table;
  table.values = {number_or(source, "from", 0.0, numbers),
                  numbers.designable(source.node.at("to"), source.value)};
  const double time = time_or(source, "time", 0.0, Range::any, numbers);
  const double rise = duration_of_drive(source, "rise", numbers);
  table.interpolation = rise > 0.0 ? Interpolation::resting : Interpolation::step;
  table.times = {time, time + rise};
  // Of a jump the first point only says what was before.
  if (rise == 0.0) table.times = {std::min(time, 0.0) - 1.0, time};
  return table;
}

RampFunction read_ramp(const LawSource& source, NumberReader& numbers) {
  RampFunction ramp;
  source.read(numbers, ramp, source.value);
  ramp.rounding = duration_of_drive(source, "rounding", numbers);
  const double most = 0.5 * (ramp.end - ramp.begin);
  if (ramp.rounding > most * (1.0 + 1e-9)) {
    source.node.at("rounding")
        .fail_with_value(fmt::format("must be at most half of the duration, {:g} s", most));
  }
  return ramp;
}

HalfSineFunction read_half_sine(const LawSource& source, NumberReader& numbers) {
  HalfSineFunction wave;
  source.read(numbers, wave, source.value);
  wave.period = read_period(source, wave.duration, numbers);
  return wave;
}

TableFunction read_trapezoid(const LawSource& source, NumberReader& numbers) {
  source.allow_keys({"value", "base", "begin", "rise", "hold", "fall", "flanks", "period"});
  const bool is_drive = source.purpose == LawPurpose::drive;
  const Number base = number_or(source, "base", 0.0, numbers);
  const Number value = numbers.designable(source.node.at("value"), source.value);
  const double begin = time_or(source, "begin", 0.0, Range::any, numbers);
  const double rise = numbers.fixed(source.node.at("rise"), quantities::time, Range::positive);
  const double hold = time_or(source, "hold", 0.0, Range::not_negative, numbers);
  const double fall = time_or(source, "fall", rise, Range::positive, numbers);
  TableFunction table;
  table.interpolation = is_drive ? Interpolation::resting : Interpolation::linear;
  if (const auto flanks = source.node.find("flanks")) {
    table.interpolation = read_choice<Interpolation>(
        *flanks, {{"straight", Interpolation::linear}, {"smooth", Interpolation::resting}});
    if (is_drive && table.interpolation == Interpolation::linear) {
      flanks->fail_with_value("must be \"smooth\" of a drive, whose speed would jump");
    }
  }
  table.times = {begin, begin + rise};
  table.values = {base, value};
  const auto add = [&](double duration, const Number& number) {
    table.times.push_back(table.times.back() + duration);
    table.values.push_back(number);
  };
  if (hold > 0.0) add(hold, value);
  add(fall, base);
  const double duration = rise + hold + fall, period = read_period(source, duration, numbers);
  if (period == 0.0) return table;
  table.repetition = Repetition::periodic;
  if (period > duration * (1.0 + 1e-9)) add(period - duration, base);
  return table;
}

}  // namespace pleuel
