#pragma once

#include <array>
#include <string_view>

namespace pleuel {

/// What stress of a material is compared with [Pa]; 0: not given.
template <class Scalar>
struct Strengths {
  Scalar yield = Scalar(0);
  Scalar ultimate = Scalar(0);         ///< of fracture
  Scalar endurance_limit = Scalar(0);  ///< of the amplitude of stress without mean
  Scalar fatigue = Scalar(0);          ///< σ_f' of Basquin's line σ_a = σ_f' (2N)^(−1/k)
  double fatigue_exponent = 0.0;       ///< k [–], the same in all designs
};

template <class Scalar>
struct StrengthMember {
  std::string_view word;  ///< in files
  Scalar Strengths<Scalar>::*member;
};

template <class Scalar>
inline constexpr std::array<StrengthMember<Scalar>, 4> strength_members = {
    {{"strength", &Strengths<Scalar>::yield},
     {"ultimate_strength", &Strengths<Scalar>::ultimate},
     {"endurance_limit", &Strengths<Scalar>::endurance_limit},
     {"fatigue_strength", &Strengths<Scalar>::fatigue}}};
inline constexpr std::string_view fatigue_exponent_word = "fatigue_exponent";

}  // namespace pleuel
