#include "reduction/solid_matrices.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <numeric>
#include <unordered_map>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

namespace fs = std::filesystem;
/// Numbers of a text, one after the other: files have millions.
class NumberScanner {
 public:
  explicit NumberScanner(const fs::path& path) : path_(path) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream) {
      throw InputError(
          fmt::format("{}: cannot be read; is it the name of a job whose step has "
                      "*FREQUENCY, SOLVER=MATRIXSTORAGE?",
                      path.string()));
    }
    text_.assign(std::istreambuf_iterator<char>(stream), {});
    at_ = text_.data();
    end_ = at_ + text_.size();
  }

  /// The rest of this line.
  std::string line() {
    const char* begin = at_;
    while (at_ != end_ && *at_ != '\n') ++at_;
    const std::string text(begin, at_);
    if (at_ != end_) ++at_;
    return text;
  }

  bool has_more() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\t' || *at_ == '\r')) ++at_;
    return at_ != end_;
  }

  template <class Value>
  Value next() {
    Value value{};
    if (!has_more()) fail("ends too early");
    const auto [rest, error] = std::from_chars(at_, end_, value);
    if (error != std::errc()) fail("must have a number here");
    at_ = rest;
    return value;
  }

  void skip(char letter) {
    if (at_ == end_ || *at_ != letter) fail(fmt::format("must have \"{}\" here", letter));
    ++at_;
  }

  [[noreturn]] void fail(const std::string& rule) const {
    const auto line = 1 + std::count(text_.data(), at_, '\n');
    throw InputError(fmt::format("{}:{}: {}", path_.string(), line, rule));
  }

 private:
  fs::path path_;
  std::string text_;
  const char *at_ = nullptr, *end_ = nullptr;
};

fs::path with_ending(const fs::path& job, const std::string& ending) {
  return job.string() + ending;
}

/// For each row of the matrices of CalculiX the row of ours.
std::vector<int> read_rows(const fs::path& path, const SolidMesh& mesh) {
  std::unordered_map<int, int> nodes;
  for (int i = 0; i < mesh.size(); ++i) nodes[mesh.numbers[i]] = i;
  NumberScanner scanner(path);
  std::vector<int> rows;
  while (scanner.has_more()) {
    const int number = scanner.next<int>();
    scanner.skip('.');
    const int direction = scanner.next<int>();
    const auto node = nodes.find(number);
    if (node == nodes.end() || direction < 1 || direction > 3) {
      scanner.fail(
          fmt::format("{}.{} is no displacement of a node of the mesh", number, direction));
    }
    rows.push_back(3 * node->second + direction - 1);
  }
  if (int_size(rows) != 3 * mesh.size()) {
    scanner.fail(
        fmt::format("there must be three displacements for each of {} nodes, got {} "
                    "rows; does the job hold some by *BOUNDARY, or is the mesh another?",
                    mesh.size(), rows.size()));
  }
  return rows;
}

/// What follows: row, column, value.
/// @param rows     where each row of the file belongs
/// @param is_half  whether it is one triangle of a symmetric matrix
SolidMatrix read_entries(NumberScanner& scanner, const std::vector<int>& rows, bool is_half) {
  std::vector<Eigen::Triplet<double>> entries;
  const int size = int_size(rows);
  while (scanner.has_more()) {
    const int i = scanner.next<int>() - 1, j = scanner.next<int>() - 1;
    const double value = scanner.next<double>();
    if (i < 0 || j < 0 || i >= size || j >= size) {
      scanner.fail(fmt::format("rows and columns must be from 1 to {}", size));
    }
    if (value == 0.0) continue;
    entries.emplace_back(rows[i], rows[j], value);
    if (is_half && i != j) entries.emplace_back(rows[j], rows[i], value);
  }
  SolidMatrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

SolidMatrix read_triangle(const fs::path& path, const std::vector<int>& rows) {
  NumberScanner scanner(path);
  return read_entries(scanner, rows, true);
}

SolidMatrix read_market(const fs::path& path, const SolidMesh& mesh) {
  NumberScanner scanner(path);
  const std::string heading = scanner.line();
  const bool is_symmetric = heading.find("symmetric") != std::string::npos;
  if (!heading.starts_with("%%MatrixMarket matrix coordinate real") ||
      (!is_symmetric && heading.find("general") == std::string::npos)) {
    scanner.fail(
        "must begin with \"%%MatrixMarket matrix coordinate real symmetric\" or \"general\"");
  }
  std::string line = scanner.line();
  while (line.starts_with("%")) line = scanner.line();
  const int size = 3 * mesh.size();
  if (std::atoi(line.c_str()) != size) {
    scanner.fail(fmt::format("must have {} rows, three for each of {} nodes, got \"{}\"", size,
                             mesh.size(), line));
  }
  std::vector<int> rows(size);
  std::iota(rows.begin(), rows.end(), 0);
  return read_entries(scanner, rows, is_symmetric);
}

}  // namespace

SolidMatrices read_calculix_matrices(const fs::path& job, const SolidMesh& mesh) {
  const std::vector<int> rows = read_rows(with_ending(job, ".dof"), mesh);
  return {read_triangle(with_ending(job, ".sti"), rows),
          read_triangle(with_ending(job, ".mas"), rows)};
}

SolidMatrices read_market_matrices(const fs::path& stiffness, const fs::path& mass,
                                   const SolidMesh& mesh) {
  return {read_market(stiffness, mesh), read_market(mass, mesh)};
}

}  // namespace pleuel
