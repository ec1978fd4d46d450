#pragma once

#include "core/response/named_places.hpp"
#include "core/response/nodal_map.hpp"
#include "core/response/station.hpp"

namespace pleuel {

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
  /// A number of stress, of one point of one station.
  struct StressPlace {
    std::string name;
    int station;
    int point;           ///< of the section, or −1: on its outline
    double angle = 0.0;  ///< on the outline
  };
  /// The matrices of the recovery in nodal coordinates.
  struct Rows {
    Eigen::MatrixXd of_nodal, of_accelerations, of_stretching;
  };

  const SectionProperties<double>& section_of(int station) const;
  void find_stress_places();
  template <class Scalar>
  static StressPoint<Scalar> point_of(const SectionProperties<Scalar>& section,
                                      const StressPlace& place);
  template <class Scalar>
  static Eigen::Matrix<Scalar, 2, 19> unit_stresses(const BeamElement<Scalar>& element,
                                                    const SectionProperties<Scalar>& section,
                                                    const StressPlace& place, double xi);
  int place_of_node(int node) const;
  template <class Scalar, class Number>
  Rows rows_of(const Beam<Scalar>& beam, const Number& number) const;
  void add_element(Eigen::Index row, int e, const Eigen::MatrixXd& columns, Rows& rows) const;
  StressRecovery recovery_of(const Rows& rows, const Eigen::MatrixXd& of_coordinates) const;
  Rows values() const;

  const BodyModel& body_;
  NodalMap nodal_;
  const std::vector<NamedPlace>& places_;
  std::vector<Station> stations_;
  std::vector<StressPlace> stress_places_;
};

}  // namespace pleuel
