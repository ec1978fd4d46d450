#include <cstdlib>
#include <functional>
#include <map>

#include "core/jobs/parallel.hpp"
#include "core/response/analysis.hpp"
#include "tests/honesty/judged_values.hpp"
#include "tests/honesty/shipped_problems.hpp"
#include "tests/random/random_scene.hpp"
#include "tests/support/test.hpp"

/// Whether error bars are true: errors lie within them, and they are not much wider. The program
/// prints the tables of docs/accuracy.md.
namespace pleuel::test::honesty_test {
namespace {

// What bars are worth, over many values.

std::string kind_name(const MassResponse&) {
  return "mass";
}
std::string kind_name(const StressResponse&) {
  return "stress";
}
std::string kind_name(const DeflectionResponse&) {
  return "deflection";
}
std::string kind_name(const PointMotionResponse& motion) {
  if (motion.derivative == TimeDerivative::third) return "other";
  return motion.derivative == TimeDerivative::second ? "acceleration" : "position, velocity";
}
std::string kind_name(const DriveResponse&) {
  return "drive";
}
std::string kind_name(const ReactionResponse&) {
  return "reaction";
}
std::string kind_name(const EnergyResponse&) {
  return "energy";
}
template <class Other>
std::string kind_name(const Other&) {
  return "other";
}

std::string kind_name(const AnyResponse& response) {
  return std::visit([](const auto& one) { return kind_name(one); }, response);
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

/// Of values that have errors: masses and other exact numbers are left out.
struct Honesty {
  int values = 0;
  int unresolved = 0;          ///< said to be
  int missed = 0;              ///< resolved, and the error is beyond the bar
  std::vector<double> ratios;  ///< bar over error of resolved ones, ascending

  double unresolved_share() const { return share(unresolved, values); }
  /// Covered or said to be unresolved, of all.
  double honest_share() const { return 1.0 - share(missed, values); }
  /// Covered, of resolved ones.
  double covered_share() const { return 1.0 - share(missed, values - unresolved); }
  /// @param share  0.5: the median
  double ratio_at(double share) const {
    if (ratios.empty()) return 0.0;
    const auto last = static_cast<double>(ratios.size() - 1);
    return ratios[std::lround(share * last)];
  }
};

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

void print_line(const std::string& name, const std::vector<JudgedValue>& values) {
  const Honesty honesty = honesty_of(values);
  fmt::print("| {} | {} | {:.1f} % | {:.1f} % | {:.1f} % | {:.1f} | {:.1f} |\n", name,
             honesty.values, 100.0 * honesty.unresolved_share(), 100.0 * honesty.honest_share(),
             100.0 * honesty.covered_share(), honesty.ratio_at(0.5), honesty.ratio_at(0.9));
}

/// Those for which something holds.
std::vector<JudgedValue> those(const std::vector<JudgedValue>& values,
                               const std::function<bool(const JudgedValue&)>& holds) {
  std::vector<JudgedValue> found;
  std::copy_if(values.begin(), values.end(), std::back_inserter(found), holds);
  return found;
}

using Group = std::function<std::string(const JudgedValue&)>;

/// What a value is, in words: its type with what is made of it over time.
std::string kind_of(const JudgedValue& value) {
  return fmt::format("{}, {}", kind_name(value.what), reduction_name(value.over_time));
}

/// Whether the step or the elements make most of its error.
std::string cause_of(const JudgedValue& value) {
  return std::abs(value.element_error()) > std::abs(value.step_error) ? "elements" : "step";
}

/// "step × 4, elements × 0.5"
std::string coarseness_of(const JudgedValue& value) {
  return fmt::format("step × {:2}, elements × {}", value.coarseness.step,
                     value.coarseness.elements);
}

/// Prints a table in Markdown with a line a group, in alphabetic order, and one of all.
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

/// Prints the values that bars miss by most, relative to the bar.
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

/// What is promised: so many bars cover the error or say that they cannot; half of them are at most
/// so many times as wide; and so few of a sensible setting cannot.
constexpr double honest_share = 0.95, median_ratio = 5.0, unresolved_share = 0.15;

std::vector<JudgedScene> shipped_scenes() {
  const std::vector<Coarseness> coarseness = {{1, 1},  {2, 1},   {4, 1},  {8, 1},
                                              {16, 1}, {2, 0.5}, {8, 0.5}};
  std::vector<JudgedScene> scenes;
  for (const ShippedProblem& one : shipped_problems()) {
    const ProblemFile file = read_shipped(one);
    scenes.push_back({one.name, file, start_design(file), coarseness});
    if (one.optimum.empty()) continue;
    scenes.push_back(
        {fmt::format("{} at its optimum", one.name), file, optimum_of(one), coarseness});
  }
  return scenes;
}

template <class Make>
std::vector<JudgedValue> judge_all(int count, const Make& make) {
  std::vector<std::vector<JudgedValue>> each(static_cast<std::size_t>(count));
  for_each_in_parallel(count, available_threads(), [&](int i) { each[i] = make(i); });
  std::vector<JudgedValue> all;
  for (const std::vector<JudgedValue>& one : each) all.insert(all.end(), one.begin(), one.end());
  return all;
}

/// Of scenes as they are, without other steps and elements.
std::vector<JudgedValue> of_own_settings(const std::vector<JudgedValue>& values) {
  return those(values, [](const JudgedValue& value) {
    return value.coarseness.step == 1.0 && value.coarseness.elements == 1.0;
  });
}

void print_tables(const std::vector<JudgedValue>& values) {
  print_table("coarseness", values, coarseness_of);
  print_table("response", values, kind_of);
  print_table("most of the error by", values, cause_of);
  print_worst(values, 10);
}

void expect_honesty(const std::vector<JudgedValue>& values) {
  const Honesty honesty = honesty_of(values);
  EXPECT_GE(honesty.honest_share(), honest_share);
  EXPECT_GE(honesty.covered_share(), honest_share);
  EXPECT_LE(honesty.ratio_at(0.5), median_ratio);
  EXPECT_LE(honesty_of(of_own_settings(values)).unresolved_share(), unresolved_share);
  const auto uncertain = those(values, [](const JudgedValue& value) {
    return value.is_resolved() && !value.is_exact() &&
           std::abs(value.reference_error) > 0.5 * value.bar.bound();
  });
  fmt::print(
      "\nThe reference changes by more than half a bar with half its fineness in {} of {}.\n",
      uncertain.size(), honesty.values);
}

TEST(ErrorBars, AreHonestOnShippedProblems) {
  const std::vector<JudgedScene> scenes = shipped_scenes();
  const std::vector<JudgedValue> values =
      judge_all(static_cast<int>(scenes.size()), [&](int i) { return judged_values(scenes[i]); });
  print_table("problem", values, [](const JudgedValue& value) { return value.scene; });
  print_tables(values);
  expect_honesty(values);
}

constexpr int seeds = 110, least_scenes = 100;

/// HONESTY_SEED, or 0: any other one has other mechanisms.
int first_seed() {
  const char* given = std::getenv("HONESTY_SEED");
  return given == nullptr ? 0 : std::atoi(given);
}

std::vector<JudgedValue> judged_random_scene(unsigned seed) {
  const SimulatedScene scene = simulated_scene(seed);
  if (!scene.analysis) return {};
  return judged_values({fmt::format("seed {}", seed),
                        scene.problem,
                        start_design(scene.problem),
                        {{1, 1}, {2, 1}, {4, 1}}});
}

TEST(ErrorBars, AreHonestOnRandomScenes) {
  const std::vector<JudgedValue> values = judge_all(
      seeds, [](int i) { return judged_random_scene(static_cast<unsigned>(first_seed() + i)); });
  std::size_t scenes = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    scenes += i == 0 || values[i].scene != values[i - 1].scene ? 1 : 0;
  }
  EXPECT_GE(scenes, least_scenes);
  fmt::print("{} scenes\n", scenes);
  print_tables(values);
  expect_honesty(values);
}

}  // namespace
}  // namespace pleuel::test::honesty_test
