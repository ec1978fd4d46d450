#include "cli/files/run_picture.hpp"

#include <algorithm>
#include <cmath>

#include "cli/files/csv_file.hpp"
#include "cli/reports/limits_report.hpp"
#include "cli/reports/scene_report.hpp"
#include "core/base/error.hpp"
#include "core/model/imported_constants.hpp"
#include "core/response/history_reduction.hpp"
#include "core/response/peak_place.hpp"
#include "core/scene/response_kind.hpp"
#include "core/scene/response_parts.hpp"
#include "picture/companions.hpp"
#include "picture/thinned.hpp"
#include "sensitivity/method_choice.hpp"

namespace pleuel {

namespace {

/// Direct differentiation takes as much time as some simulations for so many variables.
constexpr std::size_t most_variables = 24;
constexpr double most_numbers = 1e7;  ///< derivatives at instants: 80 MB

bool is_cheap(const ProblemFile& problem, const Analysis& analysis) {
  double histories = 0.0;
  for (const Response& response : analysis.responses) histories += response.history() ? 1.0 : 0.0;
  const auto variables = static_cast<double>(problem.variables.size());
  const auto instants = static_cast<double>(analysis.trajectory.time.size());
  return problem.variables.size() <= most_variables &&
         histories * variables * instants <= most_numbers;
}

constexpr int most_frames = 720;        ///< of a moving picture
constexpr std::size_t most_slopes = 6;  ///< of a response: by the variables that matter most

/// What one picture takes of a page.
struct Room {
  int points = 1600;       ///< of a curve
  int slope_points = 700;  ///< of a derivative over time
  double numbers = 1.2e6;  ///< of the motion of all designs together
};

/// Of one of the pictures that share a page. Peaks and ends stay however few points a curve has.
/// @param curves  of this picture
Room room_of_one(std::size_t pictures, std::size_t curves) {
  constexpr double points_of_page = 1.2e5;
  constexpr int fewest = 60;
  const double points = points_of_page / static_cast<double>(std::max<std::size_t>(1, curves)) /
                        static_cast<double>(pictures);
  Room room;
  const double share = std::min(1.0, points / room.points);
  room.points = std::max(fewest, static_cast<int>(share * room.points));
  room.slope_points = std::max(fewest, static_cast<int>(share * room.slope_points));
  room.numbers /= static_cast<double>(pictures);
  return room;
}

Json unit_document(const ShownUnit& unit) {
  return {{"si", unit.si}, {"name", unit.name}, {"factor", unit.factor}};
}

Json meaning_document(const ResponseSettings& response) {
  Json document = {{"type", kind_of(response.what).word},
                   {"over_time", word_of(over_time_kinds, response.over_time)},
                   {"bodies", bodies_of(response)},
                   {"unit", unit_document(unit_of(response))},
                   {"history_unit", unit_document(history_unit(response))},
                   {"limits_history", limits_each_instant(response)}};
  if (const std::string joint = joint_of(response); !joint.empty()) document["joint"] = joint;
  if (const std::optional<double> at = place_along(response)) document["at"] = *at;
  return document;
}

Json limits_picture(const ProblemFile& problem) {
  return named_entries(problem.constraints, [&](const ConstraintSettings& constraint) {
    Json entry = {{"unit", unit_document(unit_of(problem, constraint))}};
    if (!constraint.response.empty()) entry["response"] = constraint.response;
    if (constraint.lower) entry["lower"] = *constraint.lower;
    if (constraint.upper) entry["upper"] = *constraint.upper;
    return entry;
  });
}

/// Times and values of the points of a curve that are drawn, and the half-width of its band if it
/// has one.
Json curve_document(const Eigen::VectorXd& time, const Eigen::VectorXd& values,
                    const std::vector<int>& kept, int most, const Eigen::VectorXd& band = {}) {
  const std::vector<int> points = thinned(values, most, kept);
  const bool has_band = band.size() == values.size();
  Eigen::MatrixXd curve(has_band ? 3 : 2, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    curve.col(i).head<2>() << time(points[i]), values(points[i]);
    if (has_band) curve(2, i) = band(points[i]);
  }
  return packed_numbers(curve);
}

/// {VARIABLE: curve} of the derivatives of a history, of the variables that change most of it.
Json slopes_document(const ProblemFile& problem, const ShownDesign& design,
                     const HistoryGradients& history, const Room& room) {
  std::vector<std::pair<double, Eigen::Index>> sizes;
  for (Eigen::Index j = 0; j < design.x.size(); ++j) {
    sizes.push_back(
        {history.gradients.col(j).lpNorm<Eigen::Infinity>() * std::abs(design.x(j)), j});
  }
  std::ranges::sort(sizes, std::greater<>());
  Json document = Json::object();
  for (std::size_t k = 0; k < std::min(most_slopes, sizes.size()); ++k) {
    const Eigen::Index j = sizes[k].second;
    document[problem.variables[j].name] = curve_document(
        design.analysis->trajectory.time, history.gradients.col(j), {}, room.slope_points);
  }
  return document;
}

void add_influence(const ProblemFile& problem, const ShownDesign& design, std::size_t i,
                   const Room& room, Json& document) {
  if (design.influence == nullptr) return;
  document["gradients"] = by_name(problem.variables, design.influence->gradients.row(i));
  for (const HistoryGradients& history : design.influence->histories) {
    if (history.response == i) document["slopes"] = slopes_document(problem, design, history, room);
  }
}

Json response_document(const ProblemFile& problem, const ShownDesign& design, std::size_t i,
                       const Room& room) {
  const Analysis& analysis = *design.analysis;
  const Response& response = analysis.responses[i];
  const Reduction& reduction = analysis.reductions[i];
  Json document = {{"name", response.name}, {"value", reduction.value}};
  add_influence(problem, design, i, room, document);
  if (!response.history()) return document;
  std::vector<int> kept;
  if (const auto peak = find_peak(problem, analysis, i)) {
    document["peak_time"] = peak->time;
    document["peak_place"] = peak->place;
    if (peak->share) document["peak_share"] = *peak->share;
    for (const Sample& sample : reduction.samples) kept.push_back(sample.step);
  }
  document["history"] =
      curve_document(analysis.trajectory.time, shown_history(response, analysis.histories[i]), kept,
                     room.points, i < design.bands.size() ? design.bands[i] : Eigen::VectorXd());
  return document;
}

Json companions_document(const ProblemFile& problem, const Analysis& analysis, const Room& room) {
  const Companions companions = find_companions(problem, analysis);
  return list_of(companions.all, [&](const Companion& one) {
    Json entry = meaning_document(one.settings);
    entry["name"] = one.settings.name;
    entry["value"] = one.value;
    entry["peak_time"] = companions.time(one.peak);
    entry["history"] = curve_document(companions.time, one.history, {one.peak}, room.points);
    return entry;
  });
}

/// So many frames that all designs together stay small.
int frames_for(const Motion& first, std::size_t designs, const Room& room) {
  double numbers = 0.0;
  for (const BodyTrack& body : first.bodies) {
    numbers += static_cast<double>(body.positions.rows() + body.rotations.rows() +
                                   body.stress.rows() + body.coordinates.rows());
  }
  const double frames = room.numbers / std::max(1.0, numbers * static_cast<double>(designs));
  return static_cast<int>(std::clamp(frames, 60.0, static_cast<double>(most_frames)));
}

Motion frames_of(const Scene& scene, const Analysis& analysis, std::size_t designs,
                 const Room& room) {
  const int frames = frames_for(sample_motion(scene, analysis, {0}), designs, room);
  return sample_motion(scene, analysis, frames_of_motion(analysis, frames));
}

Json motion_document(const Motion& motion) {
  const auto body_entry = [](const BodyTrack& body) {
    Json entry = {{"stations", body.stations},
                  {"parts", body.parts},
                  {"positions", packed_numbers(body.positions)},
                  {"rotations", packed_numbers(body.rotations)}};
    if (body.stress.size() > 0) entry["stress"] = packed_numbers(body.stress);
    if (body.coordinates.size() > 0) {
      entry["coordinates"] = packed_numbers(body.coordinates);
      entry["origins"] = packed_numbers(body.origins);
    }
    return entry;
  };
  return {{"time", packed_numbers(motion.time.transpose())},
          {"bodies", list_of(motion.bodies, body_entry)}};
}

/// Of the bodies whose surface is known at the design.
/// @param bodies  in the order of the scene
void add_surfaces(const Scene& scene, const Eigen::VectorXd& x, Json& bodies) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const auto* imported = std::get_if<ImportedBody>(&scene.bodies[i].shape);
    if (imported == nullptr) continue;
    const auto file = body_at(*imported, scene.bodies[i], Design<double>(x.begin(), x.end()));
    if (!file->surface) continue;
    bodies[i]["surface"] = {{"positions", packed_numbers(file->surface->positions)},
                            {"triangles", file->surface->triangles},
                            {"displacement", packed_numbers(file->surface->displacement)},
                            {"young", file->surface->young},
                            {"poisson", file->surface->poisson}};
  }
}

Json design_document(const ProblemFile& problem, const ShownDesign& design, std::size_t designs,
                     const Room& room) {
  Json document = {{"name", design.name}};
  document["variables"] = std::vector<double>(design.x.begin(), design.x.end());
  document["geometry"] = geometry_picture(problem, design.x);
  if (design.rigid.time.size() > 0) document["motion"] = motion_document(design.rigid);
  if (design.analysis == nullptr) return document;
  const Analysis& analysis = *design.analysis;
  add_surfaces(problem.scene, design.x, document["geometry"]["bodies"]);
  document["masses"] = Json::object();
  for (const BodyModel& body : analysis.model.bodies) {
    document["masses"][body.name] = document["masses"].value(body.name, 0.0) + body.mass;
  }
  document["motion"] = motion_document(frames_of(problem.scene, analysis, designs, room));
  document["responses"] = Json::array();
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    document["responses"].push_back(response_document(problem, design, i, room));
  }
  document["companions"] = companions_document(problem, analysis, room);
  return document;
}

}  // namespace

std::shared_ptr<const DesignInfluence> design_influence(const ProblemFile& problem,
                                                        Analysis& analysis) {
  if (problem.variables.empty() || analysis.responses.empty()) return nullptr;
  try {
    if (is_cheap(problem, analysis)) {
      ResponseDerivatives all = response_derivatives(analysis);
      return std::make_shared<DesignInfluence>(
          DesignInfluence{std::move(all.values), std::move(all.histories)});
    }
    const std::vector<SampledValue> values = response_values(analysis);
    return std::make_shared<DesignInfluence>(DesignInfluence{
        sampled_gradients(analysis, values, choose_method(analysis, values).method)});
  } catch (const SimulationError&) {
    return nullptr;
  }
}

Json run_picture(const ProblemFile& problem, const std::vector<ShownDesign>& designs,
                 std::size_t pictures) {
  const NamedUnits units = units_of_variables(problem);
  Json variables = variables_document(problem);
  for (const auto& [name, variable] : variables.items()) {
    variable["unit"] = unit_document(units.at(name));
  }
  Json document = {{"name", problem.name},
                   {"description", problem.description},
                   {"scene", scene_picture(problem)},
                   {"variables", variables},
                   {"responses", named_entries(problem.responses, meaning_document)},
                   {"limits", limits_picture(problem)}};
  if (problem.objective) {
    document["objective"] = problem.objective->response;
    document["maximizes"] = problem.objective->sign() < 0.0;
  }
  if (!problem.load_case.empty()) document["case"] = problem.load_case;
  for (const ShownDesign& design : designs) {
    if (design.analysis != nullptr) document["size"] = size_of(design.analysis->model);
  }
  const Room room = room_of_one(pictures, designs.size() * problem.responses.size());
  document["designs"] = list_of(designs, [&](const ShownDesign& design) {
    return design_document(problem, design, designs.size(), room);
  });
  return document;
}

Json rigid_picture(const ProblemFile& problem,
                   const std::vector<std::pair<std::string, Eigen::VectorXd>>& designs) {
  std::vector<ShownDesign> shown;
  for (const auto& [name, x] : designs) {
    shown.push_back({name, x, {}, {}, {}, rigid_motion(problem, x)});
  }
  return run_picture(problem, shown);
}

Json picture_of_cases(const ProblemFile& joined, std::vector<Json> cases, std::size_t shown) {
  Json picture = std::move(cases[shown]);
  picture["units"]["responses"] = named_entries(
      joined.responses, [](const ResponseSettings& one) { return unit_document(unit_of(one)); });
  for (const ConstraintSettings& constraint : joined.constraints) {
    picture["units"]["limits"][constraint.name] = unit_document(unit_of(joined, constraint));
  }
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (i != shown) picture["other_cases"].push_back(std::move(cases[i]));
  }
  return picture;
}

}  // namespace pleuel
