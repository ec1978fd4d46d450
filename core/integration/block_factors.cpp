#include "core/integration/block_factors.hpp"

#include <cassert>

namespace pleuel {

void BlockFactors::Factor::resize(int columns, int entries) {
  starts.resize(static_cast<std::size_t>(columns) + 1);
  rows.resize(static_cast<std::size_t>(entries));
  values.resize(static_cast<std::size_t>(entries));
}

void BlockFactors::copy(klu_symbolic* symbolic, klu_numeric* numeric, klu_common* common) {
  size_ = symbolic->n;
  lower_.resize(size_, numeric->lnz);
  upper_.resize(size_, numeric->unz);
  above_.resize(size_, numeric->nzoff);
  row_order_.resize(static_cast<std::size_t>(size_));
  column_order_.resize(static_cast<std::size_t>(size_));
  blocks_.resize(static_cast<std::size_t>(symbolic->nblocks) + 1);
  const int done =
      klu_extract(numeric, symbolic, lower_.starts.data(), lower_.rows.data(), lower_.values.data(),
                  upper_.starts.data(), upper_.rows.data(), upper_.values.data(),
                  above_.starts.data(), above_.rows.data(), above_.values.data(), row_order_.data(),
                  column_order_.data(), nullptr, blocks_.data(), common);
  assert(done != 0);
  static_cast<void>(done);
}

/// Row `to` −= entry · row `from`.
void BlockFactors::subtract(const Factor& factor, int entry, int from, int to) {
  row(to) -= factor.values[static_cast<std::size_t>(entry)] * row(from);
}

void BlockFactors::solve(Block x) {
  rows_.resize(size_, x.cols());
  for (int k = 0; k < size_; ++k) row(k) = x.row(row_order_[static_cast<std::size_t>(k)]);
  const auto at = [](const std::vector<int>& list, int i) {
    return list[static_cast<std::size_t>(i)];
  };
  for (int block = static_cast<int>(blocks_.size()) - 2; block >= 0; --block) {
    const int begin = at(blocks_, block), end = at(blocks_, block + 1);
    for (int k = begin; k < end; ++k) {
      for (int i = at(lower_.starts, k) + 1; i < at(lower_.starts, k + 1); ++i) {
        subtract(lower_, i, k, at(lower_.rows, i));
      }
    }
    for (int k = end - 1; k >= begin; --k) {
      const int diagonal = at(upper_.starts, k + 1) - 1;
      row(k) /= upper_.values[static_cast<std::size_t>(diagonal)];
      for (int i = at(upper_.starts, k); i < diagonal; ++i)
        subtract(upper_, i, k, at(upper_.rows, i));
    }
    for (int k = begin; k < end; ++k) {
      for (int i = at(above_.starts, k); i < at(above_.starts, k + 1); ++i) {
        subtract(above_, i, k, at(above_.rows, i));
      }
    }
  }
  for (int k = 0; k < size_; ++k) x.row(at(column_order_, k)) = row(k);
}

void BlockFactors::solve_transposed(Block x) {
  rows_.resize(size_, x.cols());
  for (int k = 0; k < size_; ++k) row(k) = x.row(column_order_[static_cast<std::size_t>(k)]);
  const auto at = [](const std::vector<int>& list, int i) {
    return list[static_cast<std::size_t>(i)];
  };
  for (std::size_t block = 0; block + 1 < blocks_.size(); ++block) {
    const int begin = blocks_[block], end = blocks_[block + 1];
    for (int k = begin; k < end; ++k) {
      for (int i = at(above_.starts, k); i < at(above_.starts, k + 1); ++i) {
        subtract(above_, i, at(above_.rows, i), k);
      }
      const int diagonal = at(upper_.starts, k + 1) - 1;
      for (int i = at(upper_.starts, k); i < diagonal; ++i)
        subtract(upper_, i, at(upper_.rows, i), k);
      row(k) /= upper_.values[static_cast<std::size_t>(diagonal)];
    }
    for (int k = end - 1; k >= begin; --k) {
      for (int i = at(lower_.starts, k) + 1; i < at(lower_.starts, k + 1); ++i) {
        subtract(lower_, i, at(lower_.rows, i), k);
      }
    }
  }
  for (int k = 0; k < size_; ++k) x.row(at(row_order_, k)) = row(k);
}

}  // namespace pleuel
