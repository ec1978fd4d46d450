#include "library/motion_document.hpp"

#include <vector>

#include "core/response/analysis.hpp"
#include "core/scene/load_cases.hpp"
#include "picture/motion.hpp"

namespace pleuel {

namespace {

/// As many as a picture of one mechanism has at most.
constexpr int most_instants = 720;

Json columns(const Eigen::MatrixXd& matrix) {
  Json all = Json::array();
  for (const auto& column : matrix.colwise()) {
    all.push_back(std::vector<double>(column.begin(), column.end()));
  }
  return all;
}

Json track_document(const BodyTrack& track) {
  Json document = {{"name", track.body},
                   {"stations", track.stations},
                   {"parts", track.parts},
                   {"positions", columns(track.positions)},
                   {"rotations", columns(track.rotations)}};
  if (track.stress.size() > 0) document["stress"] = columns(track.stress);
  return document;
}

Json case_document(const ProblemFile& problem, const Eigen::VectorXd& x) {
  const auto analysis = analyze(problem, x, values_only);
  const Motion motion =
      sample_motion(problem.scene, *analysis, frames_of_motion(*analysis, most_instants));
  Json document = {{"case", problem.load_case},
                   {"time", std::vector<double>(motion.time.begin(), motion.time.end())},
                   {"bodies", Json::array()}};
  for (const BodyTrack& track : motion.bodies) document["bodies"].push_back(track_document(track));
  return document;
}

}  // namespace

Json motion_document(const ProblemFile& problem, const Eigen::VectorXd& x) {
  Json document = Json::array();
  for (const ProblemFile* one : simulated_problems(problem)) {
    document.push_back(case_document(*one, x));
  }
  return document;
}

}  // namespace pleuel
