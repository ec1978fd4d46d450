#pragma once

namespace pleuel {

/// How many entries a container or a matrix has, as an index counts them. None here has 2³¹.
template <class Container>
constexpr int int_size(const Container& container) {
  return static_cast<int>(container.size());
}

}  // namespace pleuel
