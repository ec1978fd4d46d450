#include "core/scene/reading/constants_reader.hpp"

#include <cmath>
#include <set>

#include <Eigen/SparseCholesky>
#include <fmt/format.h>

#include "core/base/dense_solvers.hpp"
#include "core/base/find_named.hpp"
#include "core/scene/kind_table.hpp"
#include "core/scene/visit_constants.hpp"

namespace pleuel {

namespace {

constexpr int most_rows = 1000000;
constexpr int components = 6;  // of stress
constexpr std::size_t most_displacements = 12;

void read_numbers(const JsonNode& node, double& number) {
  number = node.number();
  if (!std::isfinite(number)) node.fail_with_value("must be finite");
}

template <int rows, int columns>
void read_numbers(const JsonNode& node, Eigen::Matrix<double, rows, columns>& matrix) {
  const std::vector<JsonNode> items = node.items(matrix.rows());
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    if constexpr (columns == 1) {
      read_numbers(items[i], matrix(i));
    } else {
      Eigen::VectorXd row(matrix.cols());
      read_numbers(items[i], row);
      matrix.row(i) = row;
    }
  }
}

/// A list of [row, column, value], rows and columns from 0.
void read_numbers(const JsonNode& node, SparseMatrix& matrix) {
  std::vector<Eigen::Triplet<double>> entries;
  std::set<std::pair<int, int>> places;
  for (const JsonNode& item : node.items()) {
    const std::vector<JsonNode> entry = item.items(3);
    const int row = entry[0].whole_number(0, static_cast<int>(matrix.rows()) - 1);
    const int column = entry[1].whole_number(0, static_cast<int>(matrix.cols()) - 1);
    if (!places.insert({row, column}).second) {
      item.fail(fmt::format("is a second entry in row {}, column {}", row, column));
    }
    double value = 0.0;
    read_numbers(entry[2], value);
    entries.emplace_back(row, column, value);
  }
  matrix.setFromTriplets(entries.begin(), entries.end());
}

// Blocks of an object. `visit_blocks` is one of the functions of visit_constants.hpp for it.

/// Whether blocks say what a body is, or what a design variable changes: what is missing there is zero.
enum class BlocksOf { body, derivative };

/// The node has keys of these blocks, and these besides, only. What is missing stays as it is.
template <class VisitBlocks>
void read_blocks(const JsonNode& node, BlocksOf of, const VisitBlocks& visit_blocks,
                 std::vector<std::string_view> keys = {}) {
  visit_blocks([&](const ConstantsBlock& block, const auto&) { keys.push_back(block.word); });
  node.allow_keys(keys);
  visit_blocks([&](const ConstantsBlock& block, auto& numbers) {
    const std::string word(block.word);
    const bool is_needed = of == BlocksOf::body && !block.may_be_missing;
    const auto found = is_needed ? node.at(word) : node.find(word);
    if (found) read_numbers(*found, numbers);
  });
}

void read_invariants_block(const JsonNode& node, BlocksOf of, BodyConstants& constants) {
  read_blocks(node, of, [&](const auto& visit) { visit_invariants(visit, constants); });
}

void read_place(const JsonNode& node, BlocksOf of, BodyPlace& place) {
  read_blocks(node, of, [&](const auto& visit) { visit_place(visit, place); });
}

void set_sizes(BodyConstants& constants, int n) {
  constants.shape = SparseMatrix(3, n);
  constants.mixed = SparseMatrix(9, n);
  for (auto* matrix : {&constants.mass_matrix, &constants.stiffness, &constants.damping}) {
    *matrix = SparseMatrix(n, n);
  }
  for (SparseMatrix& moment : constants.moments) moment = SparseMatrix(n, n);
}

void read_places(const JsonNode& node, BodyConstants& constants) {
  for (const auto& [name, member] : node.members()) {
    BodyPlace place{name, {}, SparseMatrix(3, constants.size()), SparseMatrix(3, constants.size())};
    read_place(member, BlocksOf::body, place);
    constants.places.push_back(std::move(place));
  }
  if (constants.places.empty()) node.fail("must have at least one place");
}

void read_changes_of_places(const JsonNode& node, BodyConstants& change) {
  for (const auto& [name, member] : node.members()) {
    BodyPlace* place = find_named(change.places, name);
    if (place == nullptr) fail_unknown_name(node, "place", name, names_of(change.places));
    read_place(member, BlocksOf::derivative, *place);
  }
}

std::vector<int> read_group(const JsonNode& node, const StressRecovery& stress) {
  std::set<int> members;
  for (const JsonNode& item : node.items()) {
    const std::string name = item.text();
    const std::vector<int> found = named_points(stress, name);
    if (found.empty()) fail_unknown_name(item, "point", name, stress.points);
    members.insert(found.begin(), found.end());
  }
  if (members.empty()) node.fail("must name at least one point");
  return {members.begin(), members.end()};
}

void read_groups(const JsonNode& node, StressRecovery& stress) {
  std::vector<PointGroup> groups;
  for (const auto& [name, member] : node.members()) {
    if (!named_points(stress, name).empty()) member.fail("has the name of a point");
    groups.push_back({name, read_group(member, stress)});
  }
  stress.groups = std::move(groups);
}

void read_strengths(const JsonNode& node, Strengths<double>& strengths) {
  for (const auto& [word, member] : strength_members<double>) {
    const auto strength = node.find(std::string(word));
    if (strength && strengths.*member <= 0.0) strength->fail_with_value("must be positive [Pa]");
  }
  const auto exponent = node.find(std::string(fatigue_exponent_word));
  if (!exponent) return;
  read_numbers(*exponent, strengths.fatigue_exponent);
  if (strengths.fatigue_exponent < 1.0) exponent->fail_with_value("must be at least 1");
}

void read_stress(const JsonNode& node, BodyConstants& constants) {
  StressRecovery stress;
  for (const JsonNode& point : node.at("points").items()) stress.points.push_back(point.text());
  if (stress.points.empty()) node.at("points").fail("must have at least one point");
  const auto rows = components * static_cast<Eigen::Index>(stress.points.size());
  const auto elements = constants.stretching ? constants.stretching->elements.size() : 0;
  stress.of_coordinates = SparseMatrix(rows, constants.size());
  stress.of_accelerations =
      SparseMatrix(rows, 3 * static_cast<Eigen::Index>(constants.places.size()));
  stress.of_stretching = SparseMatrix(rows, elements);
  if (node.find("of_stretching") && !constants.stretching) {
    node.at("of_stretching").fail("needs the block \"stiffening\"");
  }
  if (const auto groups = node.find("groups")) read_groups(*groups, stress);
  read_blocks(node, BlocksOf::body, [&](const auto& visit) { visit_stress(visit, stress); },
              {"points", "groups", fatigue_exponent_word});
  read_strengths(node, stress.strengths);
  constants.stress = std::move(stress);
}

StretchedElement read_element(const JsonNode& node, Eigen::Index displacements) {
  StretchedElement element;
  const JsonNode list = node.at("displacements");
  for (const JsonNode& item : list.items()) {
    const int index = item.whole_number(0, static_cast<int>(displacements) - 1);
    for (const int other : element.displacements) {
      if (other == index) item.fail_with_value("is there twice");
    }
    element.displacements.push_back(index);
  }
  const std::size_t size = element.displacements.size();
  if (size == 0 || size > most_displacements) {
    list.fail(fmt::format("must have 1 to {} values, got {}", most_displacements, size));
  }
  element.elongation.resize(size);
  element.slopes.resize(size, size);
  read_numbers(node.at("elongation"), element.elongation);
  read_blocks(node, BlocksOf::body, [&](const auto& visit) { visit_element(visit, element); },
              {"displacements", "elongation"});
  if (element.axial_stiffness <= 0.0) {
    node.at("axial_stiffness").fail_with_value("must be positive [N/m]");
  }
  return element;
}

void read_stiffening(const JsonNode& node, BodyConstants& constants) {
  Stretching stretching;
  stretching.displacements =
      SparseMatrix(node.at("size").whole_number(1, most_rows), constants.size());
  read_blocks(node, BlocksOf::body, [&](const auto& visit) { visit_stretching(visit, stretching); },
              {"size", "elements"});
  for (const JsonNode& item : node.at("elements").items()) {
    stretching.elements.push_back(read_element(item, stretching.displacements.rows()));
  }
  if (stretching.elements.empty()) node.at("elements").fail("must have at least one element");
  constants.stretching = std::move(stretching);
}

void read_change_of_stiffening(const JsonNode& node, Stretching& change) {
  read_blocks(node, BlocksOf::derivative,
              [&](const auto& visit) { visit_stretching(visit, change); }, {"elements"});
  const auto elements = node.find("elements");
  if (!elements) return;
  std::size_t i = 0;
  for (const JsonNode& item : elements->items(change.elements.size())) {
    StretchedElement& element = change.elements[i++];
    read_blocks(item, BlocksOf::derivative,
                [&](const auto& visit) { visit_element(visit, element); });
  }
}

std::vector<std::array<int, 3>> read_triangles(const JsonNode& node, int points) {
  std::vector<std::array<int, 3>> triangles;
  for (const JsonNode& item : node.items()) {
    const std::vector<JsonNode> corners = item.items(3);
    std::array<int, 3>& triangle = triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) triangle[i] = corners[i].whole_number(0, points - 1);
  }
  return triangles;
}

}  // namespace

BodySurface read_surface(const JsonNode& node, int coordinates) {
  node.allow_keys({"positions", "triangles", "displacement", "young", "poisson"});
  BodySurface surface;
  const auto read_rows = [&](const char* key, int columns) {
    Eigen::MatrixXd rows(node.at(key).items().size(), columns);
    read_numbers(node.at(key), rows);
    return rows;
  };
  surface.positions = read_rows("positions", 3).transpose();
  const int points = static_cast<int>(surface.positions.cols());
  surface.triangles = read_triangles(node.at("triangles"), points);
  surface.displacement = read_rows("displacement", coordinates);
  if (surface.displacement.rows() != 3 * points) {
    node.at("displacement").fail("must have three rows for each of the \"positions\"");
  }
  surface.young = node.at("young").number();
  surface.poisson = node.at("poisson").number();
  if (!(surface.young > 0.0)) node.at("young").fail_with_value("must be positive [Pa]");
  if (!(std::abs(surface.poisson) < 1.0)) {
    node.at("poisson").fail_with_value("must be between -1 and 1");
  }
  return surface;
}

BodyConstants read_constants(const JsonNode& node, int coordinates) {
  BodyConstants constants;
  set_sizes(constants, coordinates);
  read_invariants_block(node.at("invariants"), BlocksOf::body, constants);
  read_places(node.at("places"), constants);
  if (const auto stiffening = node.find("stiffening")) read_stiffening(*stiffening, constants);
  if (const auto stress = node.find("stress")) read_stress(*stress, constants);
  return constants;
}

BodyConstants read_derivative(const JsonNode& node, const BodyConstants& of) {
  node.allow_keys({"invariants", "places", "stress", "stiffening"});
  BodyConstants change = zero_constants(of);
  const auto require = [](const JsonNode& block, bool is_there) {
    if (!is_there) block.fail("has no block of the same name outside the derivatives");
  };
  if (const auto invariants = node.find("invariants")) {
    read_invariants_block(*invariants, BlocksOf::derivative, change);
  }
  if (const auto places = node.find("places")) read_changes_of_places(*places, change);
  if (const auto stress = node.find("stress")) {
    require(*stress, change.stress.has_value());
    read_blocks(*stress, BlocksOf::derivative,
                [&](const auto& visit) { visit_stress(visit, *change.stress); });
  }
  if (const auto stiffening = node.find("stiffening")) {
    require(*stiffening, change.stretching.has_value());
    read_change_of_stiffening(*stiffening, *change.stretching);
  }
  return change;
}

namespace {

/// Relative to the largest entry: other codes may write single precision or seven digits.
constexpr double tolerance = 1e-6;
/// Places closer than this share of the extent are one.
constexpr double distinct = 1e-9;

double largest(const SparseMatrix& matrix) {
  return matrix.nonZeros() > 0 ? matrix.coeffs().abs().maxCoeff() : 0.0;
}

void check_symmetry(const JsonNode& block, const std::string& key, const SparseMatrix& matrix) {
  const SparseMatrix difference = matrix - SparseMatrix(matrix.transpose());
  if (largest(difference) <= tolerance * largest(matrix)) return;
  block.at(key).fail(fmt::format("must be symmetric, but differs from its transpose by {:.3g}",
                                 largest(difference)));
}

void check_symmetry(const JsonNode& node, const Eigen::MatrixXd& matrix) {
  const double size = matrix.cwiseAbs().maxCoeff();
  if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() <= tolerance * size) return;
  node.fail_with_value("must be symmetric");
}

/// By the pivots of the matrix with a diagonal of ones.
bool is_positive_definite(const SparseMatrix& matrix) {
  constexpr double least_pivot = 1e-14;
  const Eigen::VectorXd diagonal = matrix.diagonal();
  if (diagonal.minCoeff() <= 0.0) return false;
  const Eigen::VectorXd scale = diagonal.cwiseSqrt().cwiseInverse();
  const Eigen::SparseMatrix<double> scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(scaled);
  return factors.info() == Eigen::Success && factors.vectorD().minCoeff() > least_pivot;
}

/// S_xx + S_yy + S_zz is the mass matrix, if both come from one interpolation.
void check_moments(const JsonNode& block, const BodyConstants& constants) {
  for (std::size_t i : {0U, 1U, 2U}) {
    const std::string key(moment_words[i]);
    if (block.find(key)) check_symmetry(block, key, constants.moments[i]);
  }
  const SparseMatrix sum = constants.moments[0] + constants.moments[1] + constants.moments[2];
  const SparseMatrix difference = sum - constants.mass_matrix;
  if (largest(difference) <= tolerance * largest(constants.mass_matrix)) return;
  block.fail(fmt::format(
      "must have \"mass_matrix\" = \"moment_xx\" + \"moment_yy\" + \"moment_zz\", but they differ "
      "by {:.3g} [kg], {:.3g} of the largest entry",
      largest(difference), largest(difference) / largest(constants.mass_matrix)));
}

void check_rigid_inertia(const JsonNode& block, const BodyConstants& constants) {
  if (constants.mass <= 0.0) block.at("mass").fail_with_value("must be positive [kg]");
  const Eigen::Matrix3d& second = constants.second_moment;
  check_symmetry(block.at("second_moment"), second);
  const Eigen::Matrix3d central =
      second - constants.first_moment * constants.first_moment.transpose() / constants.mass;
  if (symmetric_eigenvalues(central)(0) < -tolerance * second.cwiseAbs().maxCoeff()) {
    block.at("second_moment")
        .fail_with_value("must be at least first_moment first_momentᵀ / mass in every direction");
  }
}

void check_places(const JsonNode& node, const BodyConstants& constants) {
  const double near = distinct * size_of(constants);
  for (std::size_t i = 0; i < constants.places.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if ((constants.places[i].position - constants.places[k].position).norm() > near) continue;
      node.at(constants.places[i].name)
          .fail(fmt::format("is where the place \"{}\" is", constants.places[k].name));
    }
  }
}

}  // namespace

void check_constants(const JsonNode& node, const BodyConstants& constants) {
  const JsonNode block = node.at("invariants");
  check_rigid_inertia(block, constants);
  for (const auto& [key, matrix] : {std::pair("mass_matrix", &constants.mass_matrix),
                                    std::pair("stiffness", &constants.stiffness)}) {
    check_symmetry(block, key, *matrix);
  }
  if (block.find("damping")) check_symmetry(block, "damping", constants.damping);
  check_moments(block, constants);
  if (!is_positive_definite(constants.mass_matrix)) {
    block.at("mass_matrix").fail("must be positive definite: every coordinate moves mass");
  }
  if (!is_positive_definite(constants.stiffness)) {
    block.at("stiffness")
        .fail(
            "must be positive definite: the reference condition leaves the elastic coordinates no "
            "rigid motion");
  }
  check_places(node.at("places"), constants);
  if (!constants.stretching) return;
  const std::vector<JsonNode> elements = node.at("stiffening").at("elements").items();
  for (std::size_t i = 0; i < elements.size(); ++i) {
    check_symmetry(elements[i].at("slopes"), constants.stretching->elements[i].slopes);
  }
}

void check_derivative(const JsonNode& node, const BodyConstants& change) {
  const auto block = node.find("invariants");
  if (!block) return;
  for (const auto& [key, matrix] :
       {std::pair("mass_matrix", &change.mass_matrix), std::pair("stiffness", &change.stiffness),
        std::pair("damping", &change.damping)}) {
    if (block->find(key)) check_symmetry(*block, key, *matrix);
  }
  check_moments(*block, change);
}

}  // namespace pleuel
