#include "core/response/rainflow.hpp"

#include <cmath>

namespace pleuel {

std::vector<CountedCycle> count_rainflow(const std::vector<double>& turning) {
  std::vector<CountedCycle> cycles;
  std::vector<std::size_t> open;  // turning points that are not counted yet
  const auto range = [&](std::size_t from, std::size_t to) {
    return std::abs(turning[open[to]] - turning[open[from]]);
  };
  for (std::size_t next = 0; next < turning.size(); ++next) {
    open.push_back(next);
    while (open.size() >= 3) {
      const std::size_t last = open.size() - 1;
      if (range(last - 1, last) < range(last - 2, last - 1)) break;
      const bool holds_the_start = last == 2;
      cycles.push_back({open[last - 2], open[last - 1], holds_the_start ? 0.5 : 1.0});
      // Of the range that holds the start its first point goes, else both of its points do.
      if (holds_the_start) {
        open.erase(open.begin());
      } else {
        open.erase(open.end() - 3, open.end() - 1);
      }
    }
  }
  for (std::size_t i = 1; i < open.size(); ++i) cycles.push_back({open[i - 1], open[i], 0.5});
  return cycles;
}

}  // namespace pleuel
