#pragma once

#include "core/base/time_law.hpp"

namespace pleuel {

/// What a damper and the resistance to a rate take: c ṡ + r(e, ṡ, t) − r(e, 0, t).
template <class Scalar>
Scalar damper_force(const Scalar& damping, const TimeLaw<Scalar>& resistance, double time,
                    const Scalar& elongation, const Scalar& rate) {
  return damping * rate + resistance.value_at(time, elongation, rate) -
         resistance.value_at(time, elongation, Scalar(0));
}

}  // namespace pleuel
