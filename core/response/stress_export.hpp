#pragma once

#include <string>
#include <vector>

#include "core/beam/beam_shape.hpp"
#include "core/model/model.hpp"
#include "core/response/station.hpp"
#include "core/scene/problem_file.hpp"
#include "core/section/section_stress.hpp"

namespace pleuel {

struct NamedPlace {
  std::string name;
  BeamPlace place;
  double x = 0.0;  ///< along the beam [m]
};

/// The nodes of a beam and wherever joints, loads and responses are, along the beam. A place has
/// the name of the first joint, load or response there, else "node 3".
std::vector<NamedPlace> named_places(const ProblemFile& problem, const BodyModel& body);

/// Stress of a beam as matrices: of its coordinates, of accelerations of its places, and of the
/// forces of its stretched members (core/scene/body_constants.hpp). Body and places must outlive
/// it.
class StressExport {
 public:
  /// @param places  all nodes among them
  StressExport(const BodyModel& body, const std::vector<NamedPlace>& places);

  StressRecovery value() const;
  /// @param k  in the order of BodyModel::beam_x
  StressRecovery derivative(std::size_t k) const;

 private:
  /// A point of one station.
  struct StressPlace {
    std::string name;
    int station;
    int point;           ///< of the section, or −1: on its outline
    double angle = 0.0;  ///< on the outline
  };

  template <class Scalar>
  const SectionProperties<Scalar>& section_of(const Beam<Scalar>& beam, int station) const {
    const int element = stations_[station].elements.front();
    return beam.elements[element].section;
  }
  void find_stress_places();
  template <class Scalar>
  static StressPoint<Scalar> point_of(const SectionProperties<Scalar>& section,
                                      const StressPlace& place);
  template <class Scalar, class Number>
  SparseMatrix stress_of_forces(const Beam<Scalar>& beam, const Number& number) const;
  SparseMatrix stress_of_forces() const;
  SparseMatrix of_named_places(const SparseMatrix& of_nodes) const;
  StressRecovery recovery_of(const Recovery& stress, const Strengths<double>& strengths) const;
  std::vector<PointGroup> segment_groups() const;

  const BodyModel& body_;
  const std::vector<NamedPlace>& places_;
  std::vector<Station> stations_;
  std::vector<StressPlace> stress_places_;
};

}  // namespace pleuel
