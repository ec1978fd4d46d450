#include "cli/scene_report.hpp"

#include <fmt/format.h>

#include "cli/number_text.hpp"
#include "cli/shown_unit.hpp"
#include "cli/table.hpp"

namespace pleuel {

namespace {

int elastic_coordinates(const BodyModel& body) {
  return body.elastic_size();
}

}  // namespace

Json bodies_document(const Model& model) {
  Json document = Json::array();
  for (const BodyModel& body : model.bodies) {
    document.push_back({{"name", body.name},
                        {"mass", body.mass},
                        {"elements", body.beam.elements.size()},
                        {"coordinates", body.frame.size() + elastic_coordinates(body)}});
  }
  return document;
}

std::string bodies_text(const Model& model) {
  Table table({{"body", Table::Align::left},
               {"mass [kg]"},
               {"elements"},
               {"rigid coordinates"},
               {"elastic"}});
  for (const BodyModel& body : model.bodies) {
    table.add_row(
        {body.name, significant(body.mass),
         body.is_beam() ? std::to_string(body.beam.elements.size()) : "–",
         std::to_string(body.frame.size()),
         body.is_elastic || body.is_beam() ? std::to_string(elastic_coordinates(body)) : "–"});
  }
  return table.text();
}

Json variables_document(const ProblemFile& problem) {
  const std::vector<ShownUnit> units = variable_units(problem);
  Json document = Json::object();
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const DesignVariable& variable = problem.variables[i];
    document[variable.name] = {{"start", variable.start},
                               {"lower", variable.lower},
                               {"upper", variable.upper},
                               {"unit", units[i].si}};
  }
  return document;
}

Json variables_document(const ProblemFile& problem, const Eigen::VectorXd& x) {
  const std::vector<ShownUnit> units = variable_units(problem);
  Json document = Json::object();
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const DesignVariable& variable = problem.variables[i];
    document[variable.name] = {{"value", x(static_cast<Eigen::Index>(i))},
                               {"unit", units[i].si},
                               {"lower", variable.lower},
                               {"upper", variable.upper},
                               {"start", variable.start}};
  }
  return document;
}

std::string variables_text(const ProblemFile& problem) {
  const std::vector<ShownUnit> units = variable_units(problem);
  Table table({{"variable", Table::Align::left},
               {"start"},
               {"lower"},
               {"upper"},
               {"unit", Table::Align::left}});
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const DesignVariable& variable = problem.variables[i];
    const ShownUnit& unit = units[i];
    table.add_row({variable.name, significant(unit.shown(variable.start)),
                   significant(unit.shown(variable.lower)), significant(unit.shown(variable.upper)),
                   unit.name});
  }
  return table.text();
}

}  // namespace pleuel
