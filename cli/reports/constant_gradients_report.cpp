#include "cli/reports/constant_gradients_report.hpp"

#include <fmt/format.h>

#include "cli/text/table.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/reading/invariants_writer.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

/// All inertia of a body as a change: what a factor on its density does.
BodyConstants inertia_of(const BodyConstants& constants) {
  BodyConstants inertia = zero_constants(constants);
  inertia.mass = constants.mass;
  inertia.first_moment = constants.first_moment;
  inertia.second_moment = constants.second_moment;
  inertia.shape = constants.shape;
  inertia.mixed = constants.mixed;
  inertia.moments = constants.moments;
  inertia.mass_matrix = constants.mass_matrix;
  return inertia;
}

BodyConstants with_only(const BodyConstants& constants, SparseMatrix BodyConstants::*matrix) {
  BodyConstants change = zero_constants(constants);
  change.*matrix = constants.*matrix;
  return change;
}

}  // namespace

Json constant_gradients_document(const ProblemFile& problem, const std::string& body,
                                 const ConstantGradients& gradients) {
  Json document = {{"body", body}, {"responses", Json::object()}};
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    Json& response = document["responses"][problem.responses[i].name];
    response = {{"unit", unit_of(problem.responses[i]).si}};
    response.update(derivative_json(gradients.numbers[i]));
  }
  return document;
}

std::string constant_gradients_text(const ProblemFile& problem, const std::string& body,
                                    const ConstantGradients& gradients,
                                    const Eigen::VectorXd& values) {
  const BodyConstants& constants = gradients.constants;
  const BodyConstants changes[] = {inertia_of(constants),
                                   with_only(constants, &BodyConstants::stiffness),
                                   with_only(constants, &BodyConstants::damping)};
  Table table({{"response", Table::Align::left}, {"inertia"}, {"stiffness"}, {"damping"}});
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    std::vector<std::string> cells = {problem.responses[i].name};
    const double value = values(static_cast<Eigen::Index>(i));
    for (const BodyConstants& change : changes) {
      const double percent = along(gradients.numbers[i], change) / value;
      cells.push_back(value == 0.0 ? "–" : signed_significant(percent, 3) + " %");
    }
    table.add_row(std::move(cells));
  }
  return fmt::format("\nWhat 1 % more of \"{}\" changes\n{}", body, table.text());
}

}  // namespace pleuel
