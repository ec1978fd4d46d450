#include "core/beam/invariants.hpp"

#include <algorithm>
#include <set>

#include "core/base/eager_matrices.hpp"

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

InvariantLayout::InvariantLayout(const Invariants<double>& invariants)
    : coordinates_(invariants.size()),
      pairs_(int_size(invariants.pairs)),
      nonzeros_(invariants.pattern.nonzeros()),
      mixed_(shape_ + 3 * coordinates_),
      moments_(mixed_ + 9 * coordinates_),
      mass_matrix_(moments_ + nonzeros_ * pairs_),
      stiffness_(mass_matrix_ + nonzeros_),
      damping_(stiffness_ + nonzeros_) {}

Eigen::VectorXd InvariantLayout::flatten(const Invariants<double>& invariants) const {
  Eigen::VectorXd vector(size());
  double* first = vector.data();
  mass(first) = invariants.mass;
  first_moment(first) = invariants.first_moment;
  second_moment(first) = invariants.second_moment;
  shape(first) = invariants.shape;
  mixed(first) = invariants.mixed;
  for (int entry = 0; entry < nonzeros_; ++entry) {
    Eigen::Map<Eigen::RowVectorXd>(moments(first, entry), pairs_) = invariants.moments.row(entry);
  }
  mass_matrix(first) = invariants.mass_matrix;
  stiffness(first) = invariants.stiffness;
  damping(first) = invariants.damping;
  return vector;
}

namespace {

bool is_zero(const Invariants<double>& invariants, int entry) {
  return invariants.mass_matrix(entry) == 0.0 && invariants.stiffness(entry) == 0.0 &&
         invariants.damping(entry) == 0.0 && invariants.moments.row(entry).isZero(0.0);
}

/// Which coordinates any number other than zero belongs to.
std::vector<bool> find_used(const Invariants<double>& invariants) {
  std::vector<bool> used;
  for (int i = 0; i < invariants.size(); ++i) {
    used.push_back(!invariants.shape.col(i).isZero(0.0) || !invariants.mixed.col(i).isZero(0.0));
  }
  for (std::size_t row = 0; row < used.size(); ++row) {
    for (int entry = invariants.pattern.row_start[row];
         entry < invariants.pattern.row_start[row + 1]; ++entry) {
      if (is_zero(invariants, entry)) continue;
      const int col = invariants.pattern.column[entry];
      used[row] = used[col] = true;
    }
  }
  return used;
}

}  // namespace

PartialInvariants without_zeros(const Invariants<double>& invariants) {
  const std::vector<bool> used = find_used(invariants);
  PartialInvariants partial;
  std::vector<int> place(used.size(), -1);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    place[i] = int_size(partial.coordinates);
    partial.coordinates.push_back(static_cast<int>(i));
  }
  Invariants<double>& data = partial.data;
  data.pairs = invariants.pairs;
  data.mass = invariants.mass;
  data.first_moment = invariants.first_moment;
  data.second_moment = invariants.second_moment;
  data.shape = invariants.shape(Eigen::all, partial.coordinates);
  data.mixed = invariants.mixed(Eigen::all, partial.coordinates);
  data.pattern.size = int_size(partial.coordinates);
  data.pattern.row_start.assign(1, 0);
  std::vector<int> entries;
  for (int row : partial.coordinates) {
    for (int entry = invariants.pattern.row_start[row];
         entry < invariants.pattern.row_start[row + 1]; ++entry) {
      const int col = invariants.pattern.column[entry];
      if (place[col] < 0) continue;
      data.pattern.column.push_back(place[col]);
      entries.push_back(entry);
    }
    data.pattern.row_start.push_back(data.pattern.nonzeros());
  }
  data.moments = invariants.moments(entries, Eigen::all);
  data.mass_matrix = invariants.mass_matrix(entries);
  data.stiffness = invariants.stiffness(entries);
  data.damping = invariants.damping(entries);
  return partial;
}

}  // namespace pleuel
