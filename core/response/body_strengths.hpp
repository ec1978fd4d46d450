#pragma once

#include <utility>
#include <vector>

#include "core/base/dual.hpp"
#include "core/model/model.hpp"

namespace pleuel {

/// Of an elastic body: those of the material of a beam, or those of the file of an imported body.
Strengths<double> strengths_of(const BodyModel& body);

/// Their derivatives with respect to design variables: the variable, and those of each strength.
std::vector<std::pair<int, Strengths<double>>> strength_derivatives(const BodyModel& body);

Strengths<double> derivative_of(const Strengths<Dual>& strengths);

}  // namespace pleuel
