#include "core/scene/fixed_numbers.hpp"

#include "core/scene/visit_numbers.hpp"

namespace pleuel {

Scene with_fixed_numbers(Scene scene, const Design<double>& design) {
  visit_numbers(scene, [&](const Number& number, const Quantity&) {
    if (!number.is_bound()) return;
    const_cast<Number&>(number) = Number(resolve(number, design));  // of the copy, which is ours
  });
  return scene;
}

}  // namespace pleuel
