#pragma once

#include <nlohmann/json.hpp>

#include "core/response/analysis.hpp"
#include "core/scene/body_constants.hpp"
#include "core/scene/problem_reader.hpp"
#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

/// A member that is taken out of a problem by its invariants and put back as a body that is known
/// by them only: nothing may change but round-off.
namespace pleuel::test {

using Json = nlohmann::ordered_json;

/// The slider-crank for 8 ms of a ramp to 200 rad/s, steps of 0.1 ms; with everything that
/// responses can ask of its rod, and a weight on a place between nodes.
Json slider_crank();

/// The largest difference of responses and of gradients by either method, relative to the largest
/// of the row, over the gradients that are not zero.
struct Differences {
  double values = 0.0, direct = 0.0, adjoint = 0.0;
};
Differences compare(const ProblemFile& original, const ProblemFile& imported);

InvariantsFile exported(const ProblemFile& problem, const std::string& body);

/// The name of a place along the rod.
std::string place_at(const InvariantsFile& file, double share);

/// The document with the file rod.json in place of the rod. A beam has the frequencies of both
/// planes whatever the motion has, a file those of its coordinates: in a plane the rod's second (it
/// is 20 mm wide and 30 mm high) is the file's first.
Json with_file(Json document, const InvariantsFile& file);

class Exchange : public testing::Test {
 protected:
  ProblemFile read(const std::string& name, const Json& document) const;
  /// The complaint about a document; empty if there is none.
  std::string complaint(const Json& document) const;
  void write(const std::string& text) const;
  std::filesystem::path path() const { return folder_.path() / "rod.json"; }
  std::string text() const;
  /// Exports the rod of a document, and returns the document with the file in place of the rod.
  Json exchanged(const Json& document) const;

  TemporaryFolder folder_;
};

}  // namespace pleuel::test
