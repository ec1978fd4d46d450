#include "core/trust/shear_share.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/trust/beam_bending.hpp"
#include "core/trust/beam_state.hpp"

namespace pleuel {

namespace {

/// Planes in which a beam deflects less than this share of the other do not count.
constexpr double still = 1e-3;

double energy_ratio(const BeamBending& elements) {
  double bending = 0.0, shear = 0.0;
  for (const ElementBending& element : elements) {
    bending += element.bending_energy();
    shear += element.shear_energy();
  }
  return bending > 0.0 ? shear / bending : 0.0;
}

/// Values at nodes, and the largest against an end of the beam or the line through both.
struct Course {
  std::vector<double> x{0.0}, value;

  double against_node(std::size_t node) const {
    double largest = 0.0;
    for (double v : value) largest = std::max(largest, std::abs(v - value[node]));
    return largest;
  }
  double against_chord() const {
    double largest = 0.0;
    for (std::size_t i = 0; i < value.size(); ++i) {
      largest = std::max(largest, std::abs(value[i] - chord_at(x[i] / x.back())));
    }
    return largest;
  }
  double chord_at(double share) const {
    return (1.0 - share) * value.front() + share * value.back();
  }
};

double ratio(double part, double whole) {
  return whole > 0.0 ? part / whole : 0.0;
}

/// Deflections by bending and by shear along a beam.
struct Deflections {
  Course bending, shear;

  explicit Deflections(const BeamBending& elements) {
    bending.value = {elements.front().deflection[0]};
    shear.value = {0.0};
    for (const ElementBending& element : elements) {
      for (Course* course : {&bending, &shear})
        course->x.push_back(course->x.back() + element.length);
      bending.value.push_back(element.deflection[1]);
      // V = −EI v''' bends by +V/κGA
      shear.value.push_back(shear.value.back() -
                            element.force() / element.shear_stiffness * element.length);
    }
  }
};

bool is_against_chord(const BodyModel& body) {
  return body.condition == ReferenceCondition::chord ||
         body.condition == ReferenceCondition::mean_axis;
}

std::size_t clamped_node(const BodyModel& body, const BeamBending& elements) {
  return body.condition == ReferenceCondition::tangent_end ? elements.size() : 0;
}

/// At a place along the beam, against its frame: of deflections that count beside the largest.
double displacement_ratio_at(double place, const BodyModel& body, const BeamBending& elements) {
  const auto [bending, shear] = Deflections(elements);
  const double x = place * bending.x.back();
  std::size_t i = 0;
  while (i + 1 < elements.size() && x > bending.x[i + 1]) ++i;
  const double length = elements[i].length, share = (x - bending.x[i]) / length;
  const auto [a, b] = elements[i].curvature;
  const double bow =
      length * length * share * (1.0 - share) * (a * (2.0 - share) + b * (1.0 + share)) / 6.0;
  const auto at = [&](const Course& course) {
    const double reference = is_against_chord(body) ? course.chord_at(place)
                                                    : course.value[clamped_node(body, elements)];
    return (1.0 - share) * course.value[i] + share * course.value[i + 1] - reference;
  };
  const double largest = is_against_chord(body)
                             ? bending.against_chord()
                             : bending.against_node(clamped_node(body, elements));
  const double bent = std::abs(at(bending) - bow);
  return bent > still * largest ? std::abs(at(shear)) / bent : 0.0;
}

/// The larger one of the shares against the frame and against the chord.
double displacement_ratio(const BodyModel& body, const BeamBending& elements) {
  const auto [bending, shear] = Deflections(elements);
  const double chord = ratio(shear.against_chord(), bending.against_chord());
  if (is_against_chord(body)) return chord;
  const std::size_t clamped = clamped_node(body, elements);
  return std::max(chord, ratio(shear.against_node(clamped), bending.against_node(clamped)));
}

/// Between nodes, too: by its curvature, which one element between the ends of a frame has alone.
double largest_deflection(const BeamBending& elements) {
  double largest = 0.0, slope = 0.0;
  Course bent;  // v'' = κ, from a straight beginning
  bent.value = {0.0};
  for (const ElementBending& element : elements) {
    for (double v : element.deflection) largest = std::max(largest, std::abs(v));
    const auto [a, b] = element.curvature;
    const double l = element.length;
    bent.x.push_back(bent.x.back() + l);
    bent.value.push_back(bent.value.back() + slope * l + l * l * (2.0 * a + b) / 6.0);
    slope += 0.5 * l * (a + b);
  }
  return std::max(largest, bent.against_chord());
}

}  // namespace

ShearShare shear_share(const ProblemFile& problem, const Eigen::VectorXd& x, const Model& model,
                       const std::string& name, const State& state, std::optional<double> place) {
  const BendingReader reader(problem, x, name);
  const std::vector<const BodyModel*> parts = model.parts(name);
  std::array<BeamBending, 2> planes;
  for (const BodyModel* part : parts) {
    const Eigen::MatrixXd nodal = nodal_displacements(*part, state);
    for (int plane = 0; plane < 2; ++plane) {
      BeamBending& elements = planes[plane];
      const BeamBending more = reader.read(*part, nodal, plane);
      elements.insert(elements.end(), more.begin(), more.end());
    }
  }
  const std::array<double, 2> size{largest_deflection(planes[0]), largest_deflection(planes[1])};
  std::array<double, 2> shares{};
  for (std::size_t plane = 0; plane < 2; ++plane) {
    if (size[plane] <= still * size[1 - plane] || size[plane] == 0.0) continue;
    if (parts.size() > 1) {
      shares[plane] = energy_ratio(planes[plane]);
    } else if (place) {
      shares[plane] = displacement_ratio_at(*place, *parts.front(), planes[plane]);
    } else {
      shares[plane] = displacement_ratio(*parts.front(), planes[plane]);
    }
  }
  return {shares[0], shares[1], std::max(size[0], size[1])};
}

}  // namespace pleuel
