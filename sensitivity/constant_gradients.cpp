#include "sensitivity/constant_gradients.hpp"

#include <algorithm>
#include <variant>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/model/imported_constants.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/visit_constants.hpp"
#include "sensitivity/gradients.hpp"

namespace pleuel {

namespace {

/// One number of the constants: an entry of one of their blocks, in the order of visit_constants().
struct Entry {
  int block;
  Eigen::Index row, column;
};

/// How many numbers are differentiated for in one run of the adjoint: each has constants of its own.
constexpr std::size_t most_at_once = 1000;

/// use(row, column) for each of them: of a sparse matrix those that the file lists.
template <class Use>
void each_entry(double, const Use& use) {
  use(0, 0);
}
template <class Derived, class Use>
void each_entry(const Eigen::MatrixBase<Derived>& matrix, const Use& use) {
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) use(row, column);
  }
}
template <class Use>
void each_entry(const SparseMatrix& matrix, const Use& use) {
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (SparseMatrix::InnerIterator entry(matrix, row); entry; ++entry) use(row, entry.col());
  }
}

void put(double& number, Eigen::Index, Eigen::Index, double value) {
  number = value;
}
template <class Matrix>
void put(Matrix& matrix, Eigen::Index row, Eigen::Index column, double value) {
  matrix.coeffRef(row, column) = value;
}

std::vector<Entry> entries_of(const BodyConstants& constants) {
  std::vector<Entry> entries;
  int block = 0;
  const auto add = [&](const ConstantsBlock&, const auto& numbers) {
    each_entry(numbers, [&](Eigen::Index row, Eigen::Index column) {
      entries.push_back({block, row, column});
    });
    ++block;
  };
  visit_constants(add, constants);
  return entries;
}

void set_entry(BodyConstants& constants, const Entry& entry, double value) {
  int block = 0;
  const auto set = [&](const ConstantsBlock&, auto& numbers) {
    if (block++ == entry.block) put(numbers, entry.row, entry.column, value);
  };
  visit_constants(set, constants);
}

/// The problem with a design variable more for each of the entries: what it adds to that number.
class WithEntries {
 public:
  WithEntries(ProblemFile problem, std::size_t body, std::shared_ptr<const InvariantsFile> file)
      : problem_(std::move(problem)),
        body_(body),
        file_(std::move(file)),
        first_(problem_.variables.size()) {}

  /// @returns responses × entries
  Eigen::MatrixXd gradients(const Eigen::VectorXd& x, const std::vector<Entry>& entries) {
    auto file = std::make_shared<InvariantsFile>(*file_);
    file->design.clear();
    auto& imported = std::get<ImportedBody>(problem_.scene.bodies[body_].shape);
    imported.maker = nullptr;
    imported.variables.clear();
    problem_.variables.resize(first_);
    const BodyConstants zero = zero_constants(file->constants);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      ConstantsDerivative of{fmt::format("entry {}", i), 0.0, "1", zero};
      set_entry(*of.derivative, entries[i], 1.0);
      DesignVariable variable;
      variable.name = of.variable;
      imported.variables.push_back(
          {Number::bound(static_cast<int>(first_ + i)), quantities::pure_number, i});
      file->design.push_back(std::move(of));
      problem_.variables.push_back(std::move(variable));
    }
    imported.file = std::move(file);
    Eigen::VectorXd design = Eigen::VectorXd::Zero(problem_.variables.size());
    design.head(first_) = x;
    const auto analysis = analyze(problem_, design);
    return pleuel::gradients(problem_, design, *analysis, GradientMethod::adjoint)
        .rightCols(entries.size());
  }

 private:
  ProblemFile problem_;
  std::size_t body_;
  std::shared_ptr<const InvariantsFile> file_;
  std::size_t first_;
};

std::size_t find_body(const ProblemFile& problem, const std::string& name) {
  const auto index = index_of_named(problem.scene.bodies, name);
  if (!index) throw InputError(fmt::format("/scene/bodies has no body \"{}\"", name));
  if (!std::holds_alternative<ImportedBody>(problem.scene.bodies[*index].shape)) {
    throw InputError(fmt::format(
        "/scene/bodies/{} is no body of the type \"invariants\", which has numbers of its own to "
        "differentiate for; \"pleuel invariants\" writes a beam as such a body",
        name));
  }
  return *index;
}

}  // namespace

ConstantGradients constant_gradients(const ProblemFile& problem, const Eigen::VectorXd& x,
                                     const std::string& body) {
  if (problem.has_cases()) {
    throw InputError("gradients by invariants are those of one load case: name it with --case");
  }
  const std::size_t index = find_body(problem, body);
  const Body& found = problem.scene.bodies[index];
  const auto file =
      body_at(std::get<ImportedBody>(found.shape), found, Design<double>(x.begin(), x.end()));
  const BodyConstants zero = zero_constants(file->constants);
  ConstantGradients result{file->constants, {}};
  result.numbers.assign(problem.responses.size(), zero);
  const std::vector<Entry> all = entries_of(file->constants);
  WithEntries with_entries(problem, index, file);
  for (std::size_t first = 0; first < all.size(); first += most_at_once) {
    const std::size_t end = std::min(all.size(), first + most_at_once);
    const std::vector<Entry> entries(all.begin() + first, all.begin() + end);
    const Eigen::MatrixXd gradients = with_entries.gradients(x, entries);
    for (Eigen::Index response = 0; response < gradients.rows(); ++response) {
      for (std::size_t i = 0; i < entries.size(); ++i) {
        const double slope = gradients(response, static_cast<Eigen::Index>(i));
        if (slope != 0.0) set_entry(result.numbers[response], entries[i], slope);
      }
    }
  }
  return result;
}

namespace {

double product(double a, double b) {
  return a * b;
}
template <class Matrix>
double product(const Matrix& a, const Matrix& b) {
  return a.cwiseProduct(b).sum();
}

}  // namespace

double along(const BodyConstants& gradient, const BodyConstants& change) {
  double sum = 0.0;
  const auto add = [&](const ConstantsBlock&, const auto& a, const auto& b) {
    sum += product(a, b);
  };
  visit_constants(add, gradient, change);
  return sum;
}

}  // namespace pleuel
