#include "core/mechanism/pivoted_factors.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <numeric>
#include <type_traits>

#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

/// Columns of a block.
constexpr int width = 4;
/// Up to so many blocks of a row are taken one by one, which is faster than runs of a few.
constexpr int most_single = 12;

std::vector<int> inverse_of(const std::vector<int>& order) {
  std::vector<int> inverse(order.size());
  for (int k = 0; k < int_size(order); ++k) inverse[order[k]] = k;
  return inverse;
}

/// Numbers below a size, in words of 64 bits.
class NumberSet {
 public:
  explicit NumberSet(std::size_t size) : words_(size / bits + 1) {}

  void add(int number) { words_[number / bits] |= std::uint64_t{1} << (number % bits); }
  void clear() { std::ranges::fill(words_, 0); }
  /// The least one from `first` on, or one beyond all.
  int next(int first) const {
    std::size_t word = first / bits;
    std::uint64_t rest = words_[word] & (~std::uint64_t{0} << (first % bits));
    while (rest == 0) {
      if (++word == words_.size()) return int_size(words_) * bits;
      rest = words_[word];
    }
    return static_cast<int>(word) * bits + std::countr_zero(rest);
  }

 private:
  static constexpr int bits = 64;
  std::vector<std::uint64_t> words_;
};

/// Adds to each row what elimination fills in: the rows of U of all that stands left of its
/// diagonal. Sorts the rows.
void fill_in(std::vector<std::vector<int>>& rows) {
  NumberSet columns(rows.size());
  for (int i = 0; i < int_size(rows); ++i) {
    columns.clear();
    for (const int column : rows[i]) columns.add(column);
    for (int k = columns.next(0); k < i; k = columns.next(k + 1)) {
      for (auto it = rows[k].rbegin(); *it > k; ++it) columns.add(*it);
    }
    rows[i].clear();
    for (int k = columns.next(0); k < int_size(rows); k = columns.next(k + 1)) {
      rows[i].push_back(k);
    }
  }
}

int block_of(int column) {
  return column / width;
}

/// 1 if an even number of exchanges makes it, −1 otherwise.
int parity(const std::vector<int>& permutation) {
  std::vector<bool> is_seen(permutation.size(), false);
  int sign = 1;
  for (int first = 0; first < int_size(permutation); ++first) {
    for (int i = first; !is_seen[i]; i = permutation[i]) {
      is_seen[i] = true;
      if (permutation[i] != first) sign = -sign;  // a cycle of k has k − 1 exchanges
    }
  }
  return sign;
}

}  // namespace

/// Where the blocks of rows stand, one behind the other.
struct PivotedFactors::Layout {
  std::vector<int> start = {0};  ///< the first block of each row
  std::vector<int> block;        ///< of columns

  explicit Layout(const RowLists& rows) {
    for (const std::vector<int>& row : rows) {
      for (const int column : row) {
        const bool is_new = int_size(block) == start.back() || block.back() != block_of(column);
        if (is_new) block.push_back(block_of(column));
      }
      start.push_back(int_size(block));
    }
  }

  int place(int row, int column) const {
    const auto first = block.begin() + start[row], last = block.begin() + start[row + 1];
    const auto found = std::lower_bound(first, last, block_of(column)) - block.begin();
    return width * static_cast<int>(found) + column % width;
  }
};

PivotedFactors::PivotedFactors(const Matrix& pattern, std::vector<int> row_order,
                               std::vector<int> column_order)
    : row_order_(std::move(row_order)), column_order_(std::move(column_order)) {
  const int size = int_size(row_order_);
  const std::vector<int> row_of = inverse_of(row_order_), column_of = inverse_of(column_order_);
  RowLists rows(size);
  const auto for_each_entry = [&](const auto& visit) {
    for (int col = 0; col < size; ++col) {
      for (Matrix::InnerIterator it(pattern, col); it; ++it) {
        visit(row_of[it.row()], column_of[col]);
      }
    }
  };
  for_each_entry([&](int row, int column) { rows[row].push_back(column); });
  fill_in(rows);
  const Layout layout(rows);
  for_each_entry([&](int row, int column) { places_.push_back(layout.place(row, column)); });
  rows_.resize(width * int_size(layout.block));
  place_factors(rows, layout);
}

void PivotedFactors::place_factors(const RowLists& rows, const Layout& layout) {
  const int size = int_size(rows);
  of_lower_ = Columns(rows, [](int row, int column) { return column < row; });
  of_upper_ = Columns(rows, [](int row, int column) { return column > row; });
  upper_start_ = run_start_ = {0};
  std::vector<int> first_blocks;  // of the runs
  for (int k = 0; k < size; ++k) {
    diagonal_.push_back(layout.place(k, k));
    const int first = diagonal_.back() / width, end = layout.start[k + 1];
    for (int b = first; b < end; ++b) {
      if (end - first <= most_single || b == first || layout.block[b] > layout.block[b - 1] + 1) {
        first_blocks.push_back(layout.block[b]);
        run_length_.push_back(0);
      }
      run_length_.back() += width;
    }
    upper_start_.push_back(upper_start_.back() + end - first);
    run_start_.push_back(int_size(run_length_));
  }
  std::vector<int> next_target(size), block_in_row(block_of(size) + 1);
  for (int k = 1; k < size; ++k) {
    const int runs = run_start_[k] - run_start_[k - 1];
    next_target[k] = next_target[k - 1] + runs * (of_lower_.start[k] - of_lower_.start[k - 1]);
  }
  targets_.resize(next_target.empty() ? 0 : next_target.back());  // nothing is below the last row
  std::vector<int> next_lower = of_lower_.start, next_upper = of_upper_.start;
  for (int i = 0; i < size; ++i) {
    for (int b = layout.start[i]; b < layout.start[i + 1]; ++b) block_in_row[layout.block[b]] = b;
    const int to_upper = width * upper_start_[i] - diagonal_[i] / width * width;
    for (const int k : rows[i]) {
      const int place = width * block_in_row[block_of(k)] + k % width;
      if (k > i) of_upper_.add(next_upper[k]++, i, place + to_upper);
      if (k >= i) continue;
      of_lower_.add(next_lower[k]++, i, place);
      for (int run = run_start_[k]; run < run_start_[k + 1]; ++run) {
        targets_[next_target[k]++] = width * block_in_row[first_blocks[run]];
      }
    }
  }
  lower_.resize(int_size(of_lower_.row));
  upper_.resize(width * upper_start_.back());
  inverse_.resize(size);
}

template <class Has>
PivotedFactors::Columns::Columns(const RowLists& rows, const Has& has) : start(rows.size() + 1) {
  for (int i = 0; i < int_size(rows); ++i) {
    for (const int k : rows[i]) start[k + 1] += has(i, k) ? 1 : 0;
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  row.resize(start.back());
  place.resize(start.back());
}

/// Row k of U is subtracted from all rows below at once: these do not wait for each other.
void PivotedFactors::factorize(const Matrix& matrix) {
  using Numbers = Eigen::Array<double, width, 1>;
  using Place = Eigen::Map<Numbers>;
  using ConstPlace = Eigen::Map<const Numbers>;
  const std::array<Numbers, width> behind_pivot = {
      {{0.0, 1.0, 1.0, 1.0}, {0.0, 0.0, 1.0, 1.0}, {0.0, 0.0, 0.0, 1.0}, {0.0, 0.0, 0.0, 0.0}}};
  double* const rows = rows_.data();
  rows_.setZero();
  for (std::size_t i = 0; i < places_.size(); ++i) rows[places_[i]] = matrix.valuePtr()[i];
  const int* target = targets_.data();
  for (int k = 0; k < int_size(diagonal_); ++k) {
    const int blocks = upper_start_[k + 1] - upper_start_[k];
    double* const upper = upper_.data() + width * upper_start_[k];
    double* const row = rows + width * block_of(diagonal_[k]);
    for (int b = 0; b < blocks; ++b) Place(upper + width * b) = Place(row + width * b);
    Place(upper) *= behind_pivot[k % width];
    const double inverse = inverse_(k) = 1.0 / rows[diagonal_[k]];
    for (int i = of_lower_.start[k]; i < of_lower_.start[k + 1]; ++i) {
      // Not back to its place: vectors are not read fast from where a number has just been written.
      const double factor = lower_(i) = rows[of_lower_.place[i]] * inverse;
      if (blocks <= most_single) {
        for (int j = 0; j < width * blocks; j += width) {
          Place(rows + *target++) -= factor * ConstPlace(upper + j);
        }
        continue;
      }
      const double* from = upper;
      for (int run = run_start_[k]; run < run_start_[k + 1]; ++run) {
        double* const to = rows + *target++;
        const int length = run_length_[run];
        for (int j = 0; j < length; j += width) Place(to + j) -= factor * ConstPlace(from + j);
        from += length;
      }
    }
  }
}

double PivotedFactors::pivot_ratio() const {
  const auto sizes = inverse_.array().abs();
  return sizes.minCoeff<Eigen::PropagateNaN>() / sizes.maxCoeff<Eigen::PropagateNaN>();
}

int PivotedFactors::determinant_sign() const {
  const bool is_odd = (inverse_.array() < 0.0).count() % 2 != 0;
  return parity(row_order_) * parity(column_order_) * (is_odd ? -1 : 1);
}

int PivotedFactors::entries() const {
  return int_size(of_lower_.row) + int_size(of_upper_.row) + int_size(diagonal_);
}

namespace {

/// Permuted right-hand sides, up to `Width` of them.
template <int Width>
class RightSides {
 public:
  using Row = Eigen::Array<double, Width, 1>;

  RightSides(std::vector<double>& numbers, const PivotedFactors::Block& x,
             const std::vector<int>& order) {
    numbers.assign(Width * order.size(), 0.0);
    numbers_ = numbers.data();
    for (int j = 0; j < x.cols(); ++j) {
      for (int k = 0; k < int_size(order); ++k) numbers_[Width * k + j] = x(order[k], j);
    }
  }

  Eigen::Map<Row> operator()(int k) const { return Eigen::Map<Row>(numbers_ + k * Width); }

  void give(const std::vector<int>& order, PivotedFactors::Block& x) const {
    for (int j = 0; j < x.cols(); ++j) {
      for (int k = 0; k < int_size(order); ++k) x(order[k], j) = numbers_[Width * k + j];
    }
  }

 private:
  double* numbers_;
};

}  // namespace

template <int Width>
void PivotedFactors::solve_group(Block x) {
  const RightSides<Width> rows(rhs_, x, row_order_);
  typename RightSides<Width>::Row row;
  const int size = int_size(diagonal_);
  for (int k = 0; k < size; ++k) {
    row = rows(k);
    for (int i = of_lower_.start[k]; i < of_lower_.start[k + 1]; ++i) {
      rows(of_lower_.row[i]) -= lower_(i) * row;
    }
  }
  for (int k = size - 1; k >= 0; --k) {
    rows(k) = row = inverse_(k) * rows(k);
    for (int i = of_upper_.start[k]; i < of_upper_.start[k + 1]; ++i) {
      rows(of_upper_.row[i]) -= upper_(of_upper_.place[i]) * row;
    }
  }
  rows.give(column_order_, x);
}

template <int Width>
void PivotedFactors::solve_group_transposed(Block x) {
  const RightSides<Width> rows(rhs_, x, column_order_);
  typename RightSides<Width>::Row row;
  const int size = int_size(diagonal_);
  for (int k = 0; k < size; ++k) {
    row = rows(k);
    for (int i = of_upper_.start[k]; i < of_upper_.start[k + 1]; ++i) {
      row -= upper_(of_upper_.place[i]) * rows(of_upper_.row[i]);
    }
    rows(k) = inverse_(k) * row;
  }
  for (int k = size - 1; k >= 0; --k) {
    row = rows(k);
    for (int i = of_lower_.start[k]; i < of_lower_.start[k + 1]; ++i) {
      row -= lower_(i) * rows(of_lower_.row[i]);
    }
    rows(k) = row;
  }
  rows.give(row_order_, x);
}

/// Calls visit(columns, how many at a time) for groups of columns.
template <class Visit>
void PivotedFactors::for_each_group(Block x, const Visit& visit) {
  constexpr Eigen::Index most = 8;
  for (Eigen::Index first = 0; first < x.cols(); first += most) {
    const Eigen::Index count = std::min(most, x.cols() - first);
    Block group = x.middleCols(first, count);
    if (count == 1) {
      visit(group, std::integral_constant<int, 1>());
    } else if (count <= 4) {
      visit(group, std::integral_constant<int, 4>());
    } else {
      visit(group, std::integral_constant<int, 8>());
    }
  }
}

void PivotedFactors::solve(Block x) {
  for_each_group(x, [&](Block& group, auto many) { solve_group<decltype(many)::value>(group); });
}

void PivotedFactors::solve_transposed(Block x) {
  for_each_group(
      x, [&](Block& group, auto many) { solve_group_transposed<decltype(many)::value>(group); });
}

}  // namespace pleuel
