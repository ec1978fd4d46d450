#include "optimization/design/rows_over_cases.hpp"

#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/response_parts.hpp"

namespace pleuel {

RowSource response_row(const ProblemFile& joined, std::size_t response, double sign) {
  const OfCase of_case = case_of_response(joined, response);
  if (is_of_several(of_case)) return {0, {.sign = sign}, response};
  return {of_case.load_case, {.part = of_case.index, .sign = sign}};
}

PartRows::PartRows(const ProblemFile& joined, const std::vector<std::size_t>& responses)
    : joined_(joined) {
  std::set<std::size_t> parts;
  for (const std::size_t response : responses) {
    for (const std::size_t part : parts_in_cases(joined, response)) parts.insert(part);
  }
  std::map<std::size_t, Eigen::Index> counts;
  for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
    from_end_[*part] = ++counts[case_of_response(joined, *part).load_case];
  }
}

void PartRows::add_to(RowsOfCases& rows, std::string& name) const {
  if (from_end_.empty()) return;
  name += ", with";
  for (const auto& [part, place] : from_end_) {
    const RowSource source = response_row(joined_, part);
    rows[source.load_case].push_back(source.rows);
    name += fmt::format(" {}", joined_.responses[part].name);
  }
}

double PartRows::combined(std::size_t response, const Eigen::VectorXd& x,
                          const std::vector<StoredEvaluation>& answers,
                          Eigen::VectorXd* gradient) const {
  const auto row_of = [&](std::size_t part, const Evaluation& evaluation) {
    return evaluation.constraints.size() - from_end_.at(part);
  };
  const auto evaluation_of = [&](std::size_t part) -> const Evaluation& {
    return answers[case_of_response(joined_, part).load_case].evaluation;
  };
  const ValueInCase value_of = [&](std::size_t part) {
    const Evaluation& evaluation = evaluation_of(part);
    return evaluation.constraints(row_of(part, evaluation));
  };
  if (gradient != nullptr) {
    const LinearizedResponse linear = linearized_over_cases(joined_, response, x, value_of);
    *gradient = linear.design;
    for (const WeightedResponse& part : linear.parts) {
      const Evaluation& evaluation = evaluation_of(part.response);
      *gradient +=
          part.weight *
          evaluation.constraint_jacobian.row(row_of(part.response, evaluation)).transpose();
    }
  }
  return value_over_cases(joined_, response, x, value_of);
}

}  // namespace pleuel
