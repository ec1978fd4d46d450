#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/response/value_over_cases.hpp"
#include "core/scene/problem_file.hpp"
#include "optimization/design/design_case.hpp"
#include "optimization/problem.hpp"

namespace pleuel {

/// Rows of one load case, and where they stand among those of all cases.
struct CaseRows {
  std::vector<ConstraintRows> of;
  std::vector<Eigen::Index> places = {};
};

/// A row that is made from responses of several cases.
struct RowOverCases {
  std::size_t response = 0;  ///< of the joined problem
  Eigen::Index place = 0;    ///< among the rows of all cases
  double sign = 1.0;         ///< that its value is multiplied with
};

/// Rows of all cases, with a name that tells them from other rows of the same file.
struct NamedRows {
  std::string name;
  std::vector<CaseRows> cases;  ///< one a case
  std::vector<RowOverCases> over_cases = {};
};

/// What responses over cases are made from, as further rows of the cases: asked for behind their
/// own, and put together when all are known.
class PartRows {
 public:
  /// @param responses  over cases, or of one case, by their places in the joined problem
  PartRows(const ProblemFile& joined, const std::vector<std::size_t>& responses);

  /// The same rows, with those of the parts behind them.
  NamedRows added_to(NamedRows rows) const;

  /// Value of one of the responses, and its gradient where it is asked for.
  /// @param answers   one a case, to the rows of added_to()
  /// @param gradient  may be null
  double combined(std::size_t response, const Eigen::VectorXd& x,
                  const std::vector<DesignCase::Answer>& answers, Eigen::VectorXd* gradient) const;

 private:
  const ProblemFile& joined_;
  /// Each part by its place in the joined problem: the number of its row, counted from the last of
  /// its case.
  std::map<std::size_t, Eigen::Index> from_end_;
};

}  // namespace pleuel
