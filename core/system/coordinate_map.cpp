#include "core/system/coordinate_map.hpp"

#include "core/base/int_size.hpp"

namespace pleuel {

LocalState::LocalState(const CoordinateMap& map)
    : local(map.size(), int_size(map.multipliers)),
      q(map.columns()),
      v(map.columns()),
      a(map.columns()) {}

void LocalState::set(const CoordinateMap& map, const State& state) {
  local.time = state.time;
  map.gather(state.q, q, local.q);
  map.gather(state.v, v, local.v);
  map.gather(state.a, a, local.a);
  for (std::size_t i = 0; i < map.multipliers.size(); ++i) {
    local.lambda(i) = state.lambda(map.multipliers[i]);
  }
}

}  // namespace pleuel
