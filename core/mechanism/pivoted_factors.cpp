#include "core/mechanism/pivoted_factors.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <queue>
#include <type_traits>

#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

/// Columns of a block.
constexpr int width = 4;

using RowLists = std::vector<std::vector<int>>;

std::vector<int> inverse_of(const std::vector<int>& order) {
  std::vector<int> inverse(order.size());
  for (int k = 0; k < int_size(order); ++k) inverse[order[k]] = k;
  return inverse;
}

/// Adds to each row what elimination fills in: the rows of U of all that stands left of its
/// diagonal. Sorts the rows.
void fill_in(RowLists& rows) {
  std::vector<int> mark(rows.size(), -1);
  for (int i = 0; i < int_size(rows); ++i) {
    std::vector<int>& row = rows[i];
    std::priority_queue<int, std::vector<int>, std::greater<>> left;
    const auto note = [&](int column) {
      mark[column] = i;
      if (column < i) left.push(column);
    };
    for (const int column : row) note(column);
    while (!left.empty()) {
      const int k = left.top();
      left.pop();
      const std::vector<int>& upper = rows[k];
      for (auto it = std::upper_bound(upper.begin(), upper.end(), k); it != upper.end(); ++it) {
        if (mark[*it] == i) continue;
        row.push_back(*it);
        note(*it);
      }
    }
    std::sort(row.begin(), row.end());
  }
}

int block_of(int column) {
  return column / width;
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

  int find(int row, int wanted) const {
    const auto first = block.begin() + start[row], last = block.begin() + start[row + 1];
    return static_cast<int>(std::lower_bound(first, last, wanted) - block.begin());
  }
  int place(int row, int column) const {
    return width * find(row, block_of(column)) + column % width;
  }
};

PivotedFactors::PivotedFactors(const Matrix& pattern, std::vector<int> row_order,
                               std::vector<int> column_order)
    : row_order_(std::move(row_order)), column_order_(std::move(column_order)) {
  const int size = int_size(row_order_);
  const std::vector<int> row_of = inverse_of(row_order_), column_of = inverse_of(column_order_);
  RowLists rows(size), lower(size), upper(size);
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
  for (int i = 0; i < size; ++i) {
    for (const int column : rows[i]) {
      if (column < i) lower[column].push_back(i);
      if (column > i) upper[column].push_back(i);
    }
  }
  upper_start_ = {0};
  for (int k = 0; k < size; ++k) {
    diagonal_.push_back(layout.place(k, k));
    const int first = diagonal_.back() / width, end = layout.start[k + 1];
    upper_start_.push_back(upper_start_.back() + end - first);
    is_whole_.push_back(layout.block[end - 1] - layout.block[first] == end - 1 - first);
    for (const int i : lower[k]) {
      lower_place_.push_back(layout.place(i, k));
      for (int b = first; b < (is_whole_.back() ? first + 1 : end); ++b) {
        targets_.push_back(width * layout.find(i, layout.block[b]));
      }
    }
    for (const int i : upper[k]) {
      upper_place_.push_back(layout.place(i, k) + width * (upper_start_[i] - diagonal_[i] / width));
    }
  }
  const auto by_columns = [](const RowLists& lists) {
    Columns columns{{0}, {}};
    for (const std::vector<int>& list : lists) {
      columns.row.insert(columns.row.end(), list.begin(), list.end());
      columns.start.push_back(int_size(columns.row));
    }
    return columns;
  };
  of_lower_ = by_columns(lower);
  of_upper_ = by_columns(upper);
  rows_.resize(width * int_size(layout.block));
  lower_.resize(int_size(lower_place_));
  upper_.resize(width * upper_start_.back());
  inverse_.resize(size);
}

/// Row k of U is subtracted from all rows below at once: these do not wait for each other.
void PivotedFactors::factorize(const Matrix& matrix) {
  using Numbers = Eigen::Array<double, width, 1>;
  using Place = Eigen::Map<Numbers>;
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
      const double factor = lower_(i) = rows[lower_place_[i]] * inverse;
      if (is_whole_[k]) {
        double* const to = rows + *target++;
        for (int b = 0; b < width * blocks; b += width) Place(to + b) -= factor * Place(upper + b);
      } else {
        for (int b = 0; b < width * blocks; b += width) {
          Place(rows + *target++) -= factor * Place(upper + b);
        }
      }
    }
  }
}

double PivotedFactors::pivot_ratio() const {
  const auto sizes = inverse_.array().abs();
  return sizes.minCoeff<Eigen::PropagateNaN>() / sizes.maxCoeff<Eigen::PropagateNaN>();
}

int PivotedFactors::entries() const {
  return int_size(lower_place_) + int_size(upper_place_) + int_size(diagonal_);
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
      rows(of_upper_.row[i]) -= upper_(upper_place_[i]) * row;
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
      row -= upper_(upper_place_[i]) * rows(of_upper_.row[i]);
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
