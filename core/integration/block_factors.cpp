#include "core/integration/block_factors.hpp"

namespace pleuel {

namespace {

void resize_factor(ColumnFactor& factor, int columns, int entries) {
  factor.starts.resize(static_cast<std::size_t>(columns) + 1);
  factor.rows.resize(static_cast<std::size_t>(entries));
  factor.values.resize(static_cast<std::size_t>(entries));
}

}  // namespace

void BlockFactors::resize(int size, int lower_entries, int upper_entries, int entries_above,
                          int block_count) {
  resize_factor(lower, size, lower_entries);
  resize_factor(upper, size, upper_entries);
  resize_factor(above, size, entries_above);
  row_order.resize(static_cast<std::size_t>(size));
  column_order.resize(static_cast<std::size_t>(size));
  blocks.resize(static_cast<std::size_t>(block_count) + 1);
}

/// Row `to` −= entry · row `from`.
void BlockFactors::subtract(const ColumnFactor& factor, int entry, int from, int to) {
  row(to) -= factor.values[static_cast<std::size_t>(entry)] * row(from);
}

void BlockFactors::solve(Block x) {
  rows_.resize(size(), x.cols());
  for (int k = 0; k < size(); ++k) row(k) = x.row(row_order[static_cast<std::size_t>(k)]);
  const auto at = [](const std::vector<int>& list, int i) {
    return list[static_cast<std::size_t>(i)];
  };
  for (int block = static_cast<int>(blocks.size()) - 2; block >= 0; --block) {
    const int begin = at(blocks, block), end = at(blocks, block + 1);
    for (int k = begin; k < end; ++k) {
      for (int i = at(lower.starts, k) + 1; i < at(lower.starts, k + 1); ++i) {
        subtract(lower, i, k, at(lower.rows, i));
      }
    }
    for (int k = end - 1; k >= begin; --k) {
      const int diagonal = at(upper.starts, k + 1) - 1;
      row(k) /= upper.values[static_cast<std::size_t>(diagonal)];
      for (int i = at(upper.starts, k); i < diagonal; ++i) subtract(upper, i, k, at(upper.rows, i));
    }
    for (int k = begin; k < end; ++k) {
      for (int i = at(above.starts, k); i < at(above.starts, k + 1); ++i) {
        subtract(above, i, k, at(above.rows, i));
      }
    }
  }
  for (int k = 0; k < size(); ++k) x.row(at(column_order, k)) = row(k);
}

void BlockFactors::solve_transposed(Block x) {
  rows_.resize(size(), x.cols());
  for (int k = 0; k < size(); ++k) row(k) = x.row(column_order[static_cast<std::size_t>(k)]);
  const auto at = [](const std::vector<int>& list, int i) {
    return list[static_cast<std::size_t>(i)];
  };
  for (std::size_t block = 0; block + 1 < blocks.size(); ++block) {
    const int begin = blocks[block], end = blocks[block + 1];
    for (int k = begin; k < end; ++k) {
      for (int i = at(above.starts, k); i < at(above.starts, k + 1); ++i) {
        subtract(above, i, at(above.rows, i), k);
      }
      const int diagonal = at(upper.starts, k + 1) - 1;
      for (int i = at(upper.starts, k); i < diagonal; ++i) subtract(upper, i, at(upper.rows, i), k);
      row(k) /= upper.values[static_cast<std::size_t>(diagonal)];
    }
    for (int k = end - 1; k >= begin; --k) {
      for (int i = at(lower.starts, k) + 1; i < at(lower.starts, k + 1); ++i) {
        subtract(lower, i, at(lower.rows, i), k);
      }
    }
  }
  for (int k = 0; k < size(); ++k) x.row(at(row_order, k)) = row(k);
}

}  // namespace pleuel
