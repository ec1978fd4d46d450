#include "picture/thinned.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

std::vector<int> thinned(const Eigen::VectorXd& values, int most, const std::vector<int>& kept) {
  const int points = int_size(values);
  if (points <= most) {
    std::vector<int> all(points);
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  std::set<int> chosen = {0, points - 1};
  for (const int index : kept) {
    if (index >= 0 && index < points) chosen.insert(index);
  }
  const long stretches = std::max(1, most / 2);
  for (long i = 0; i < stretches; ++i) {
    const Eigen::Index begin = i * points / stretches;
    const Eigen::Index end = (i + 1) * points / stretches;
    Eigen::Index lowest = 0, highest = 0;
    values.segment(begin, end - begin).minCoeff(&lowest);
    values.segment(begin, end - begin).maxCoeff(&highest);
    chosen.insert(static_cast<int>(begin + lowest));
    chosen.insert(static_cast<int>(begin + highest));
  }
  return {chosen.begin(), chosen.end()};
}

}  // namespace pleuel
