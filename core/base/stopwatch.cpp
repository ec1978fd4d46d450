#include "core/base/stopwatch.hpp"

#include <algorithm>
#include <cmath>

namespace pleuel {

namespace {

constexpr std::size_t fewest_rounds = 7, most_rounds = 101;
/// How often the median may lie outside of the spread.
constexpr double level = 0.004;

/// How many of the smallest and of the largest values may be dropped: the largest k with
/// 2 P(X < k + 1) ≤ level, X binomial.
std::size_t dropped(std::size_t count) {
  double probability = std::pow(0.5, static_cast<double>(count)), below = probability;
  std::size_t k = 0;
  while (k + 1 < count / 2) {
    probability *= static_cast<double>(count - k) / static_cast<double>(k + 1);
    if (2.0 * (below + probability) > level) break;
    below += probability;
    ++k;
  }
  return k;
}

double median(std::vector<double> values) {
  const std::size_t half = values.size() / 2;
  std::ranges::sort(values);
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// @param changes  one a round
void set_change(std::vector<double> changes, ComparedTime& time) {
  std::ranges::sort(changes);
  const std::size_t k = dropped(changes.size());
  time.change = median(changes);
  if (changes.size() < fewest_rounds) return;
  time.spread = std::max(time.change - changes[k], changes[changes.size() - 1 - k] - time.change);
}

}  // namespace

std::vector<ComparedTime> compare_times(const std::vector<std::function<void()>>& works,
                                        const TimingBudget& budget) {
  const ThreadStopwatch stopwatch;
  const auto now = budget.clock ? budget.clock : [&] { return stopwatch.seconds(); };
  std::vector<std::vector<double>> seconds(works.size()), changes(works.size());
  const auto round = [&] {
    std::vector<double> times;
    for (const auto& work : works) {
      const double begin = now();
      work();
      times.push_back(now() - begin);
    }
    return times;
  };
  round();
  const double begin = now();
  const auto goes_on = [&](std::size_t rounds) {
    return rounds < most_rounds &&
           now() - begin < (rounds < fewest_rounds ? budget.most : budget.seconds);
  };
  for (std::size_t i = 0; i == 0 || goes_on(i); ++i) {
    const std::vector<double> times = round();
    for (std::size_t k = 0; k < works.size(); ++k) {
      seconds[k].push_back(times[k]);
      changes[k].push_back(times.front() > 0.0 ? times[k] / times.front() - 1.0 : 0.0);
    }
  }
  std::vector<ComparedTime> compared(works.size());
  for (std::size_t k = 0; k < works.size(); ++k) {
    compared[k].seconds = median(seconds[k]);
    set_change(changes[k], compared[k]);
  }
  return compared;
}

}  // namespace pleuel
