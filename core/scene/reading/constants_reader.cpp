#include "core/scene/reading/constants_reader.hpp"

#include <cmath>
#include <set>

#include <Eigen/SparseCholesky>
#include <fmt/format.h>

#include "core/base/dense_solvers.hpp"

namespace pleuel {

namespace {

constexpr int most_rows = 1000000;
constexpr int components = 6;  // of stress
constexpr std::size_t most_displacements = 12;

std::string moment_name(std::size_t pair) {
  const auto [k, l] = moment_pairs[pair];
  return fmt::format("moment_{}{}", "xyz"[k], "xyz"[l]);
}

double read_number(const JsonNode& node) {
  const double number = node.number();
  if (!std::isfinite(number)) node.fail_with_value("must be finite");
  return number;
}

Eigen::VectorXd read_vector(const JsonNode& node, std::size_t size) {
  Eigen::VectorXd vector(size);
  Eigen::Index i = 0;
  for (const JsonNode& item : node.items(size)) vector(i++) = read_number(item);
  return vector;
}

Eigen::MatrixXd read_rows(const JsonNode& node, std::size_t size) {
  Eigen::MatrixXd matrix(size, size);
  Eigen::Index i = 0;
  for (const JsonNode& row : node.items(size)) matrix.row(i++) = read_vector(row, size);
  return matrix;
}

SparseMatrix empty_matrix(Eigen::Index rows, Eigen::Index columns) {
  return SparseMatrix(rows, columns);
}

/// A list of [row, column, value], rows and columns from 0.
SparseMatrix read_matrix(const JsonNode& node, Eigen::Index rows, Eigen::Index columns) {
  std::vector<Eigen::Triplet<double>> entries;
  std::set<std::pair<int, int>> places;
  for (const JsonNode& item : node.items()) {
    const std::vector<JsonNode> entry = item.items(3);
    const int row = entry[0].whole_number(0, static_cast<int>(rows) - 1);
    const int column = entry[1].whole_number(0, static_cast<int>(columns) - 1);
    if (!places.insert({row, column}).second) {
      item.fail(fmt::format("is a second entry in row {}, column {}", row, column));
    }
    entries.emplace_back(row, column, read_number(entry[2]));
  }
  SparseMatrix matrix = empty_matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// One of the matrices that are there or zero.
void read_into(const JsonNode& node, const std::string& key, SparseMatrix& matrix) {
  if (const auto entries = node.find(key)) {
    matrix = read_matrix(*entries, matrix.rows(), matrix.cols());
  }
}

void set_sizes(BodyConstants& constants, int n) {
  constants.shape = empty_matrix(3, n);
  constants.mixed = empty_matrix(9, n);
  for (auto* matrix : {&constants.mass_matrix, &constants.stiffness, &constants.damping}) {
    *matrix = empty_matrix(n, n);
  }
  for (SparseMatrix& moment : constants.moments) moment = empty_matrix(n, n);
}

void read_invariants_block(const JsonNode& node, BodyConstants& constants, bool is_derivative) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < moment_pairs.size(); ++i) names.push_back(moment_name(i));
  std::vector<std::string_view> keys = {"mass",  "first_moment", "second_moment", "shape",
                                        "mixed", "mass_matrix",  "stiffness",     "damping"};
  keys.insert(keys.end(), names.begin(), names.end());
  node.allow_keys(keys);
  if (!is_derivative) {
    for (const char* key :
         {"mass", "first_moment", "second_moment", "shape", "mixed", "mass_matrix", "stiffness"}) {
      node.at(key);
    }
  }
  if (const auto mass = node.find("mass")) constants.mass = read_number(*mass);
  if (const auto first = node.find("first_moment")) constants.first_moment = read_vector(*first, 3);
  if (const auto second = node.find("second_moment")) {
    constants.second_moment = read_rows(*second, 3);
  }
  read_into(node, "shape", constants.shape);
  read_into(node, "mixed", constants.mixed);
  for (std::size_t i = 0; i < names.size(); ++i) read_into(node, names[i], constants.moments[i]);
  read_into(node, "mass_matrix", constants.mass_matrix);
  read_into(node, "stiffness", constants.stiffness);
  read_into(node, "damping", constants.damping);
}

void read_place(const JsonNode& node, BodyPlace& place) {
  node.allow_keys({"position", "displacement", "rotation"});
  if (const auto position = node.find("position")) place.position = read_vector(*position, 3);
  read_into(node, "displacement", place.displacement);
  read_into(node, "rotation", place.rotation);
}

void read_places(const JsonNode& node, BodyConstants& constants) {
  for (const auto& [name, member] : node.members()) {
    BodyPlace place{name, {}, empty_matrix(3, constants.size()), empty_matrix(3, constants.size())};
    member.at("position");
    read_place(member, place);
    constants.places.push_back(std::move(place));
  }
  if (constants.places.empty()) node.fail("must have at least one place");
}

void read_changes_of_places(const JsonNode& node, BodyConstants& change) {
  std::vector<std::string> names;
  for (const BodyPlace& place : change.places) names.push_back(place.name);
  for (const auto& [name, member] : node.members()) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) fail_unknown_name(node, "place", name, names);
    read_place(member, change.places[found - names.begin()]);
  }
}

/// Keys that derivatives have, too.
std::vector<std::string_view> stress_keys() {
  std::vector<std::string_view> keys = {"of_coordinates", "of_accelerations", "of_stretching"};
  for (const auto& [word, member] : strength_members<double>) keys.push_back(word);
  return keys;
}

void read_stress_numbers(const JsonNode& node, StressRecovery& stress) {
  for (const auto& [word, member] : strength_members<double>) {
    if (const auto strength = node.find(std::string(word))) {
      stress.strengths.*member = read_number(*strength);
    }
  }
  read_into(node, "of_coordinates", stress.of_coordinates);
  read_into(node, "of_accelerations", stress.of_accelerations);
  read_into(node, "of_stretching", stress.of_stretching);
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
  strengths.fatigue_exponent = read_number(*exponent);
  if (strengths.fatigue_exponent < 1.0) exponent->fail_with_value("must be at least 1");
}

void read_stress(const JsonNode& node, BodyConstants& constants) {
  std::vector<std::string_view> keys = stress_keys();
  keys.insert(keys.end(), {"points", "groups", fatigue_exponent_word});
  node.allow_keys(keys);
  StressRecovery stress;
  for (const JsonNode& point : node.at("points").items()) stress.points.push_back(point.text());
  if (stress.points.empty()) node.at("points").fail("must have at least one point");
  const auto rows = components * static_cast<Eigen::Index>(stress.points.size());
  const auto elements = constants.stretching ? constants.stretching->elements.size() : 0;
  stress.of_coordinates = empty_matrix(rows, constants.size());
  stress.of_accelerations =
      empty_matrix(rows, 3 * static_cast<Eigen::Index>(constants.places.size()));
  stress.of_stretching = empty_matrix(rows, elements);
  if (node.find("of_stretching") && !constants.stretching) {
    node.at("of_stretching").fail("needs the block \"stiffening\"");
  }
  if (const auto groups = node.find("groups")) read_groups(*groups, stress);
  read_stress_numbers(node, stress);
  read_strengths(node, stress.strengths);
  constants.stress = std::move(stress);
}

StretchedElement read_element(const JsonNode& node, Eigen::Index displacements) {
  node.allow_keys({"displacements", "elongation", "axial_stiffness", "slopes"});
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
  element.elongation = read_vector(node.at("elongation"), size);
  element.axial_stiffness = read_number(node.at("axial_stiffness"));
  if (element.axial_stiffness <= 0.0) {
    node.at("axial_stiffness").fail_with_value("must be positive [N/m]");
  }
  element.slopes = read_rows(node.at("slopes"), size);
  return element;
}

void read_stiffening(const JsonNode& node, BodyConstants& constants) {
  node.allow_keys({"damping", "size", "displacements", "elements"});
  Stretching stretching;
  if (const auto damping = node.find("damping")) stretching.damping = read_number(*damping);
  stretching.displacements = read_matrix(
      node.at("displacements"), node.at("size").whole_number(1, most_rows), constants.size());
  for (const JsonNode& item : node.at("elements").items()) {
    stretching.elements.push_back(read_element(item, stretching.displacements.rows()));
  }
  if (stretching.elements.empty()) node.at("elements").fail("must have at least one element");
  constants.stretching = std::move(stretching);
}

void read_change_of_stiffening(const JsonNode& node, Stretching& change) {
  node.allow_keys({"damping", "displacements", "elements"});
  if (const auto damping = node.find("damping")) change.damping = read_number(*damping);
  read_into(node, "displacements", change.displacements);
  const auto elements = node.find("elements");
  if (!elements) return;
  std::size_t i = 0;
  for (const JsonNode& item : elements->items(change.elements.size())) {
    item.allow_keys({"axial_stiffness", "slopes"});
    StretchedElement& element = change.elements[i++];
    if (const auto stiffness = item.find("axial_stiffness")) {
      element.axial_stiffness = read_number(*stiffness);
    }
    if (const auto slopes = item.find("slopes")) {
      element.slopes = read_rows(*slopes, element.displacements.size());
    }
  }
}

}  // namespace

BodyConstants read_constants(const JsonNode& node, int coordinates) {
  BodyConstants constants;
  set_sizes(constants, coordinates);
  read_invariants_block(node.at("invariants"), constants, false);
  read_places(node.at("places"), constants);
  if (const auto stiffening = node.find("stiffening")) read_stiffening(*stiffening, constants);
  if (const auto stress = node.find("stress")) read_stress(*stress, constants);
  return constants;
}

BodyConstants read_derivative(const JsonNode& node, const BodyConstants& of) {
  node.allow_keys({"invariants", "places", "stress", "stiffening"});
  BodyConstants change = zero_constants(of);
  if (const auto invariants = node.find("invariants")) {
    read_invariants_block(*invariants, change, true);
  }
  if (const auto places = node.find("places")) read_changes_of_places(*places, change);
  if (const auto stress = node.find("stress")) {
    if (!change.stress) stress->fail("has no block of the same name outside the derivatives");
    stress->allow_keys(stress_keys());
    read_stress_numbers(*stress, *change.stress);
  }
  if (const auto stiffening = node.find("stiffening")) {
    if (!change.stretching) {
      stiffening->fail("has no block of the same name outside the derivatives");
    }
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
    const std::string key = fmt::format("moment_{0}{0}", "xyz"[i]);
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
  const double size = second.cwiseAbs().maxCoeff();
  if ((second - second.transpose()).cwiseAbs().maxCoeff() > tolerance * size) {
    block.at("second_moment").fail_with_value("must be symmetric");
  }
  const Eigen::Matrix3d central =
      second - constants.first_moment * constants.first_moment.transpose() / constants.mass;
  if (symmetric_eigenvalues(central)(0) < -tolerance * size) {
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
    const Eigen::MatrixXd& slopes = constants.stretching->elements[i].slopes;
    const double size = slopes.cwiseAbs().maxCoeff();
    if ((slopes - slopes.transpose()).cwiseAbs().maxCoeff() > tolerance * size) {
      elements[i].at("slopes").fail_with_value("must be symmetric");
    }
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
