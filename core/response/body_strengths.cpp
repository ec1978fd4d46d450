#include "core/response/body_strengths.hpp"

namespace pleuel {

Strengths<double> strengths_of(const BodyModel& body) {
  if (body.is_imported()) return body.stress.strengths;
  return body.beam.elements.front().strengths;
}

Strengths<double> derivative_of(const Strengths<Dual>& strengths) {
  Strengths<double> derivative;
  for (std::size_t i = 0; i < strength_members<double>.size(); ++i) {
    derivative.*strength_members<double>[i].member =
        derivative_of(strengths.*strength_members<Dual>[i].member);
  }
  return derivative;
}

std::vector<std::pair<int, Strengths<double>>> strength_derivatives(const BodyModel& body) {
  std::vector<std::pair<int, Strengths<double>>> all;
  for (const auto& [variable, stress] : body.stress_x) {
    all.emplace_back(variable, stress.strengths);
  }
  for (const auto& [variable, beam] : body.beam_x) {
    all.emplace_back(variable, derivative_of(beam.elements.front().strengths));
  }
  return all;
}

}  // namespace pleuel
