#include "core/scene/response_settings.hpp"

namespace pleuel {

const StressPlaces* stress_places(const ResponseSettings& response) {
  const auto places = [](const auto& one) -> const StressPlaces* {
    if constexpr (requires { one.where; }) return &one.where;
    return nullptr;
  };
  return std::visit(places, response.what);
}

const ResponsePoint* response_point(const ResponseSettings& response) {
  const auto point = [](const auto& one) -> const ResponsePoint* {
    if constexpr (requires { one.point; }) return &one.point;
    return nullptr;
  };
  return std::visit(point, response.what);
}

std::vector<std::string> bodies_of(const ResponseSettings& response) {
  const auto bodies = [](const auto& one) -> std::vector<std::string> {
    if constexpr (requires { one.bodies; }) return one.bodies;
    if constexpr (requires { one.where; }) return one.where.bodies;
    if constexpr (requires { one.point; }) return {one.point.body};
    if constexpr (requires { one.body; }) {
      if (!one.body.empty()) return {one.body};
    }
    return {};
  };
  return std::visit(bodies, response.what);
}

std::string joint_of(const ResponseSettings& response) {
  const auto joint = [](const auto& one) -> std::string {
    if constexpr (requires { one.joint; }) return one.joint;
    return "";
  };
  return std::visit(joint, response.what);
}

std::optional<double> place_along(const ResponseSettings& response) {
  if (const auto* places = stress_places(response)) return places->station;
  if (const auto* point = response_point(response)) return point->at;
  const auto* force = response.as<SectionForceResponse>();
  return force == nullptr ? std::nullopt : force->station;
}

std::optional<TimeDerivative> time_derivative_of(const ResponseSettings& response) {
  const auto derivative = [](const auto& one) -> std::optional<TimeDerivative> {
    if constexpr (requires { one.derivative; }) return one.derivative;
    return std::nullopt;
  };
  return std::visit(derivative, response.what);
}

bool is_against_rigid_mechanism(const ResponseSettings& response) {
  const auto* deflection = response.as<DeflectionResponse>();
  return deflection != nullptr && deflection->against == DeflectionReference::rigid_mechanism;
}

const Expression* formula_of(const ResponseSettings& response) {
  const auto* formula = response.as<ExpressionResponse>();
  return formula == nullptr ? nullptr : formula->expression.get();
}

}  // namespace pleuel
