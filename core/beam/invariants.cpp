#include "core/beam/invariants.hpp"

#include <algorithm>
#include <set>

namespace pleuel {

int ElasticPattern::find(int row, int col) const {
  const auto begin = column.begin() + row_start[row];
  const auto end = column.begin() + row_start[static_cast<std::size_t>(row) + 1];
  const auto found = std::lower_bound(begin, end, col);
  return found != end && *found == col ? static_cast<int>(found - column.begin()) : -1;
}

ElasticPattern pattern_of_groups(int size, const std::vector<std::vector<int>>& groups) {
  std::vector<std::set<int>> rows(size);
  for (const auto& group : groups) {
    for (int row : group) {
      if (row < 0) continue;
      for (int col : group) {
        if (col >= 0) rows[row].insert(col);
      }
    }
  }
  ElasticPattern pattern;
  pattern.size = size;
  pattern.row_start.push_back(0);
  for (const auto& row : rows) {
    pattern.column.insert(pattern.column.end(), row.begin(), row.end());
    pattern.row_start.push_back(pattern.nonzeros());
  }
  return pattern;
}

}  // namespace pleuel
