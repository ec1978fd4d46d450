#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/model/model.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel {

/// Where along a beam section forces are asked for: everywhere, in one segment, or at one place.
struct StationChoice {
  std::optional<int> segment;
  std::optional<double> place;  ///< 0 … 1
  /// Of the stations of a place where section forces may jump, only this one.
  std::optional<SectionSide> side = {};
};

/// A section at which section forces are evaluated: a node, seen from one or two elements, or a
/// place inside an element.
struct Station {
  std::vector<int> elements;  ///< adjacent, ascending
  double place;               ///< counted in elements: 2 is node 2, 2.5 half an element further
  /// Derivatives of the place in each of the elements, in the order of those of the body; empty: it does
  /// not depend on the design.
  std::vector<std::vector<double>> place_x = {};

  /// In one of the elements, 0 … 1, with the derivative number k of the body.
  Dual xi_along(std::size_t element, std::size_t k) const {
    return {place - elements[element],
            Dual::Derivatives::Constant(place_x.empty() ? 0.0 : place_x[element][k])};
  }
};

/// By default every node and quarter point of the elements. Nodes between two elements of one
/// segment are one station; between two segments, and where a joint or load acts, one for each:
/// section forces may jump there.
std::vector<Station> find_stations(const BodyModel& body, const StationChoice& choice);

/// Where it is, counted along the whole beam: "node 3"; "node 3 towards node 4" where section forces
/// may jump at the node; "node 2.5" half way between two.
std::string describe(const Station& station, const BodyModel& body);

}  // namespace pleuel
