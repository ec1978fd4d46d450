#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/response/value_over_cases.hpp"
#include "core/scene/problem_file.hpp"
#include "optimization/design/design_case.hpp"
#include "optimization/problem.hpp"

namespace pleuel {

/// Where some components of a design problem come from: a case, or several.
struct RowSource {
  std::size_t load_case = 0;
  ConstraintRows rows = {};  ///< in the problem of the case
  /// In place of a case: a response of the joined problem that is made from several. One component, multiplied
  /// with the sign of `rows`.
  std::optional<std::size_t> over_cases = {};

  int count() const { return over_cases ? 1 : rows.count(); }
};

/// A response of the joined problem by itself, neither limited nor minimized in its case.
RowSource response_row(const ProblemFile& joined, std::size_t response, double sign = 1.0);

/// Components of a design problem, with a name that tells them from others of the same file.
struct NamedRows {
  std::string name;
  std::vector<RowSource> sources;
};

/// Rows that each case is asked for.
using RowsOfCases = std::vector<std::vector<ConstraintRows>>;

/// What responses over cases are made from, as further rows of the cases: asked for behind their
/// own, and put together when all are known.
class PartRows {
 public:
  /// @param responses  over cases, or of one case, by their places in the joined problem
  PartRows(const ProblemFile& joined, const std::vector<std::size_t>& responses);

  /// Adds the rows of the parts behind others, and to their name.
  void add_to(RowsOfCases& rows, std::string& name) const;

  /// Value of one of the responses, and its gradient where it is asked for.
  /// @param answers   one a case, to the rows of add_to()
  /// @param gradient  may be null
  double combined(std::size_t response, const Eigen::VectorXd& x,
                  const std::vector<StoredEvaluation>& answers, Eigen::VectorXd* gradient) const;

 private:
  const ProblemFile& joined_;
  /// Each part by its place in the joined problem: the number of its row, counted from the last of
  /// its case.
  std::map<std::size_t, Eigen::Index> from_end_;
};

}  // namespace pleuel
