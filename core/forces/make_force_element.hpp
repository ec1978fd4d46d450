#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/forces/force_element.hpp"
#include "core/forces/force_term.hpp"
#include "core/forces/marker_gauge.hpp"

namespace pleuel {

/// Both of one law (force_term.hpp, marker_gauge.hpp).
template <class Law>
ForceElement make_force_element(
    const Law& law, const std::array<Marker, 2>& markers,
    const typename Law::template Data<double>& data,
    const std::vector<DesignDerivative<typename Law::template Data<double>>>& derivatives) {
  return {std::make_unique<ForceTerm<Law>>(law, markers, data, derivatives),
          std::make_unique<MarkerGauge<Law>>(law, markers, data, derivatives)};
}

}  // namespace pleuel
