#include "tests/honesty/honesty_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace pleuel::test {

namespace {

std::string type_name(ResponseType type) {
  switch (type) {
    case ResponseType::mass:
      return "mass";
    case ResponseType::stress:
      return "stress";
    case ResponseType::deflection:
      return "deflection";
    case ResponseType::position:
    case ResponseType::velocity:
      return "position, velocity";
    case ResponseType::acceleration:
      return "acceleration";
    case ResponseType::drive_torque:
    case ResponseType::drive_force:
    case ResponseType::drive_power:
      return "drive";
    case ResponseType::reaction_force:
    case ResponseType::reaction_moment:
      return "reaction";
    case ResponseType::kinetic_energy:
    case ResponseType::elastic_energy:
      return "energy";
    default:
      return "other";
  }
}

std::string reduction_name(OverTime over_time) {
  switch (over_time) {
    case OverTime::max:
    case OverTime::min:
    case OverTime::max_abs:
      return "peak";
    case OverTime::rms:
      return "rms";
    case OverTime::final:
      return "final";
    default:
      return "mean";
  }
}

double share(int part, int whole) {
  return whole > 0 ? static_cast<double>(part) / whole : 0.0;
}

/// A mass, or anything else that neither steps nor elements change.
bool is_constant(const JudgedValue& value) {
  return value.is_exact() && value.bar.bound() == 0.0;
}

void print_line(const std::string& name, const std::vector<JudgedValue>& values) {
  const Honesty honesty = honesty_of(values);
  fmt::print("| {} | {} | {:.1f} % | {:.1f} % | {:.1f} % | {:.1f} | {:.1f} |\n", name,
             honesty.values, 100.0 * honesty.unresolved_share(), 100.0 * honesty.honest_share(),
             100.0 * honesty.covered_share(), honesty.ratio_at(0.5), honesty.ratio_at(0.9));
}

}  // namespace

double Honesty::unresolved_share() const {
  return share(unresolved, values);
}

double Honesty::honest_share() const {
  return 1.0 - share(missed, values);
}

double Honesty::covered_share() const {
  return 1.0 - share(missed, values - unresolved);
}

double Honesty::ratio_at(double share) const {
  if (ratios.empty()) return 0.0;
  const auto last = static_cast<double>(ratios.size() - 1);
  return ratios[std::lround(share * last)];
}

Honesty honesty_of(const std::vector<JudgedValue>& values) {
  Honesty honesty;
  for (const JudgedValue& value : values) {
    if (is_constant(value)) continue;
    ++honesty.values;
    if (!value.is_resolved()) {
      ++honesty.unresolved;
      continue;
    }
    if (!value.is_covered()) ++honesty.missed;
    if (!value.is_exact()) honesty.ratios.push_back(value.ratio());
  }
  std::sort(honesty.ratios.begin(), honesty.ratios.end());
  return honesty;
}

std::vector<JudgedValue> those(const std::vector<JudgedValue>& values,
                               const std::function<bool(const JudgedValue&)>& holds) {
  std::vector<JudgedValue> found;
  std::copy_if(values.begin(), values.end(), std::back_inserter(found), holds);
  return found;
}

std::string kind_of(const JudgedValue& value) {
  return fmt::format("{}, {}", type_name(value.type), reduction_name(value.over_time));
}

std::string cause_of(const JudgedValue& value) {
  return std::abs(value.element_error()) > std::abs(value.step_error) ? "elements" : "step";
}

std::string coarseness_of(const JudgedValue& value) {
  return fmt::format("step × {:2}, elements × {}", value.coarseness.step,
                     value.coarseness.elements);
}

void print_table(const std::string& title, const std::vector<JudgedValue>& values,
                 const Group& group) {
  fmt::print(
      "\n| {} | values | not resolved | covered or not resolved | covered of resolved | bar / "
      "error, median | 90 % |\n|---|---|---|---|---|---|---|\n",
      title);
  std::map<std::string, std::vector<JudgedValue>> groups;
  for (const JudgedValue& value : values) groups[group(value)].push_back(value);
  for (const auto& [name, members] : groups) {
    if (honesty_of(members).values > 0) print_line(name, members);
  }
  print_line("**all**", values);
}

void print_worst(const std::vector<JudgedValue>& values, std::size_t count) {
  std::vector<JudgedValue> missed = those(
      values, [](const JudgedValue& value) { return value.is_resolved() && !value.is_covered(); });
  std::sort(missed.begin(), missed.end(),
            [](const JudgedValue& a, const JudgedValue& b) { return a.ratio() < b.ratio(); });
  if (missed.size() > count) missed.resize(count);
  fmt::print("\nMissed by most:\n");
  for (const JudgedValue& one : missed) {
    fmt::print(
        "- {}, {}, {}: off by {:.1e} of its size (step {:.1e}, elements {:.1e}), bar {:.1e} (step "
        "{:.1e}, elements {:.1e})\n",
        one.scene, coarseness_of(one), one.response, std::abs(one.error) / one.magnitude,
        std::abs(one.step_error) / one.magnitude, std::abs(one.element_error()) / one.magnitude,
        one.bar.bound() / one.magnitude, one.bar.step.bound / one.magnitude,
        one.bar.elements.bound / one.magnitude);
  }
}

}  // namespace pleuel::test
