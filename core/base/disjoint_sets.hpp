#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace pleuel {

/// Numbers 0 … n−1 in sets that are joined step by step; the smallest number of each is its name.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parents_(size) {
    std::iota(parents_.begin(), parents_.end(), 0);
  }

  /// The name of the set of i.
  int find(int i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }

  void join(int i, int k) {
    i = find(i);
    k = find(k);
    parents_[std::max(i, k)] = std::min(i, k);
  }

 private:
  std::vector<int> parents_;
};

}  // namespace pleuel
