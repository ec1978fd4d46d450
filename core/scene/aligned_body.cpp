#include "core/scene/aligned_body.hpp"

#include <cmath>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/scene/visit_constants.hpp"

namespace pleuel {

namespace {

/// Cosine of the angle between what two coordinates do, below which they are not the same.
constexpr double least_likeness = 0.7;

void require_same(std::size_t count, std::size_t expected, const char* what) {
  if (count == expected) return;
  throw SimulationError(fmt::format(
      "has {} {} where it had {} at the start: all designs need the same, so that numbers "
      "can be functions of the design",
      count, what, expected));
}

void require_same_arrangement(const InvariantsFile& reference, const InvariantsFile& file) {
  const BodyConstants &a = reference.constants, &b = file.constants;
  require_same(file.coordinates.size(), reference.coordinates.size(), "coordinates");
  require_same(b.places.size(), a.places.size(), "places");
  for (std::size_t i = 0; i < a.places.size(); ++i) {
    if (a.places[i].name == b.places[i].name) continue;
    throw SimulationError(fmt::format("has the place \"{}\" where it had \"{}\" at the start",
                                      b.places[i].name, a.places[i].name));
  }
  const auto points = [](const BodyConstants& of) {
    return of.stress ? of.stress->points.size() : 0;
  };
  require_same(points(b), points(a), "points of stress");
  if (a.stress && a.stress->points != b.stress->points) {
    throw SimulationError(
        "has other points of stress than at the start: choose them by name or place, not by what "
        "is "
        "largest, and keep the mesh");
  }
  if (a.stress && a.stress->groups != b.stress->groups) {
    throw SimulationError("has other groups of points of stress than at the start");
  }
  const auto elements = [](const BodyConstants& of) {
    return of.stretching ? of.stretching->elements.size() : 0;
  };
  require_same(elements(b), elements(a), "elements of stiffening");
}

/// What each coordinate does, a column each. Blocks are scaled so that each has a say, whatever its unit.
Eigen::MatrixXd characters_of(const BodyConstants& constants) {
  std::vector<Eigen::MatrixXd> blocks = {Eigen::MatrixXd(constants.shape),
                                         Eigen::MatrixXd(constants.mixed)};
  for (const BodyPlace& place : constants.places) {
    blocks.emplace_back(place.displacement);
    blocks.emplace_back(place.rotation);
  }
  if (constants.stress) blocks.emplace_back(constants.stress->of_coordinates);
  Eigen::Index rows = 0;
  for (const Eigen::MatrixXd& block : blocks) rows += block.rows();
  Eigen::MatrixXd characters(rows, constants.size());
  Eigen::Index row = 0;
  for (const Eigen::MatrixXd& block : blocks) {
    const double size = block.size() > 0 ? block.norm() : 0.0;
    characters.middleRows(row, block.rows()) = block / (size > 0.0 ? size : 1.0);
    row += block.rows();
  }
  return characters;
}

struct Counterpart {
  int coordinate = -1;  ///< of the file
  double sign = 1.0, likeness = 0.0;
};

/// The file's coordinate that does most nearly the same.
Counterpart counterpart_of(const Eigen::VectorXd& character, const Eigen::MatrixXd& characters,
                           const std::vector<bool>& is_taken) {
  Counterpart best;
  for (int j = 0; j < int_size(is_taken); ++j) {
    const double sizes = character.norm() * characters.col(j).norm();
    if (is_taken[j] || !(sizes > 0.0)) continue;
    const double cosine = character.dot(characters.col(j)) / sizes;
    if (std::abs(cosine) <= best.likeness) continue;
    best = {j, cosine < 0.0 ? -1.0 : 1.0, std::abs(cosine)};
  }
  return best;
}

SparseMatrix transformation_of(const InvariantsFile& reference, const InvariantsFile& file) {
  const Eigen::MatrixXd wanted = characters_of(reference.constants);
  const Eigen::MatrixXd given = characters_of(file.constants);
  const int size = file.constants.size();
  std::vector<bool> is_taken(size, false);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < size; ++i) {
    const Counterpart found = counterpart_of(wanted.col(i), given, is_taken);
    if (found.likeness < least_likeness) {
      throw SimulationError(
          fmt::format("has no coordinate that does what \"{}\" did at the start (likeness {:.2f}): "
                      "modes mix or "
                      "leave between these designs; take more of them, or fewer",
                      reference.coordinates[i], found.likeness));
    }
    is_taken[found.coordinate] = true;
    entries.emplace_back(found.coordinate, i, found.sign);
  }
  SparseMatrix t(size, size);
  t.setFromTriplets(entries.begin(), entries.end());
  return t;
}

}  // namespace

SparseMatrix alignment_of(const InvariantsFile& reference, const InvariantsFile& file) {
  require_same_arrangement(reference, file);
  return transformation_of(reference, file);
}

BodyConstants in_coordinates(BodyConstants constants, const SparseMatrix& t) {
  const auto transform = [&t](const ConstantsBlock& block, auto& numbers) {
    if constexpr (std::is_same_v<decltype(numbers), SparseMatrix&>) {
      if (block.indices == ByCoordinates::none) return;
      numbers = SparseMatrix(numbers * t);
      if (block.indices == ByCoordinates::both) numbers = SparseMatrix(t.transpose()) * numbers;
    }
  };
  visit_constants(transform, constants);
  return constants;
}

}  // namespace pleuel
