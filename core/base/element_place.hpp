#pragma once

namespace pleuel {

/// A place along a chain of elements: in which one, and where in it.
struct ElementPlace {
  int element = 0;
  double xi = 0.0;  ///< 0 … 1

  bool is_node() const { return xi == 0.0 || xi == 1.0; }
  int node() const { return xi < 0.5 ? element : element + 1; }
};

}  // namespace pleuel
