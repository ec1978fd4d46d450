#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/base/int_size.hpp"
#include "core/scene/problem_file.hpp"
#include "optimization/linear_choice.hpp"

namespace pleuel {

using Sizes = std::vector<int>;  ///< place in its list, by chosen variable

/// The variables of a problem that are chosen from lists, and the lists.
class SizeLists {
 public:
  explicit SizeLists(const std::vector<DesignVariable>& variables);

  std::size_t count() const { return lists_.size(); }
  /// Index of the k-th chosen variable among all.
  Eigen::Index variable(std::size_t k) const { return lists_[k].variable; }
  int sizes(std::size_t k) const { return int_size(lists_[k].values); }
  double value(std::size_t k, int size) const { return lists_[k].values[size]; }
  /// Mean distance of the sizes in a list; zero of one.
  double mean_gap(std::size_t k) const;

  double combinations() const;
  std::vector<Sizes> all() const;  ///< the last list fastest

  /// @param x  values of the other variables [SI]
  Eigen::VectorXd design(const Sizes& choice, Eigen::VectorXd x) const;

  /// The sizes at or below those of a design; the nearest ones.
  Sizes below(const Eigen::VectorXd& x) const;
  Sizes nearest(const Eigen::VectorXd& x) const;

  /// Each size one up or down.
  std::vector<Sizes> neighbours(const Sizes& from) const;
  /// Any other size in place of each.
  std::vector<Sizes> exchanges(const Sizes& from) const;

 private:
  struct List {
    Eigen::Index variable;
    std::vector<double> values;  ///< ascending [SI]
  };
  std::vector<List> lists_;
};

}  // namespace pleuel
