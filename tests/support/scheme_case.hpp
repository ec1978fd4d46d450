#pragma once

#include <ostream>
#include <string>

#include "core/integration/simulate.hpp"

/// A scheme and a formulation, for suites that go through several of them.
struct SchemeCase {
  std::string name;
  pleuel::SchemeType scheme = pleuel::SchemeType::generalized_alpha;
  double spectral_radius = 0.8;
  pleuel::Formulation formulation;
  double order = 2.0;  ///< that its theory promises

  void set(pleuel::SimulationOptions& options) const {
    options.scheme = scheme;
    options.spectral_radius = spectral_radius;
    options.formulation = formulation;
  }
  friend std::ostream& operator<<(std::ostream& stream, const SchemeCase& scheme_case) {
    return stream << scheme_case.name;
  }
};

inline constexpr pleuel::SchemeType alpha = pleuel::SchemeType::generalized_alpha;
inline constexpr pleuel::Formulation index_3{};
inline constexpr pleuel::Formulation stabilized{pleuel::ConstraintForm::stabilized_index_2};
inline constexpr pleuel::Formulation index_1{pleuel::ConstraintForm::index_1};
inline constexpr pleuel::Formulation baumgarte{pleuel::ConstraintForm::index_1, 200.0};
inline constexpr pleuel::Formulation projected{pleuel::ConstraintForm::index_1, 0.0, true};
