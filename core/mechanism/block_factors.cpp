#include "core/mechanism/block_factors.hpp"

#include <algorithm>

#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

constexpr int full_width = 8, half_width = 4;

void resize_factor(ColumnFactor& factor, int columns, int entries) {
  factor.starts.resize(static_cast<std::size_t>(columns) + 1);
  factor.rows.resize(entries);
  factor.values.resize(entries);
}

int at(const std::vector<int>& list, int i) {
  return list[i];
}

/// Rows of right-hand sides, `Width` numbers each.
template <int Width>
class Rows {
 public:
  using Row = Eigen::Matrix<double, Width, 1>;

  explicit Rows(std::vector<double>& numbers) : numbers_(numbers.data()) {}

  Eigen::Map<Row> operator()(int k) const { return Eigen::Map<Row>(numbers_ + k * Width); }

  /// Row k −= Σ entry i of the factor · row rows(i), for i in a range.
  void subtract_from(int k, const ColumnFactor& factor, int begin, int end) const {
    Row sum = (*this)(k);
    for (int i = begin; i < end; ++i) sum -= value(factor, i) * (*this)(at(factor.rows, i));
    (*this)(k) = sum;
  }
  /// Row rows(i) −= entry i of the factor · row k.
  void subtract_row(int k, const ColumnFactor& factor, int begin, int end) const {
    const Row row = (*this)(k);
    for (int i = begin; i < end; ++i) (*this)(at(factor.rows, i)) -= value(factor, i) * row;
  }

  static double value(const ColumnFactor& factor, int i) { return factor.values[i]; }

  /// Row k from row order(k) of x, with zeros in what x lacks.
  template <class Columns>
  void take(const std::vector<int>& order, const Columns& x) const {
    const Eigen::Index count = x.cols();
    for (int k = 0; k < int_size(order); ++k) {
      Row row = Row::Zero();
      for (Eigen::Index j = 0; j < count; ++j) row(j) = x(at(order, k), j);
      (*this)(k) = row;
    }
  }
  template <class Columns>
  void give(const std::vector<int>& order, Columns& x) const {
    const Eigen::Index count = x.cols();
    for (int k = 0; k < int_size(order); ++k) {
      const auto row = (*this)(k);
      for (Eigen::Index j = 0; j < count; ++j) x(at(order, k), j) = row(j);
    }
  }

 private:
  double* numbers_;
};

/// Calls visit(columns) for groups of columns.
template <class Visit>
void for_each_group(Eigen::Index columns, Visit visit) {
  for (Eigen::Index first = 0; first < columns; first += full_width) {
    visit(first, std::min<Eigen::Index>(full_width, columns - first));
  }
}

}  // namespace

void BlockFactors::resize(int size, int lower_entries, int upper_entries, int entries_above,
                          int block_count) {
  resize_factor(lower, size, lower_entries);
  resize_factor(upper, size, upper_entries);
  resize_factor(above, size, entries_above);
  row_order.resize(size);
  column_order.resize(size);
  blocks.resize(static_cast<std::size_t>(block_count) + 1);
  rows_.resize(static_cast<std::size_t>(size) * full_width);
}

void BlockFactors::solve(Block x) {
  for_each_group(x.cols(), [&](Eigen::Index first, Eigen::Index count) {
    auto group = x.middleCols(first, count);
    count <= half_width ? solve_group<half_width>(group) : solve_group<full_width>(group);
  });
}

void BlockFactors::solve_transposed(Block x) {
  for_each_group(x.cols(), [&](Eigen::Index first, Eigen::Index count) {
    auto group = x.middleCols(first, count);
    count <= half_width ? solve_group_transposed<half_width>(group)
                        : solve_group_transposed<full_width>(group);
  });
}

template <int Width>
void BlockFactors::solve_group(Block x) {
  const Rows<Width> rows(rows_);
  rows.take(row_order, x);
  for (int block = int_size(blocks) - 2; block >= 0; --block) {
    const int begin = at(blocks, block), end = at(blocks, block + 1);
    for (int k = begin; k < end; ++k) {
      rows.subtract_row(k, lower, at(lower.starts, k) + 1, at(lower.starts, k + 1));
    }
    for (int k = end - 1; k >= begin; --k) {
      const int diagonal = at(upper.starts, k + 1) - 1;
      rows(k) /= rows.value(upper, diagonal);
      rows.subtract_row(k, upper, at(upper.starts, k), diagonal);
    }
    for (int k = begin; k < end; ++k) {
      rows.subtract_row(k, above, at(above.starts, k), at(above.starts, k + 1));
    }
  }
  rows.give(column_order, x);
}

template <int Width>
void BlockFactors::solve_group_transposed(Block x) {
  const Rows<Width> rows(rows_);
  rows.take(column_order, x);
  for (std::size_t block = 0; block + 1 < blocks.size(); ++block) {
    const int begin = blocks[block], end = blocks[block + 1];
    for (int k = begin; k < end; ++k) {
      rows.subtract_from(k, above, at(above.starts, k), at(above.starts, k + 1));
      const int diagonal = at(upper.starts, k + 1) - 1;
      rows.subtract_from(k, upper, at(upper.starts, k), diagonal);
      rows(k) /= rows.value(upper, diagonal);
    }
    for (int k = end - 1; k >= begin; --k) {
      rows.subtract_from(k, lower, at(lower.starts, k) + 1, at(lower.starts, k + 1));
    }
  }
  rows.give(row_order, x);
}

}  // namespace pleuel
