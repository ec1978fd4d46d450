#include "core/model/build_context.hpp"

namespace pleuel {

Design<Dual> BuildContext::seeded(int variable) const {
  Design<Dual> dual;
  for (double value : design) dual.emplace_back(value);
  dual[variable].derivatives()[0] = 1.0;
  return dual;
}

}  // namespace pleuel
